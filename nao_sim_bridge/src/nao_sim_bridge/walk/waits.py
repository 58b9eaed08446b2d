"""What callers wait for when the robot walks: that what the walk is for is reached, or that it has ended."""

from __future__ import annotations

from typing import Callable

from nao_sim_bridge.base.tasks import Task, TaskIds


class WalkWaits:
    """Tasks of callers that a walk settles. Simulation thread only.

    Attributes:
        goal: What the walk that goes on is for, None when it is for nothing that has an end; `dropped` hears that
            somebody has cancelled it.
    """

    def __init__(self, task_ids: TaskIds, dropped: Callable[[], None]) -> None:
        self.goal: Task | None = None
        self._ids = task_ids
        self._dropped = dropped
        self._for_the_end: list[Task] = []

    def make_goal(self, name: str) -> Task:
        """A task that can become the goal of a walk; cancelled as the goal, it is told."""
        return self._ids.make(name, on_kill=self._drop)

    def end_goal(self, reached: bool, error: Exception | None = None) -> None:
        """Tell who waits for the goal, if there is one, whether it is reached; there is none any more."""
        goal, self.goal = self.goal, None
        if goal is not None:
            goal.finish(reached, error)

    def for_the_end(self, name: str, walks: bool) -> Task:
        """A task that ends with the walk, or at once when none goes on."""
        task = self._ids.make(name)
        if walks:
            self._for_the_end.append(task)
        else:
            task.finish()
        return task

    def end_all(self, reached: bool, error: Exception | None = None) -> None:
        """The walk has ended, maybe by an error: tell everybody who waits, and whether the goal is reached."""
        self.end_goal(reached, error)
        ended, self._for_the_end = self._for_the_end, []
        for task in ended:
            task.finish()

    def _drop(self, task: Task) -> None:
        if task is self.goal:
            self.goal = None
            self._dropped()
