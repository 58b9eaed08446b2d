"""Curves of one joint over time. Arithmetic only: times are passed in, so no test has to wait."""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass, field
from typing import Sequence

# Sums of ticks are not exact: a curve whose end is this close, in s, is at its end and not a hair before.
ROUNDING = 1e-9


@dataclass(frozen=True)
class Ramp:
    """One joint that moves from start to target, rad (hands: 0..1), at a constant speed, rad/s, always positive."""

    start: float
    target: float
    speed: float

    @property
    def duration(self) -> float:
        """Time from start to target, in s."""
        return abs(self.target - self.start) / self.speed

    @property
    def extremes(self) -> tuple[float, float]:
        """Smallest and largest angle, in rad."""
        return min(self.start, self.target), max(self.start, self.target)

    def peak_speed(self) -> float:
        """Largest speed along the ramp, in rad/s."""
        return self.speed

    def value(self, elapsed: float) -> float:
        """Angle in rad after `elapsed` seconds; holds start before and target afterwards."""
        duration = self.duration
        if elapsed >= duration - ROUNDING or duration == 0.0:
            return self.target
        return self.start + max(elapsed, 0.0) / duration * (self.target - self.start)


@dataclass(frozen=True)
class SmoothCurve:
    """A curve through key points, at rest at both ends, without overshoot between two points.

    Each segment is a cubic Hermite polynomial. The slope at an inner point is the harmonic mean of its two chords,
    zero at a turning point (the monotone rule of Fritsch and Butland), so a joint never leaves the range that its key
    points span.

    Attributes:
        times: Times of the points in s, strictly rising, the first is 0.
        values: Angles at these times, in rad.
    """

    times: Sequence[float]
    values: Sequence[float]
    _slopes: tuple[float, ...] = field(init=False, repr=False, compare=False)
    _segments: tuple[tuple[float, ...], ...] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        if len(self.times) != len(self.values) or len(self.times) < 2:
            raise ValueError(f"{len(self.times)} times and {len(self.values)} values: need equally many, at least 2")
        if any(b <= a for a, b in zip(self.times, self.times[1:])):
            raise ValueError(f"times {list(self.times)} do not rise strictly")
        object.__setattr__(self, "_slopes", _monotone_slopes(self.times, self.values))
        ends = zip(self.times, self.times[1:], self.values, self.values[1:], self._slopes, self._slopes[1:])
        object.__setattr__(self, "_segments", tuple(_hermite(*end) for end in ends))

    @property
    def duration(self) -> float:
        """Time of the last point, in s."""
        return self.times[-1]

    def value(self, elapsed: float) -> float:
        """Angle in rad after `elapsed` seconds; holds the end points outside."""
        times, values = self.times, self.values
        if elapsed <= times[0]:
            return values[0]
        if elapsed >= times[-1] - ROUNDING:
            return values[-1]
        i = bisect_right(times, elapsed) - 1
        start, length, c0, c1, c2, c3 = self._segments[i]
        share = (elapsed - start) / length
        return c0 + share * (c1 + share * (c2 + share * c3))

    @property
    def extremes(self) -> tuple[float, float]:
        """Smallest and largest angle, in rad: the curve does not leave the range of its points."""
        return min(self.values), max(self.values)

    def peak_speed(self) -> float:
        """Largest speed along the curve, in rad/s."""
        return max(_peak_slope(*segment[2:]) / segment[1] for segment in self._segments)


def _monotone_slopes(times: Sequence[float], values: Sequence[float]) -> tuple[float, ...]:
    chords = [(values[i + 1] - values[i]) / (times[i + 1] - times[i]) for i in range(len(times) - 1)]
    inner = [2 * a * b / (a + b) if a * b > 0 else 0.0 for a, b in zip(chords, chords[1:])]
    return (0.0, *inner, 0.0)


def _hermite(t0: float, t1: float, p0: float, p1: float, v0: float, v1: float) -> tuple[float, ...]:
    """Start and length in s of the cubic from (t0, p0) to (t1, p1) with end speeds v0 and v1, and its coefficients.

    The coefficients belong to rising powers of the share of the length that has passed.
    """
    length = t1 - t0
    m0, m1, rise = v0 * length, v1 * length, p1 - p0
    return t0, length, p0, m0, 3.0 * rise - 2.0 * m0 - m1, m0 + m1 - 2.0 * rise


def _peak_slope(_: float, c1: float, c2: float, c3: float) -> float:
    """Largest magnitude of the slope of a cubic on [0, 1]: at an end or where the slope turns."""
    shares = [0.0, 1.0]
    if c3 != 0.0 and 0.0 < -c2 / (3.0 * c3) < 1.0:
        shares.append(-c2 / (3.0 * c3))
    return max(abs(c1 + share * (2.0 * c2 + 3.0 * c3 * share)) for share in shares)
