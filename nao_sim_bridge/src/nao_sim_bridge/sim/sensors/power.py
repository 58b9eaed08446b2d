"""What motors draw: current from torque, heat from current, charge from both."""

from __future__ import annotations

from typing import Sequence

import numpy as np

from nao_sim_bridge.sim.model import RobotModel
from nao_sim_bridge.sim.settings import Settings

# Heat and charge change slowly: they are advanced this often, in s.
PERIOD = 0.5


class PowerSystem:
    """Motor currents and temperatures, and the battery.

    Args:
        model: The robot, for its motor table.
        settings: Voltage, heat and charge figures.
    """

    def __init__(self, model: RobotModel, settings: Settings) -> None:
        self._settings = settings
        volts = settings.battery.voltage_v
        self._amps_per_torque = np.array(
            [_amps_per_torque(model, joint.name, volts, settings.motor.gear_efficiency) for joint in model.joints]
        )
        self.reset()

    def reset(self) -> None:
        """Cold motors and a full battery."""
        count = len(self._amps_per_torque)
        self.temperatures: tuple[float, ...] = (self._settings.motor.ambient_c,) * count
        self.charge = 1.0
        self.current = self._settings.battery.idle_current_a
        self._squares = np.zeros(count)
        self._amps = np.zeros(count)
        self._elapsed = 0.0

    def advance(self, torques: Sequence[float], dt: float) -> tuple[float, ...]:
        """Currents in A for motor `torques` (N m) that held for `dt` seconds."""
        amps = np.abs(torques) * self._amps_per_torque
        self._squares += amps * amps * dt
        self._amps += amps * dt
        self._elapsed += dt
        if self._elapsed >= PERIOD:
            self._settle()
        return tuple(amps.tolist())

    def _settle(self) -> None:
        motor, battery = self._settings.motor, self._settings.battery
        warmth = np.array(self.temperatures)
        warmth += motor.heating_k_per_a2_s * self._squares
        warmth -= motor.cooling_per_s * self._elapsed * (warmth - motor.ambient_c)
        self.temperatures = tuple(warmth.tolist())
        self.current = battery.idle_current_a + float(self._amps.sum()) / self._elapsed
        self.charge = max(0.0, self.charge - self.current * self._elapsed / (3600.0 * battery.capacity_ah))
        self._squares[:] = 0.0
        self._amps[:] = 0.0
        self._elapsed = 0.0


def _amps_per_torque(model: RobotModel, joint: str, volts: float, efficiency: float) -> float:
    """A per N m at the joint: the torque constant is the voltage over the no-load speed of the motor."""
    kind = joint[1:] if joint[0] in "LR" else joint
    for motor in model.motors:
        if kind in motor.gear_ratio_of:
            return motor.no_load_speed / volts / (motor.gear_ratio_of[kind] * efficiency)
    raise KeyError(f"no motor drives {joint}")
