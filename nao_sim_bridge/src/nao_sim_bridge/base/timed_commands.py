"""Timed commands for one actuator, as the DCM takes them: values at moments, and straight lines between. Pure."""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass
from typing import Iterable, Sequence, Tuple

from nao_sim_bridge.base.errors import BadValue

# (value, moment in ms)
Point = Tuple[float, int]
MERGE, CLEAR_ALL, CLEAR_AFTER, CLEAR_BEFORE = "Merge", "ClearAll", "ClearAfter", "ClearBefore"
UPDATES = (MERGE, CLEAR_ALL, CLEAR_AFTER, CLEAR_BEFORE)
# A command whose moment has come takes this time, s: curves need one, and no motor is that fast.
AT_ONCE = 0.001


def merged(old: Sequence[Point], new: Iterable[Point], update: str) -> tuple[Point, ...]:
    """The commands of an actuator after new ones have come.

    Args:
        old: Those that there were, in the order of time.
        new: Those that come; at the same moment they win.
        update: What becomes of the old ones: Merge keeps them, ClearAll drops them, ClearAfter drops those after the
            first of the new ones, ClearBefore those before the last of the new ones.

    Raises:
        BadValue: There is no such update.
    """
    coming = sorted(new, key=lambda point: point[1])
    if update not in UPDATES:
        raise BadValue("update type", update, ", ".join(UPDATES))
    if not coming or update == CLEAR_ALL:
        return tuple(coming) if update == CLEAR_ALL else tuple(old)
    moments = {moment for _, moment in coming}
    kept = [point for point in old if point[1] not in moments]
    if update == CLEAR_AFTER:
        kept = [point for point in kept if point[1] < coming[0][1]]
    elif update == CLEAR_BEFORE:
        kept = [point for point in kept if point[1] > coming[-1][1]]
    return tuple(sorted([*kept, *coming], key=lambda point: point[1]))


@dataclass(frozen=True)
class Polyline:
    """Straight lines through points, a curve as joints follow it: times, s, that rise from 0, and values at these."""

    times: Tuple[float, ...]
    values: Tuple[float, ...]

    @property
    def duration(self) -> float:
        """Time of the last point, s."""
        return self.times[-1]

    def value(self, elapsed: float) -> float:
        """Value after `elapsed` s; holds both ends."""
        if elapsed <= 0.0:
            return self.values[0]
        if elapsed >= self.times[-1]:
            return self.values[-1]
        i = bisect_right(self.times, elapsed) - 1
        share = (elapsed - self.times[i]) / (self.times[i + 1] - self.times[i])
        return self.values[i] + share * (self.values[i + 1] - self.values[i])


def polyline(points: Sequence[Point], now: int, start: float) -> Polyline | None:
    """The way from `start`, where the actuator is at `now` (ms), through commands; None when there are none.

    Commands whose moment has passed are where the way starts, as if they had been carried out in time.
    """
    if not points:
        return None
    past = [point for point in points if point[1] <= now]
    times, values = [0.0], [start]
    if past:
        times.append(AT_ONCE)
        values.append(past[-1][0])
    for value, moment in points:
        time = (moment - now) / 1000.0
        if time > times[-1]:
            times.append(time)
            values.append(value)
    return Polyline(tuple(times), tuple(values)) if len(times) > 1 else None
