"""The LEDs: 89 intensities that change at once, fade, or follow an animation in simulated time.

Only the simulation thread writes. `values` is a tuple that is replaced as a whole, so any thread may read it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Iterable, Mapping, Sequence

from nao_sim_bridge.base.tasks import Task, TaskIds

# Times are sums of ticks: this close to a moment it has come, s.
ROUNDING = 1e-9


@dataclass(frozen=True)
class LedKeyframe:
    """Intensities to reach at a time of an animation.

    Attributes:
        time: s after the start of the animation.
        values: Device index -> intensity 0..1.
    """

    time: float
    values: Mapping[int, float]


@dataclass(eq=False)
class _Fade:
    """One device on its way through points (time in s of the simulation, intensity)."""

    points: list[tuple[float, float]]
    task: Task

    def value(self, now: float) -> float:
        before = self.points[0]
        for point in self.points[1:]:
            if now < point[0] - ROUNDING:
                share = (now - before[0]) / (point[0] - before[0])
                return before[1] + share * (point[1] - before[1])
            before = point
        return before[1]


class LedBank:
    """All LED devices of the robot.

    Attributes:
        values: (89,) intensities 0..1 in the order of the LED layout's device names.
    """

    def __init__(self, count: int, task_ids: TaskIds) -> None:
        self.values: tuple[float, ...] = (0.0,) * count
        self._ids = task_ids
        self._fades: dict[int, _Fade] = {}
        self._ends: dict[Task, float] = {}

    def set(self, values: Mapping[int, float]) -> None:
        """Set devices at once; fades on them end for these devices."""
        for index in values:
            self._fades.pop(index, None)
        self._write(values)

    def animate(self, name: str, keyframes: Sequence[LedKeyframe], now: float, step: bool = False) -> Task:
        """Run through `keyframes` from the present intensities; a newer call takes over the devices it names.

        Args:
            name: NAOqi name of the call, for the task.
            keyframes: In rising order of time.
            now: Present time of the simulation, s.
            step: Jump at each key frame instead of fading towards it.
        """
        task = self._ids.make(name, on_kill=self._stop)
        end = now + (keyframes[-1].time if keyframes else 0.0)
        for index in sorted({i for frame in keyframes for i in frame.values}):
            self._fades[index] = _Fade(self._points(index, keyframes, now, step), task)
        self._ends[task] = end
        return task

    def busy(self, indices: Iterable[int]) -> bool:
        return any(index in self._fades for index in indices)

    def tick(self, now: float) -> None:
        """Advance all fades to time `now` (s) and end the tasks whose time has come."""
        if not self._ends:
            return
        changed: dict[int, float] = {}
        for index, fade in list(self._fades.items()):
            if fade.task.finished:  # by the failure of another of its fades
                continue
            try:
                changed[index] = fade.value(now)
            except Exception as error:
                self._fail(fade.task, error)
        for task in [t for t, end in self._ends.items() if now >= end - ROUNDING]:
            del self._ends[task]
            self._release(task)
            task.finish()
        self._write(changed)

    def _fail(self, task: Task, error: Exception) -> None:
        """End an animation that has raised: whoever waits for it gets the error."""
        self._ids.guard.caught(f"task {task.name}", error)
        self._stop(task)
        task.finish(error=error)

    def kill_all(self) -> None:
        """End every animation where it is."""
        for task in list(self._ends):
            task.kill()

    def _points(
        self, index: int, keyframes: Sequence[LedKeyframe], now: float, step: bool
    ) -> list[tuple[float, float]]:
        points = [(now, self.values[index])]
        for frame in keyframes:
            if index not in frame.values:
                continue
            time, value = now + frame.time, min(max(frame.values[index], 0.0), 1.0)
            if step:
                points.append((time, points[-1][1]))
            points.append((time, value))
        return points

    def _write(self, changed: Mapping[int, float]) -> None:
        values = list(self.values)
        for index, value in changed.items():
            values[index] = min(max(value, 0.0), 1.0)
        self.values = tuple(values)

    def _stop(self, task: Task) -> None:
        self._ends.pop(task, None)
        self._release(task)

    def _release(self, task: Task) -> None:
        for index in [i for i, fade in self._fades.items() if fade.task is task]:
            del self._fades[index]


def uniform(indices: Iterable[int], value: float) -> dict[int, float]:
    """The same intensity for all `indices`."""
    return {index: value for index in indices}
