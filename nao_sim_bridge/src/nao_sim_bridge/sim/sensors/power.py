"""Motor heat and battery charge, which follow from the currents the motors draw."""

from __future__ import annotations

from typing import Callable, Sequence

from nao_sim_bridge.sim.settings import Settings

# Heat and charge change slowly: the currents are looked at this often, in s.
PERIOD = 0.1


class PowerSystem:
    """Motor temperatures and the battery, cold and full at the start.

    Attributes:
        temperatures: (26,) motor temperatures, degC.
        charge: Of the battery, 0..1.
        current: That the battery gives, A.

    Args:
        motors: How many motors there are.
        settings: Heat and charge figures.
    """

    def __init__(self, motors: int, settings: Settings) -> None:
        self._settings = settings
        self.temperatures: tuple[float, ...] = (settings.motor.ambient_c,) * motors
        self.charge = 1.0
        self.current = settings.battery.idle_current_a
        self._elapsed = 0.0

    def warm_up(self, motor: int, celsius: float) -> None:
        """Put a motor to a temperature, degC."""
        self.temperatures = (*self.temperatures[:motor], celsius, *self.temperatures[motor + 1 :])

    def advance(self, read_currents: Callable[[], Sequence[float]], dt: float) -> None:
        """Let `dt` s pass; `read_currents()` gives the motors' currents in A when they are needed."""
        self._elapsed += dt
        if self._elapsed < PERIOD:
            return
        motor, battery = self._settings.motor, self._settings.battery
        currents = read_currents()
        self.temperatures = tuple(
            warmth
            + self._elapsed
            * (motor.heating_k_per_a2_s * amps * amps - motor.cooling_per_s * (warmth - motor.ambient_c))
            for warmth, amps in zip(self.temperatures, currents)
        )
        self.current = battery.idle_current_a + sum(currents)
        drawn = self.current * self._elapsed / (3600.0 * battery.capacity_ah)
        self.charge = max(0.0, self.charge - drawn)
        self._elapsed = 0.0
