"""The battery: charge, voltage, current and temperature, and the charger that may be plugged in."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntFlag
from typing import Sequence, Tuple

from nao_sim_bridge.base.settings import BatterySettings


class Status(IntFlag):
    """Bits of the battery's status word, as `Battery/Charge/Sensor/Status` has them.

    Source: NAOqi's description of the battery's device file; the same list is known to ROS's diagnostics of NAO.
    """

    END_OF_DISCHARGE = 1 << 0
    NEAR_END_OF_DISCHARGE = 1 << 1
    CHARGE_FET_ON = 1 << 2
    DISCHARGE_FET_ON = 1 << 3
    DISCHARGING = 1 << 5
    FULL = 1 << 6
    CHARGING = 1 << 7
    DISCHARGE_TEMPERATURE_ALARM = 1 << 14
    POWER_SUPPLY_PRESENT = 1 << 15


@dataclass(frozen=True)
class BatteryReading:
    """What the battery's board tells.

    Attributes:
        charge: 0..1.
        current: A, positive while it discharges.
        capacity_ah: Charge of the full battery, A h.
        voltage: Of the pack, V.
        cell_voltages: The weakest and the strongest of the cells, V.
        temperature: degC.
        plugged: Whether a charger is plugged in.
        tells_plugged: Whether the board of this robot reports that.
        low: Whether it should be charged soon.
        nearly_empty: Whether the robot has a minute or two left.
        empty: Whether the robot must rest.
        full: Whether no more goes into it.
        hot: Whether it raises its temperature alarm.
    """

    charge: float
    current: float
    capacity_ah: float
    voltage: float
    cell_voltages: Tuple[float, float]
    temperature: float
    plugged: bool
    tells_plugged: bool
    low: bool
    nearly_empty: bool
    empty: bool
    full: bool
    hot: bool

    @property
    def charging(self) -> bool:
        """Whether current flows into it."""
        return self.current < 0.0

    @property
    def discharging(self) -> bool:
        """Whether the robot draws from it."""
        return self.current > 0.0

    @property
    def status(self) -> Status:
        flags = {
            Status.END_OF_DISCHARGE: self.empty,
            Status.NEAR_END_OF_DISCHARGE: self.nearly_empty,
            Status.CHARGE_FET_ON: self.charging,
            Status.DISCHARGE_FET_ON: not self.empty,
            Status.DISCHARGING: self.discharging,
            Status.FULL: self.full,
            Status.CHARGING: self.charging,
            Status.DISCHARGE_TEMPERATURE_ALARM: self.hot,
            Status.POWER_SUPPLY_PRESENT: self.plugged and self.tells_plugged,
        }
        return sum((flag for flag, up in flags.items() if up), Status(0))


class Battery:
    """A pack of cells in series, full at the start, with the load of a robot that rests.

    Attributes:
        reading: What its board tells.

    Args:
        ambient: Temperature of the room, degC.
        tells_plugged: Whether its board reports that a charger is there; that of a V6 does not.
    """

    def __init__(self, settings: BatterySettings, ambient: float, tells_plugged: bool) -> None:
        self._settings = settings
        self._ambient = ambient
        self._tells_plugged = tells_plugged
        self._plugged = False
        self._charge = 1.0
        self._temperature = ambient
        self._watts = settings.idle_w
        self._current = self._from_battery()
        self.reading = self._read()

    def put(self, charge: float) -> None:
        """Have this charge, 0..1, from which it goes on."""
        self._charge = charge
        self._current = self._from_battery()
        self.reading = self._read()

    def plug(self, plugged: bool) -> None:
        """Plug the charger in, or pull it."""
        self._plugged = plugged
        self._current = self._from_battery()
        self.reading = self._read()

    def warm_up(self, celsius: float) -> None:
        """Have this temperature, degC, from where it goes on by itself."""
        self._temperature = celsius
        self.reading = self._read()

    def advance(self, watts: float, dt: float) -> None:
        """Let `dt` s pass in which the robot draws `watts`."""
        settings = self._settings
        self._watts = watts
        self._current = self._from_battery()
        self._charge = min(max(self._charge - self._current * dt / (3600.0 * settings.capacity_ah), 0.0), 1.0)
        lost = settings.resistance_ohm * self._current * self._current
        away = self._temperature - self._ambient
        self._temperature += dt * (lost - settings.cooling_w_per_k * away) / settings.heat_capacity_j_per_k
        self.reading = self._read()

    def _from_battery(self) -> float:
        """Current in A that the battery gives with this load; the charger feeds the robot first."""
        settings = self._settings
        if not self._plugged:
            return self._watts / (settings.cells * self._voltage_at_rest())
        if self._charge >= settings.full_charge:
            return 0.0
        left = (1.0 - self._charge) / (1.0 - settings.taper_from_charge)
        return -settings.charge_current_a * min(1.0, max(settings.least_taper, left))

    def _read(self) -> BatteryReading:
        settings = self._settings
        voltage = self._voltage_at_rest() - settings.resistance_ohm / settings.cells * self._current
        spread = settings.cell_spread_v / 2.0
        return BatteryReading(
            self._charge,
            self._current,
            settings.capacity_ah,
            settings.cells * voltage,
            (voltage - spread, voltage + spread),
            self._temperature,
            self._plugged,
            self._tells_plugged,
            self._charge <= settings.low_charge,
            self._charge <= settings.nearly_empty_charge,
            self._charge <= settings.empty_charge,
            self._charge >= settings.full_charge,
            self._temperature >= settings.hot_c,
        )

    def _voltage_at_rest(self) -> float:
        """Of a cell that gives and takes nothing, V."""
        return interpolated(self._settings.cell_rest_voltages, self._charge)


def interpolated(curve: Sequence[Tuple[float, float]], x: float) -> float:
    """Value of a curve of straight lines through (x, y), x rising, at `x`; beyond its last point that of this point."""
    before = curve[0]
    for point in curve[1:]:
        if x <= point[0]:
            share = (x - before[0]) / (point[0] - before[0])
            return before[1] + share * (point[1] - before[1])
        before = point
    return before[1]
