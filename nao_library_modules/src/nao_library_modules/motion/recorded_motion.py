"""A recorded motion: joints, times, angles; replayed faster, mirrored, thinned out. No ROS, no robot."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from ..base.errors import BadGoal

# Between two key frames of a replayed motion a joint may be off the recording by this, rad: what the encoders tell
# apart, several times over.
THINNING = math.radians(0.2)
# A joint that leans on its stop measures a little more than its limit, and the limits of the two sides differ by up to
# half a degree: so far, in rad, a recorded angle may be off the limits of the joint that replays it.
SLACK = math.radians(1.5)
# Of the files; a later one may hold more.
VERSION = 1
# Joints whose sign changes in the mirror, by the end of their names.
TURNED = ("Roll", "Yaw")


@dataclass(frozen=True)
class RecordedMotion:
    """Angles of joints over time."""

    joints: tuple[str, ...]
    times: tuple[float, ...]  # s, rising, the first is 0
    angles: tuple[tuple[float, ...], ...]  # of each time those of the joints, rad (hands 0..1)

    @property
    def duration(self) -> float:
        """Time of the last sample, s."""
        return self.times[-1]

    @property
    def start(self) -> dict[str, float]:
        """Joint -> angle at the start, rad."""
        return dict(zip(self.joints, self.angles[0]))

    def faster(self, factor: float) -> RecordedMotion:
        """The same motion at `factor` times the speed."""
        return replace(self, times=tuple(time / factor for time in self.times))

    def mirrored(self) -> RecordedMotion:
        """The motion with left and right exchanged."""
        joints = tuple(_other_side(joint) for joint in self.joints)
        signs = [_sign(joint) for joint in joints]
        return replace(
            self,
            joints=joints,
            angles=tuple(tuple(sign * angle for sign, angle in zip(signs, row)) for row in self.angles),
        )

    def within(self, limits: Mapping[str, tuple[float, float]], slack: float = SLACK) -> RecordedMotion:
        """The motion with angles that are beyond a limit by no more than `slack` put on the limit.

        `limits`: joint -> lowest and highest angle, rad. Joints that are not in it stay as they are. `slack`: rad. What
        is farther off stays as it is: it is no measurement of such a joint.
        """
        ranges = [limits.get(joint, (-math.inf, math.inf)) for joint in self.joints]
        return replace(
            self,
            angles=tuple(
                tuple(_put_within(angle, *range_, slack) for angle, range_ in zip(row, ranges)) for row in self.angles
            ),
        )

    def key_frames(self, tolerance: float = THINNING) -> RecordedMotion:
        """The motion with as few samples as keep every joint within `tolerance` (rad) between straight lines."""
        keep = {0, len(self.times) - 1}
        open_ = [(0, len(self.times) - 1)]
        while open_:
            first, last = open_.pop()
            worst, where = self._worst(first, last)
            if worst > tolerance:
                keep.add(where)
                open_ += [(first, where), (where, last)]
        chosen = sorted(keep)
        return replace(self, times=tuple(self.times[i] for i in chosen), angles=tuple(self.angles[i] for i in chosen))

    def _worst(self, first: int, last: int) -> tuple[float, int]:
        """Largest distance of a sample from the line between two others, and which one it is."""
        worst, where = 0.0, first
        begin, end = self.angles[first], self.angles[last]
        span = self.times[last] - self.times[first]
        for i in range(first + 1, last):
            share = (self.times[i] - self.times[first]) / span
            off = max(abs(a - b - share * (e - b)) for a, b, e in zip(self.angles[i], begin, end))
            if off > worst:
                worst, where = off, i
        return worst, where

    def to_content(self) -> dict[str, Any]:
        """As plain values, for a file."""
        samples = [[round(time, 4), *(round(angle, 5) for angle in row)] for time, row in zip(self.times, self.angles)]
        return {"version": VERSION, "joints": list(self.joints), "samples": samples}


def motion_of(content: Any, where: str) -> RecordedMotion:
    """The motion in the content of a file, as `to_content` gives it; BadGoal calls it `where` if it is none."""
    if not isinstance(content, Mapping) or not {"joints", "samples"} <= set(content):
        raise _broken(where, "it has no joints or no samples")
    if content.get("version") != VERSION:
        raise _broken(where, f"its version is {content.get('version')!r}; known: {VERSION}")
    joints, samples = content["joints"], content["samples"]
    if not isinstance(joints, list) or not joints or not all(isinstance(joint, str) for joint in joints):
        raise _broken(where, "joints is no list of names")
    if len(set(joints)) < len(joints):
        raise _broken(where, "a joint comes twice")
    if not isinstance(samples, list) or not samples:
        raise _broken(where, "samples is no list")
    for i, row in enumerate(samples):
        if not isinstance(row, list) or len(row) != len(joints) + 1 or not all(map(_is_number, row)):
            raise _broken(where, f"sample {i} is not a time and {len(joints)} angles")
    times = [row[0] for row in samples]
    if times[0] != 0.0 or any(b <= a for a, b in zip(times, times[1:])):
        raise _broken(where, "times do not rise from 0")
    return RecordedMotion(tuple(joints), tuple(times), tuple(tuple(row[1:]) for row in samples))


def _broken(where: str, problem: str) -> BadGoal:
    return BadGoal("str_param", where, "a recorded motion", problem=f"motion {where!r}: {problem}")


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)


def _put_within(angle: float, lower: float, upper: float, slack: float) -> float:
    nearest = min(max(angle, lower), upper)
    return nearest if abs(nearest - angle) <= slack else angle


def _other_side(joint: str) -> str:
    if joint.startswith("L"):
        return f"R{joint[1:]}"
    return f"L{joint[1:]}" if joint.startswith("R") else joint


def _sign(joint: str) -> float:
    return -1.0 if joint.endswith(TURNED) else 1.0


def recorded(joints: Sequence[str], samples: Iterable[tuple[float, Sequence[float]]]) -> RecordedMotion:
    """A motion from samples of time (s, the first is taken as 0) and angles (rad)."""
    rows = list(samples)
    began = rows[0][0]
    return RecordedMotion(tuple(joints), tuple(time - began for time, _ in rows), tuple(tuple(row) for _, row in rows))
