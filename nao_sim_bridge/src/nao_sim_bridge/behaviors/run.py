"""One behaviour while it is played: what it has begun, and how that ends. Simulation thread only."""

from __future__ import annotations

import logging
from typing import Callable, Iterable, Mapping

from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.behaviors.steps import Behavior
from nao_sim_bridge.body.leds import LedBank

log = logging.getLogger("nao_sim.behaviors")

# Intensities that are equal.
SAME = 1e-6


class BehaviorRun:
    """What a behaviour that is played has begun; its task ends with it."""

    def __init__(self, behavior: Behavior, task: Task, leds: LedBank, whole: BehaviorRun | None = None) -> None:
        self.behavior = behavior
        self.task = task
        self._whole = whole
        self._leds = leds
        self._ends: dict[Task, Callable[[], object]] = {}
        self._stopped = False
        self._told_limp = False
        # Intensities of LEDs before the behaviour changed them first, and those that it has asked for last.
        self._before: dict[int, float] = {}
        self._asked: dict[int, float] = {}
        self._fades: dict[Task, Iterable[int]] = {}

    @property
    def over(self) -> bool:
        return self._stopped or self.task.finished

    def branch(self, failed: Callable[[], object] | None = None) -> BehaviorRun:
        """A part of what is played, which can be stopped alone. Its error ends the whole, unless `failed` takes it."""
        task = Task("branch", 0)
        part = BehaviorRun(self.behavior, task, self._leds, self)
        self._ends[task] = part.finish

        def settle(done: Task) -> None:
            self._ends.pop(done, None)
            if done.killed and not self.over:
                part.stop()
                self.task.kill()
            elif done.error is not None and not self.over:
                if failed is None:
                    self.fail(done.error)
                else:
                    log.info("%s", done.error)
                    failed()

        task.add_done_callback(settle)
        return part

    def tell_limp(self, joints: Iterable[str]) -> None:
        """Tell in the log, once a run, of joints that stay where they are because they have no stiffness."""
        if self._whole is not None:
            self._whole.tell_limp(joints)
            return
        names = list(joints)
        if names and not self._told_limp:
            self._told_limp = True
            log.warning(
                "behavior %s: %s have no stiffness and stay where they are; wakeUp or a stiffness comes first",
                self.behavior.name,
                ", ".join(names[:3]) + ("..." if len(names) > 3 else ""),
            )

    def watch(self, task: Task, end: Callable[[], object] | None = None, needed: bool = True) -> Task:
        """Have a task that the behaviour has begun end with it, by killing it when `end` is None; the task.

        When somebody else kills a task that is needed, the behaviour ends.
        """
        self._ends[task] = end or task.kill

        def settle(done: Task) -> None:
            self._ends.pop(done, None)
            if done.error is not None:
                self.fail(done.error)
            elif done.killed and needed and not self.over:
                self.task.kill()

        task.add_done_callback(settle)
        return task

    def watch_command(self, command: Task, settled: Callable[..., None]) -> Task:
        """As `watch`, for a command whose result may be a further task, and so on; a task that ends when all have.

        `settled` is called at its end with the error or None, and with the result if there is one.
        """
        over = Task(command.name, 0)
        now = [command]

        def end() -> None:
            if now[0] is not command:
                now[0].kill()
            else:  # a command that has not run yet cannot be stopped, but what it starts can
                command.add_done_callback(lambda done: done.value.kill() if isinstance(done.value, Task) else None)

        def settle(done: Task) -> None:
            if isinstance(done.value, Task):
                now[0] = done.value
                done.value.add_done_callback(settle)
                return
            self._ends.pop(over, None)
            if not self.over:
                if done.killed:
                    self.task.kill()
                elif done.value is None:
                    settled(done.error)
                else:
                    settled(done.error, done.value)
            over.finish()

        self._ends[over] = end
        command.add_done_callback(settle)
        return over

    def remember_lights(self, values: Mapping[int, float]) -> None:
        """The behaviour is about to change LEDs, by index."""
        for index, value in values.items():
            self._before.setdefault(index, self._leds.values[index])
            self._asked[index] = value

    def watch_lights(self, fade: Task, indices: Iterable[int]) -> Task:
        """As `watch`, for a task that fades LEDs; newer ones may take them over."""
        self._fades[fade] = tuple(indices)
        fade.add_done_callback(lambda done: None if done.killed else self._fades.pop(done, None))
        return self.watch(fade, needed=False)

    def finish(self) -> None:
        """All steps are done."""
        self.stop()
        self.task.finish()

    def fail(self, error: Exception) -> None:
        """A step cannot be done: the others end, too."""
        if not self.over:
            self.stop()
            self.task.finish(error=error)

    def stop(self) -> None:
        """End all; LEDs show again what they showed before, but for those that somebody else has changed since."""
        self._stopped = True
        for end in list(self._ends.values()):
            end()
        half_way = {index for indices in self._fades.values() for index in indices}
        now = self._leds.values
        own = (i for i, asked in self._asked.items() if i in half_way or abs(now[i] - asked) < SAME)
        restored = {index: self._before[index] for index in own}
        if restored:
            self._leds.set(restored)
