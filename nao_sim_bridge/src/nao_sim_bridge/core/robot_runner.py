"""A simulation's thread as one robot has it: time and commands are those of all, what is sensed its own."""

from __future__ import annotations

import threading
from functools import partial
from typing import Any, Callable

from nao_sim_bridge.base.tasks import Task, stopped_error
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.core.runner import SimulationRunner
from nao_sim_bridge.core.simulation import Simulation


def _of_the_thread(name: str) -> property:
    """A property that is the same for all robots; see `SimulationRunner`."""
    return property(lambda self: getattr(self.thread, name))


class RobotRunner:
    """As `SimulationRunner`, for a robot in a world whose thread belongs to all; see there. Any thread.

    When the thread has taken another simulation, this one is left behind: commands for it run at once, one at a time,
    in the thread of whoever gives them, until it has ended.

    Attributes:
        thread: Of the world.
        simulation: The robot; touched in the thread only.
    """

    def __init__(self, runner: SimulationRunner, simulation: Simulation) -> None:
        self.thread = runner
        self.simulation = simulation
        self._lock = threading.RLock()  # held while a command runs
        self._left_behind = self._ended = False

    ticks, speed, paused, running, failed, set_speed, pause, resume = map(
        _of_the_thread, "ticks speed paused running failed set_speed pause resume".split()
    )

    @property
    def snapshot(self) -> Snapshot:
        """What the robot sensed at the last tick."""
        return self.simulation.snapshot

    def execute(self, command: Callable[[], Any], name: str = "command") -> Task:
        """Run `command()` in the simulation thread; the task ends with what it returns or raises."""
        if not self._left_behind:
            return self.thread.execute(partial(self._run, command), name)
        task = Task(name, 0)
        task.finish_with(partial(self._run, command))
        return task

    def call(self, command: Callable[[], Any], timeout: float = 5.0) -> Any:
        """Run `command()` in the simulation thread and wait for its result (wall time, s)."""
        return self.execute(command).result(timeout)

    def leave_behind(self) -> None:
        """The thread has another simulation now; simulation thread."""
        self._left_behind = True
        self.simulation.task_ids.ask = lambda task: self.execute(task.kill)
        self.simulation.shared.wake = lambda: None

    def end(self) -> None:
        """Run no more commands for a simulation that was left behind; returns when the last one is over."""
        with self._lock:
            self._ended = True

    def _run(self, command: Callable[[], Any]) -> Any:
        with self._lock:
            if self._ended:
                raise stopped_error()
            return command()

    def advance(self, seconds: float) -> Task:
        """Let `seconds` pass as fast as possible, for all robots; the task ends with what this one senses then."""
        return self.thread.advance(seconds).then(lambda _: self.snapshot)

    def wait_for_tick(self, after: int, timeout: float) -> Snapshot | None:
        """The first snapshot at which `ticks` is above `after`, None when none came within `timeout` (wall time, s)."""
        return self.snapshot if self.thread.wait_for_tick(after, timeout) is not None else None
