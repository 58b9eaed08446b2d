"""Motor heat and battery charge, which follow from the currents and speeds of the motors."""

from __future__ import annotations

from typing import Callable, Sequence, Tuple

from nao_sim_bridge.base.settings import Settings
from nao_sim_bridge.body.sensors.battery import Battery
from nao_sim_bridge.body.sensors.motors import Work

# Heat and charge change slowly: the currents are looked at this often, in s.
PERIOD = 0.1


class PowerSystem:
    """Temperatures of motors and head, and the battery; cold and full at the start.

    Attributes:
        temperatures: (26,) motor temperatures, degC.
        head: Temperature of the computer in the head, degC.
        battery: The battery.

    Args:
        heat_capacities: (26,) of the motors, J/K.
        tells_plugged: Whether the battery's board reports that a charger is there.
    """

    def __init__(self, heat_capacities: Sequence[float], settings: Settings, tells_plugged: bool = False) -> None:
        self._settings = settings
        self._capacities = tuple(heat_capacities)
        ambient = settings.motor.ambient_c
        self.temperatures: Tuple[float, ...] = (ambient,) * len(self._capacities)
        self.head = ambient
        self.battery = Battery(settings.battery, ambient, tells_plugged)
        self._elapsed = 0.0

    def warm_up(self, motor: int, celsius: float) -> None:
        """Put a motor to a temperature, degC."""
        self.temperatures = (*self.temperatures[:motor], celsius, *self.temperatures[motor + 1 :])

    def advance(self, read_work: Callable[[], Work], dt: float) -> None:
        """Let `dt` s pass; `read_work()` gives what the motors do when it is needed."""
        self._elapsed += dt
        if self._elapsed < PERIOD:
            return
        motor, head = self._settings.motor, self._settings.head
        work, dt = read_work(), self._elapsed
        ambient, cooling = motor.ambient_c, motor.cooling_per_s
        self.temperatures = tuple(
            [
                warmth + dt * (watts / capacity - cooling * (warmth - ambient))
                for warmth, watts, capacity in zip(self.temperatures, work.losses, self._capacities)
            ]
        )
        self.head += dt * (ambient + head.warmth_k - self.head) / head.time_constant_s
        draw = self._settings.battery.idle_w + self._settings.battery.driver_w * work.stiff + work.drawn
        self.battery.advance(draw, dt)
        self._elapsed = 0.0
