"""Settings of the physics, read strictly from `config/physics.json`."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any, Mapping

from nao_sim_bridge.paths import config_file
from nao_sim_bridge.sim.config import check_keys, read_json, section

FILE = "physics.json"


@dataclass(frozen=True)
class MotorSettings:
    """How motors follow, resist and warm up; see the file's source notes."""

    position_gain: float
    velocity_gain: float
    feed_forward: float
    limp_friction: float
    coupling_force_n: float
    gear_efficiency: float
    ambient_c: float
    heating_k_per_a2_s: float
    cooling_per_s: float


@dataclass(frozen=True)
class ContactSettings:
    """Friction (coefficients) and stiffness (N/m, N s/m) of the robot's contacts."""

    sole_friction: float
    body_friction: float
    sole_stiffness: float
    sole_damping: float


@dataclass(frozen=True)
class BatterySettings:
    """The battery and what the robot draws at rest."""

    voltage_v: float
    capacity_ah: float
    idle_current_a: float


@dataclass(frozen=True)
class Settings:
    """All of `physics.json`."""

    time_step_s: float
    steps_per_tick: int
    solver_iterations: int
    gravity_m_s2: float
    motor: MotorSettings
    contact: ContactSettings
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
    content: Mapping[str, Any] = read_json(config_file(FILE))
    names = [f.name for f in fields(Settings)]
    check_keys(content, FILE, names, ["_meta"])
    sections = {"motor": MotorSettings, "contact": ContactSettings, "battery": BatterySettings}
    values = {n: section(sections[n], content[n], f"{FILE}: {n}") if n in sections else content[n] for n in names}
    return Settings(**values)
