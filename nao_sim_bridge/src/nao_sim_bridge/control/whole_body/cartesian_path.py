"""Paths of effectors through poses, as curves of the joints. Pure.

The joints pass through an exact solution every `SAMPLE_TIME` and are interpolated between. Solutions are found when
time comes near them, so that a long path costs no more in one tick than a short one.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from dataclasses import dataclass
from typing import Callable, Iterable, Sequence

import numpy as np

from nao_sim_bridge.control.joints.curves import ROUNDING, SmoothCurve
from nao_sim_bridge.control.whole_body.body_kinematics import BodyKinematics
from nao_sim_bridge.control.whole_body.grounded_pose import Footing
from nao_sim_bridge.control.whole_body.inverse_kinematics import Goal, rotation_vector, solve
from nao_sim_bridge.model.kinematics import axis_matrix, transform

# Between two solutions the joints deviate from the path by less than a motor does. Seconds.
SAMPLE_TIME = 0.05
# A solution is close to the one before, so that few iterations do; more would be felt in the tick.
SAMPLE_ITERATIONS = 12
# Samples that a path remembers: time does not go back in a motion, and the slopes need a few around it.
KEPT = 8


class PosePath:
    """A smooth path through poses, at rest at both ends.

    Attributes:
        duration: Time of the last pose, s.

    Args:
        times: Times of the poses, s, the first is 0.
        poses: (4, 4) each, in one frame.
    """

    def __init__(self, times: Sequence[float], poses: Sequence[np.ndarray]) -> None:
        self.duration = times[-1]
        self._start = poses[0][:3, :3]
        turns = [rotation_vector(self._start.T @ pose[:3, :3]) for pose in poses]
        points = [(*pose[:3, 3], *turn) for pose, turn in zip(poses, turns)]
        self._curves = [SmoothCurve(tuple(times), tuple(float(v) for v in values)) for values in zip(*points)]

    def pose(self, elapsed: float) -> np.ndarray:
        """(4, 4) pose after `elapsed` seconds."""
        values = [curve.value(elapsed) for curve in self._curves]
        angle = math.sqrt(sum(v * v for v in values[3:]))
        turn = axis_matrix([v / angle for v in values[3:]], angle) if angle > 0.0 else np.eye(3)
        return transform(self._start @ turn, values[:3])


class SampleTimes(Sequence[float]):
    """Rising times in s from 0 to the last of some: every one of them, and steps between. None of them is kept."""

    def __init__(self, times: Iterable[float]) -> None:
        # Of each stretch between two of the times: number of its first sample, its length in samples and in s.
        self._firsts, self._starts, self._counts, self._lengths = [], [], [], []
        first, start = 0, 0.0
        for end in times:
            if end > start:
                count = max(1, math.ceil((end - start) / SAMPLE_TIME - ROUNDING))
                self._firsts.append(first)
                self._starts.append(start)
                self._counts.append(count)
                self._lengths.append(end - start)
                first, start = first + count, end
        self._last, self._end = first, start

    def __len__(self) -> int:
        return self._last + 1

    def __getitem__(self, number: int) -> float:
        number = number + len(self) if number < 0 else number
        if not 0 <= number <= self._last:
            raise IndexError(number)
        if number == self._last:
            return self._end
        i = bisect_right(self._firsts, number) - 1
        return self._starts[i] + self._lengths[i] * (number - self._firsts[i]) / self._counts[i]


class SolvedPath:
    """Joint angles along a path, solved when they are needed.

    Args:
        times: When to solve, s, rising from 0.
        first: (n,) angles at time 0, rad.
        solve_at: (time in s, angles of the sample before) -> angles then.
    """

    def __init__(
        self, times: Sequence[float], first: np.ndarray, solve_at: Callable[[float, np.ndarray], np.ndarray]
    ) -> None:
        self.times = times
        # By number; those that time has left behind are forgotten.
        self._solved = {0: first}
        self._newest = 0
        self._solve_at = solve_at
        self._latest: tuple[float, np.ndarray] | None = None

    def angles(self, elapsed: float) -> np.ndarray:
        """(n,) angles after `elapsed` seconds; holds the end points outside."""
        # Every joint asks for the same time in turn.
        if self._latest is None or self._latest[0] != elapsed:
            self._latest = (elapsed, self._interpolated(elapsed))
        return self._latest[1]

    def _interpolated(self, elapsed: float) -> np.ndarray:
        last = len(self.times) - 1
        if elapsed >= self.times[-1] - ROUNDING:
            return self._sample(last)
        i = max(bisect_right(self.times, elapsed) - 1, 0)
        length = self.times[i + 1] - self.times[i]
        s = min(max((elapsed - self.times[i]) / length, 0.0), 1.0)
        t = 1.0 - s
        start, end = self._sample(i), self._sample(i + 1)
        slope_start, slope_end = self._slope(i) * length, self._slope(i + 1) * length
        return t * t * ((1 + 2 * s) * start + s * slope_start) + s * s * ((1 + 2 * t) * end - t * slope_end)

    def _sample(self, i: int) -> np.ndarray:
        while self._newest < i:
            before = self._solved[self._newest]
            self._newest += 1
            self._solved[self._newest] = self._solve_at(self.times[self._newest], before)
            self._solved.pop(self._newest - KEPT, None)
        return self._solved[max(i, self._newest - KEPT + 1)]

    def _slope(self, i: int) -> np.ndarray:
        """(n,) slope at a sample by the monotone rule of `SmoothCurve`: no joint leaves the range of its samples."""
        if i in (0, len(self.times) - 1):
            return np.zeros(len(self._solved[self._newest]))
        before, here, after = (self._sample(k) for k in (i - 1, i, i + 1))
        a = (here - before) / (self.times[i] - self.times[i - 1])
        b = (after - here) / (self.times[i + 1] - self.times[i])
        same = a * b > 0.0
        return np.where(same, 2.0 * a * b / np.where(same, a + b, 1.0), 0.0)


@dataclass(frozen=True, eq=False)
class SolvedCurve:
    """One joint of a solved path."""

    path: SolvedPath
    index: int

    @property
    def duration(self) -> float:
        """Time of the end, s."""
        return self.path.times[-1]

    def value(self, elapsed: float) -> float:
        """Angle in rad after `elapsed` seconds."""
        return float(self.path.angles(elapsed)[self.index])


def joint_curves(
    body: BodyKinematics,
    indices: Iterable[int],
    goals_at: Callable[[float], Sequence[Goal]],
    times: Sequence[float],
    commands: Sequence[float],
    footing_at: Callable[[float], Footing | None] = lambda _: None,
) -> dict[int, SolvedCurve]:
    """Curves of joints that bring frames along paths.

    Args:
        goals_at: The goals at a time in s.
        times: Key times of the paths, s, rising.
        commands: (26,) angles to begin at, rad.
        footing_at: The foot that stands at a time in s; None while the torso stays where it is.
    """
    indices = list(indices)

    def solve_at(moment: float, before: np.ndarray) -> np.ndarray:
        return solve(body, indices, goals_at(moment), before, footing_at(moment), SAMPLE_ITERATIONS)

    path = SolvedPath(SampleTimes(times), np.array(commands, dtype=float), solve_at)
    return {index: SolvedCurve(path, index) for index in indices}
