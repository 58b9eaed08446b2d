"""What the events of the robot's hearing say: words, sounds, and directions, also seen from the base. Pure."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Tuple

Vector = Tuple[float, float, float]


@dataclass(frozen=True)
class Bearing:
    azimuth: float  # rad, positive to the left
    elevation: float  # rad, positive upwards

    @property
    def vector(self) -> Vector:
        """Unit vector: X ahead, Y to the left, Z up."""
        flat = math.cos(self.elevation)
        return flat * math.cos(self.azimuth), flat * math.sin(self.azimuth), math.sin(self.elevation)

    @classmethod
    def of(cls, vector: Vector) -> Bearing:
        """The direction of a vector of any length."""
        x, y, z = vector
        return cls(math.atan2(y, x), math.atan2(z, math.hypot(x, y)))


@dataclass(frozen=True)
class BegunSound:
    confidence: float  # 0..1
    time: float  # when it began, s of the robot; 0 if the robot does not report that


@dataclass(frozen=True)
class LocatedSound:
    in_head: Bearing  # in the frame of the head
    in_base: Bearing  # in NAOqi's FRAME_ROBOT
    head: Vector  # where the head was in FRAME_ROBOT, m
    confidence: float  # 0..1
    energy: float  # loudness as the robot reports it; 0 if it does not
    time: float  # when it was located, s of the robot


def turned(vector: Vector, angles: Sequence[float]) -> Vector:
    """A vector of a turned frame, in the frame that it is turned in.

    `vector`: in the turned frame. `angles`: (3,) rad about X, Y, Z, as in NAOqi's Position6D: Z is turned about last.
    """
    x, y, z = vector
    wx, wy, wz = angles
    y, z = y * math.cos(wx) - z * math.sin(wx), y * math.sin(wx) + z * math.cos(wx)
    x, z = x * math.cos(wy) + z * math.sin(wy), z * math.cos(wy) - x * math.sin(wy)
    return x * math.cos(wz) - y * math.sin(wz), x * math.sin(wz) + y * math.cos(wz), z


def located_sound(value: Any) -> LocatedSound:
    """A sound from the value of ALSoundLocalization/SoundLocated.

    `value`: [[s, us], [azimuth, elevation, confidence, energy], head in the torso, head in FRAME_ROBOT], the last two
    Position6D in m and rad. Raises ValueError if the value is something else.
    """
    try:
        (seconds, microseconds), (azimuth, elevation, confidence, *energy), _, head = value
        in_head = Bearing(float(azimuth), float(elevation))
        x, y, z, *angles = map(float, head)
        in_base = Bearing.of(turned(in_head.vector, angles))
        loudness, time = float(energy[0]) if energy else 0.0, float(seconds) + 1e-6 * float(microseconds)
        return LocatedSound(in_head, in_base, (x, y, z), float(confidence), loudness, time)
    except (TypeError, ValueError) as error:
        raise ValueError(f"no sound that was located: {value!r}") from error


def begun_sounds(value: Any) -> list[BegunSound]:
    """The sounds that begin in a value of SoundDetected.

    `value`: [[index, type, confidence, time in us], ...], type 1 for the begin of a sound, 0 for its end; a single one
    may stand alone. Raises ValueError if the value is something else.
    """
    try:
        rows = [value] if value and not isinstance(value[0], (list, tuple)) else value
        begun = [(float(confidence), time) for _, kind, confidence, *time in rows if int(kind) == 1]
        return [BegunSound(confidence, 1e-6 * float(time[0]) if time else 0.0) for confidence, time in begun]
    except (TypeError, ValueError) as error:
        raise ValueError(f"no sounds that were detected: {value!r}") from error


def recognised(value: Any) -> list[tuple[str, float]]:
    """Phrases and confidences (0..1) in a value of WordRecognized, the best first.

    Word spotting wraps phrases in marks, which are taken off. A value that was reset has none. Raises ValueError if the
    value is something else. `value`: [phrase, confidence, phrase, confidence, ...].
    """
    try:
        value = list(value or [])
        if len(value) % 2:
            raise ValueError("a phrase has no confidence")
        pairs = zip(value[::2], map(float, value[1::2]))
        return [(words, confidence) for phrase, confidence in pairs for words in [_bare(phrase)] if words]
    except (TypeError, ValueError) as error:
        raise ValueError(f"no words that were recognised: {value!r}") from error


def _bare(phrase: Any) -> str:
    if not isinstance(phrase, str):
        raise ValueError(f"{phrase!r} is no phrase")
    return phrase.replace("<...>", " ").strip()
