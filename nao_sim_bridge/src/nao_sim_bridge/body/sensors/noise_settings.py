"""How far readings are from the truth, read strictly from `config/sensor_noise.json`."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass

from nao_sim_bridge.base.config import read_settings
from nao_sim_bridge.base.errors import ConfigError
from nao_sim_bridge.base.paths import config_file

FILE = "sensor_noise.json"


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
    """All of `sensor_noise.json`: standard deviations, at a scale of 1."""

    joints: JointNoise
    inertial: InertialNoise
    feet: FootNoise


def load_noise() -> NoiseSettings:
    """Settings as the file gives them.

    Raises:
        ConfigError: The file cannot be read, or a key is unknown, missing, or no number of 0 or more.
    """
    settings = read_settings(NoiseSettings, config_file(FILE))
    for name, amounts in asdict(settings).items():
        for key, amount in amounts.items():
            is_time = key.endswith("_s")
            if not math.isfinite(amount) or amount < 0.0 or (is_time and amount == 0.0):
                allowed = "above 0" if is_time else "0 or more"
                raise ConfigError(f"{FILE}: {name}.{key}", f"is {amount:g}, allowed is {allowed} and finite")
    return settings
