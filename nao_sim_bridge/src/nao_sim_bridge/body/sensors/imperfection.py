"""What keeps readings from being the truth: noise, steps of the encoders, and the time until they arrive.

Pure arithmetic on readings: what the robot feels of itself comes in true and of now, and goes out as a real robot's
computer would see it.
"""

from __future__ import annotations

import math
import random
from collections import deque
from dataclasses import asdict, dataclass
from typing import Deque, Iterable, Mapping, NamedTuple, Sequence, Tuple

from nao_sim_bridge.base.config import config_file, read_settings
from nao_sim_bridge.base.errors import ConfigError
from nao_sim_bridge.base.readings import Contact, JointReadings, Pose
from nao_sim_bridge.base.rotations import Vector3
from nao_sim_bridge.body.sensors.snapshot import Imu

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


class Felt(NamedTuple):
    """What the robot feels of itself at one tick.

    Attributes:
        joints: Angles, speeds, torques.
        imu: The inertial unit.
        contacts: What presses on the robot.
        link_poses: Link index to the pose in world of each link that has a contact.
    """

    joints: JointReadings
    imu: Imu
    contacts: Tuple[Contact, ...]
    link_poses: Mapping[int, Pose]


class Noise:
    """Adds the errors of sensors to readings; a seeded stream makes them the same at each run.

    Args:
        settings: Sizes of the errors at a scale of 1.
        scale: Multiplies all of them; 1 is a real robot.
        feet: Link indices of the feet, whose force sensors have errors of their own.
        dt: Length of a tick, s.
    """

    def __init__(
        self, settings: NoiseSettings, scale: float, stream: random.Random, feet: Iterable[int], dt: float
    ) -> None:
        self._settings = settings
        self._scale = scale
        self._gauss = stream.gauss
        self._gains = {foot: 1.0 + self._draw(settings.feet.calibration) for foot in feet}
        wander = settings.inertial.angle_wander
        self._wander = [self._draw(wander) for _ in range(3)]
        # The error is drawn towards zero and pushed about, so that its size stays the same for ever.
        self._keep = math.exp(-dt / settings.inertial.angle_wander_time_s)
        self._stir = wander * math.sqrt(1.0 - self._keep * self._keep)

    def spoil(self, felt: Felt) -> Felt:
        """The readings of a tick with the errors of this tick."""
        joints = felt.joints
        return felt._replace(
            joints=JointReadings(self._angles(joints.positions), self._speeds(joints.velocities), joints.torques),
            imu=self._inertial(felt.imu),
            contacts=tuple([self._pressed(contact) for contact in felt.contacts]),
        )

    def _angles(self, angles: Sequence[float]) -> tuple[float, ...]:
        settings, scale, gauss = self._settings.joints, self._scale, self._gauss
        noise, step = settings.angle * scale, settings.angle_step * scale
        noisy = [angle + gauss(0.0, noise) for angle in angles]
        return tuple([round(angle / step) * step for angle in noisy]) if step > 0.0 else tuple(noisy)

    def _speeds(self, speeds: Sequence[float]) -> tuple[float, ...]:
        return tuple([speed + self._draw(self._settings.joints.speed) for speed in speeds])

    def _inertial(self, imu: Imu) -> Imu:
        settings = self._settings.inertial
        self._wander = [self._keep * error + self._draw(self._stir) for error in self._wander]
        angles = [angle + error for angle, error in zip(imu.angles, self._wander)]
        return Imu(
            self._noisy(imu.accelerometer, settings.accelerometer),
            self._noisy(imu.gyroscope, settings.gyroscope),
            self._noisy(angles, settings.angle),
        )

    def _pressed(self, contact: Contact) -> Contact:
        gain = self._gains.get(contact.link)
        if gain is None:
            return contact
        # A force sensor under load never reads a pull.
        share = max(0.0, gain * (1.0 + self._draw(self._settings.feet.force)))
        return contact._replace(force=contact.force * share)

    def _noisy(self, values: Sequence[float], noise: float) -> Vector3:
        x, y, z = values
        return (x + self._draw(noise), y + self._draw(noise), z + self._draw(noise))

    def _draw(self, deviation: float) -> float:
        return self._gauss(0.0, deviation * self._scale)


class Delay:
    """Lets readings arrive late, by so many ticks; 0 is at once."""

    def __init__(self, ticks: int) -> None:
        self._line: Deque[Felt] = deque(maxlen=ticks + 1)

    def arrive(self, felt: Felt) -> Felt:
        """What arrives now, when `felt` leaves; the first readings of all until something older than that is there."""
        self._line.append(felt)
        return self._line[0]


class Imperfection:
    """Noise, None for a robot without it, and delay of one robot."""

    def __init__(self, noise: Noise | None, delay: Delay) -> None:
        self._noise = noise
        self._delay = delay

    def of(
        self, joints: JointReadings, imu: Imu, contacts: Tuple[Contact, ...], link_poses: Mapping[int, Pose]
    ) -> Felt:
        """What the robot's computer sees at a tick, of what is true in it; see `Felt`."""
        felt = Felt(joints, imu, contacts, link_poses)
        return self._delay.arrive(self._noise.spoil(felt) if self._noise is not None else felt)
