"""Timed Bezier curves of one joint, as ALMotion's Bezier interpolations describe them.

Between two key points runs a cubic Bezier curve of time *and* angle: the handle after the first point and the handle
before the second one are its inner control points. Time is itself a polynomial of the curve's parameter, so an angle
at a time is found by solving for the parameter. Arithmetic only.
"""

from __future__ import annotations

from array import array
from bisect import bisect_right
from dataclasses import dataclass, field
from enum import IntEnum
from functools import cached_property
from typing import Any, Iterable, Sequence, Tuple, overload

import numpy as np

from nao_sim_bridge.control.joints.curves import ROUNDING

# The parameter is found to this accuracy, which is far below a tick; a cubic needs about five Newton steps.
ACCURACY, STEPS = 1e-10, 60
# Points at which a segment's range and speed are looked at: good for a per cent, and cheap for long timelines.
SAMPLES = 16


class Interpolation(IntEnum):
    """How a curve leaves or reaches a key point, as NAOqi numbers it; timelines are exported with 3."""

    CONSTANT = 0
    LINEAR = 1
    SMOOTH = 2
    BEZIER = 3


CURVED = (Interpolation.SMOOTH, Interpolation.BEZIER)


@dataclass(frozen=True)
class Handle:
    """A control point beside a key point, and what the curve does on this side of it.

    Its time, s, and angle, rad, are offsets from the key point; the time is negative before it, positive after it.
    """

    kind: Interpolation = Interpolation.LINEAR
    time: float = 0.0
    angle: float = 0.0


PLAIN = Handle()


@dataclass(frozen=True)
class KeyPoint:
    """A point that the joint passes at a time, s, and an angle, rad; handles of the curves that come in and go on."""

    time: float
    angle: float
    before: Handle = PLAIN
    after: Handle = PLAIN


_FIELDS = 8


class PackedKeyPoints(Sequence[KeyPoint]):
    """Key points that are kept for later, of which there may be many: they take 64 bytes each, a ninth of others."""

    def __init__(self, points: Iterable[KeyPoint]) -> None:
        sides = lambda p: (number for h in (p.before, p.after) for number in (h.kind, h.time, h.angle))  # noqa: E731
        self._numbers = array("d", [number for p in points for number in (p.time, p.angle, *sides(p))])

    @property
    def nbytes(self) -> int:
        """Memory that they take."""
        return self._numbers.itemsize * len(self._numbers)

    def __len__(self) -> int:
        return len(self._numbers) // _FIELDS

    @overload
    def __getitem__(self, place: int) -> KeyPoint: ...

    @overload
    def __getitem__(self, place: slice) -> Tuple[KeyPoint, ...]: ...

    def __getitem__(self, place: Any) -> Any:
        if isinstance(place, slice):
            return tuple(self[i] for i in range(*place.indices(len(self))))
        begin = _FIELDS * range(len(self))[place]
        time, angle, *handles = self._numbers[begin : begin + _FIELDS]
        before, after = (Handle(Interpolation(int(kind)), *offset) for kind, *offset in (handles[:3], handles[3:]))
        return KeyPoint(time, angle, before, after)

    def __eq__(self, other: Any) -> bool:
        return tuple(self) == tuple(other) if isinstance(other, Sequence) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._numbers.tobytes())


@dataclass(frozen=True)
class BezierCurve:
    """A joint's way through key points.

    The kind of a segment is that of the handle after its first point: linear, Bezier, or constant, which stays at the
    first point and jumps to the second one at its time.

    Attributes:
        points: Key points, times strictly rising, the first at 0; at least two.
    """

    points: Sequence[KeyPoint]
    _times: tuple[float, ...] = field(init=False, repr=False, compare=False)
    _segments: tuple[_Segment, ...] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        times = tuple(point.time for point in self.points)
        if len(times) < 2:
            raise ValueError(f"{len(times)} key points: need at least 2")
        if any(b <= a for a, b in zip(times, times[1:])):
            raise ValueError(f"times {list(times)} do not rise strictly")
        object.__setattr__(self, "_times", times)
        object.__setattr__(self, "_segments", tuple(_Segment(a, b) for a, b in zip(self.points, self.points[1:])))

    @property
    def duration(self) -> float:
        """Time of the last point, in s."""
        return self._times[-1]

    @property
    def extremes(self) -> tuple[float, float]:
        """Smallest and largest angle, in rad, sampled."""
        _, angles = self._samples
        return float(angles.min()), float(angles.max())

    def value(self, elapsed: float) -> float:
        """Angle in rad after `elapsed` seconds; holds the end points outside."""
        if elapsed <= self._times[0]:
            return self.points[0].angle
        if elapsed >= self._times[-1] - ROUNDING:
            return self.points[-1].angle
        return self._segments[bisect_right(self._times, elapsed) - 1].value(elapsed)

    def peak_speed(self) -> float:
        """Largest speed along the curve in rad/s, sampled; a jump takes no time, but the joint a while."""
        times, angles = self._samples
        moves = [segment.kind is not Interpolation.CONSTANT for segment in self._segments]
        spans, ways = np.diff(times[moves]), np.abs(np.diff(angles[moves]))
        speeds = ways[spans > ACCURACY] / spans[spans > ACCURACY]
        return float(speeds.max(initial=0.0))

    @cached_property
    def _samples(self) -> tuple[np.ndarray, np.ndarray]:
        """Times (s, since its begin) and angles (rad) along every segment, a row each."""
        powers = np.vander(np.linspace(0.0, 1.0, SAMPLES + 1), 4, increasing=True).T
        return tuple(
            np.array(rows) @ powers
            for rows in ([s.time_powers for s in self._segments], [s.angle_powers for s in self._segments])
        )


class _Segment:
    """The curve between two key points."""

    def __init__(self, start: KeyPoint, end: KeyPoint) -> None:
        self.kind = start.after.kind
        span = end.time - start.time
        first, last = (0.0, 0.0), (0.0, 0.0)
        if self.kind in CURVED:
            first = _within(start.after.time, start.after.angle, span)
            if end.before.kind in CURVED:
                last = _within(-end.before.time, end.before.angle, span)
        self._start, self._span = start.time, span
        self._ends = (start.angle, end.angle)
        # Coefficients of rising powers of the parameter: of time since the start, and of the angle.
        self.time_powers = _powers(0.0, first[0], span - last[0], span)
        self.angle_powers = _powers(start.angle, start.angle + first[1], end.angle + last[1], end.angle)

    def value(self, time: float) -> float:
        since = time - self._start
        if self.kind is Interpolation.CONSTANT:
            return self._ends[0]
        if self.kind is Interpolation.LINEAR:
            return self._ends[0] + since / self._span * (self._ends[1] - self._ends[0])
        return _polynomial(self.angle_powers, self._parameter(since))

    def _parameter(self, since: float) -> float:
        """The parameter at a time: Newton steps, halving the bracket where they would leave it."""
        _, c1, c2, c3 = self.time_powers
        low, high, s = 0.0, 1.0, since / self._span
        for _ in range(STEPS):
            error = s * (c1 + s * (c2 + s * c3)) - since
            if abs(error) < ACCURACY:
                break
            low, high = (s, high) if error < 0.0 else (low, s)
            slope = c1 + s * (2.0 * c2 + 3.0 * c3 * s)
            s = s - error / slope if slope > ACCURACY else low
            if not low < s < high:
                s = (low + high) / 2.0
        return s


def _within(time: float, angle: float, span: float) -> tuple[float, float]:
    """A handle that stays within its segment: a longer one would make time run backwards, it is shortened."""
    if time <= 0.0:
        return 0.0, angle
    share = min(1.0, span / time)
    return share * time, share * angle


def _powers(p0: float, p1: float, p2: float, p3: float) -> tuple[float, float, float, float]:
    """Coefficients of rising powers of the cubic Bezier polynomial of four values."""
    return p0, 3.0 * (p1 - p0), 3.0 * (p2 - 2.0 * p1 + p0), p3 - 3.0 * p2 + 3.0 * p1 - p0


def _polynomial(c: Sequence[float], s: float) -> float:
    return c[0] + s * (c[1] + s * (c[2] + s * c[3]))
