"""Settings of the physics, read strictly from `config/physics.json`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Tuple

from nao_sim_bridge.base.config import config_file, read_settings

FILE = "physics.json"


@dataclass(frozen=True)
class MotorSettings:
    """How motors follow, resist and warm up; see the file's source notes."""

    position_gain: float
    velocity_gain: float
    feed_forward: float
    limp_friction: float
    limp_hip_pitch_friction: float
    coupling_force_n: float
    gear_efficiency: float
    ambient_c: float
    cooling_per_s: float
    big_motor: str
    big_heat_capacity_j_per_k: float
    small_heat_capacity_j_per_k: float


@dataclass(frozen=True)
class ContactSettings:
    """Friction (coefficients) and stiffness (N/m, N s/m) of the robot's contacts."""

    sole_friction: float
    body_friction: float
    sole_stiffness: float
    sole_damping: float


@dataclass(frozen=True)
class HeadSettings:
    """How the computer in the head warms up: by so much over the room, with this time constant; when it is hot."""

    warmth_k: float
    time_constant_s: float
    hot_c: float
    critical_c: float


@dataclass(frozen=True)
class BatterySettings:
    """The battery, its charger, what the robot draws besides its motors, and when it counts as low (0..1).

    `cell_rest_voltages` has pairs of charge, 0..1, and voltage of a cell that gives and takes nothing, V. The charger
    gives its full current up to `taper_from_charge`, from there on less and less, down to `least_taper` of it, and from
    `full_charge` on no more than the robot draws. From `hot_c` on the battery raises its alarm.
    """

    voltage_v: float
    capacity_ah: float
    cells: int
    resistance_ohm: float
    cell_spread_v: float
    cell_rest_voltages: Tuple[Tuple[float, float], ...]
    heat_capacity_j_per_k: float
    cooling_w_per_k: float
    idle_w: float
    driver_w: float
    hot_c: float
    charge_current_a: float
    full_charge: float
    taper_from_charge: float
    least_taper: float
    low_charge: float
    nearly_empty_charge: float
    empty_charge: float


@dataclass(frozen=True)
class Settings:
    """All of `physics.json`."""

    time_step_s: float
    steps_per_tick: int
    solver_iterations: int
    gravity_m_s2: float
    motor: MotorSettings
    contact: ContactSettings
    head: HeadSettings
    battery: BatterySettings

    @property
    def tick_s(self) -> float:
        """Length of one tick, in s."""
        return self.time_step_s * self.steps_per_tick


def load_settings() -> Settings:
    """Settings as the file gives them.

    Raises:
        ConfigError: The file cannot be read, or a key is unknown or missing.
    """
    return read_settings(Settings, config_file(FILE))
