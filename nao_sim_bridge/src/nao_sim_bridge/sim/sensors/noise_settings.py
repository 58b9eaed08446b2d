"""How far readings are from the truth, read strictly from `config/sensors.json`."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any, Type, TypeVar

from nao_sim_bridge.paths import config_file
from nao_sim_bridge.sim.config import check_keys, read_json, vector
from nao_sim_bridge.sim.errors import ConfigError

FILE = "sensors.json"
T = TypeVar("T")


@dataclass(frozen=True)
class JointNoise:
    """Of encoders: noise and step of an angle in rad (for hands: of the opening 0..1), noise of a speed in rad/s."""

    angle: float
    angle_step: float
    speed: float


@dataclass(frozen=True)
class InertialNoise:
    """Of the inertial unit.

    Attributes:
        angle_wander: Slow error of roll, pitch and yaw, rad.
        angle_wander_time_s: Time after which that error has little to do any more with what it was.
        angle: Fast noise of the three angles, rad.
        gyroscope: rad/s.
        accelerometer: m/s2.
    """

    angle_wander: float
    angle_wander_time_s: float
    angle: float
    gyroscope: float
    accelerometer: float


@dataclass(frozen=True)
class FootNoise:
    """Of the force sensors: error for good of each foot, and noise, both as shares of the force."""

    calibration: float
    force: float


@dataclass(frozen=True)
class NoiseSettings:
    """All of `sensors.json`: standard deviations, at a scale of 1."""

    joints: JointNoise
    inertial: InertialNoise
    feet: FootNoise


def load_noise() -> NoiseSettings:
    """Settings as the file gives them.

    Raises:
        ConfigError: The file cannot be read, or a key is unknown, missing, or no number of 0 or more.
    """
    content = check_keys(read_json(config_file(FILE)), FILE, ["joints", "inertial", "feet"], ["_meta"])
    return NoiseSettings(
        joints=_section(JointNoise, content["joints"], f"{FILE}: joints"),
        inertial=_section(InertialNoise, content["inertial"], f"{FILE}: inertial"),
        feet=_section(FootNoise, content["feet"], f"{FILE}: feet"),
    )


def _section(cls: Type[T], entry: Any, where: str) -> T:
    names = [f.name for f in fields(cls)]  # type: ignore[arg-type]
    check_keys(entry, where, names)
    values = {name: float(vector([entry[name]], f"{where}.{name}", 1)[0]) for name in names}
    for name, value in values.items():
        if value < 0.0 or (name.endswith("_s") and value == 0.0):
            allowed = "above 0" if value == 0.0 else "0 or more"
            raise ConfigError(f"{where}.{name}", f"is {value:g}, allowed is {allowed}")
    return cls(**values)
