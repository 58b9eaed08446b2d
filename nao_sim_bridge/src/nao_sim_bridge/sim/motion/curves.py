"""Curves of one joint over time. Arithmetic only: times are passed in, so no test has to wait."""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass, field
from typing import Sequence

# Sums of ticks are not exact: a curve whose end is this close, in s, is at its end and not a hair before.
ROUNDING = 1e-9


@dataclass(frozen=True)
class Ramp:
    """One joint moving at constant speed.

    Attributes:
        start: Angle at time zero, in rad (hands: 0..1).
        target: Angle at the end, in rad.
        speed: Magnitude of the velocity, in rad/s, always positive.
    """

    start: float
    target: float
    speed: float

    @property
    def duration(self) -> float:
        """Time from start to target, in s."""
        return abs(self.target - self.start) / self.speed

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

    def __post_init__(self) -> None:
        if len(self.times) != len(self.values) or len(self.times) < 2:
            raise ValueError(f"{len(self.times)} times and {len(self.values)} values: need equally many, at least 2")
        if any(b <= a for a, b in zip(self.times, self.times[1:])):
            raise ValueError(f"times {list(self.times)} do not rise strictly")
        object.__setattr__(self, "_slopes", _monotone_slopes(self.times, self.values))

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
        length = times[i + 1] - times[i]
        s = (elapsed - times[i]) / length
        return _hermite(s, values[i], values[i + 1], self._slopes[i] * length, self._slopes[i + 1] * length)

    def peak_speed(self, samples_per_segment: int = 16) -> float:
        """Largest speed along the curve, in rad/s, sampled."""
        peak = 0.0
        for i in range(len(self.times) - 1):
            length = self.times[i + 1] - self.times[i]
            rise = self.values[i + 1] - self.values[i]
            a, b = self._slopes[i] * length, self._slopes[i + 1] * length
            for k in range(samples_per_segment + 1):
                s = k / samples_per_segment
                slope = 6 * s * (1 - s) * rise + (1 - s) * (1 - 3 * s) * a + s * (3 * s - 2) * b
                peak = max(peak, abs(slope) / length)
        return peak


def _monotone_slopes(times: Sequence[float], values: Sequence[float]) -> tuple[float, ...]:
    chords = [(values[i + 1] - values[i]) / (times[i + 1] - times[i]) for i in range(len(times) - 1)]
    inner = [2 * a * b / (a + b) if a * b > 0 else 0.0 for a, b in zip(chords, chords[1:])]
    return (0.0, *inner, 0.0)


def _hermite(s: float, p0: float, p1: float, m0: float, m1: float) -> float:
    """Cubic through p0 and p1 with end slopes m0 and m1 (per unit of s), at s in [0, 1]."""
    t = 1.0 - s
    return t * t * ((1 + 2 * s) * p0 + s * m0) + s * s * ((1 + 2 * t) * p1 - t * m1)
