"""Moves arms and head through gestures, and always brings them back. Simulation thread only."""

from __future__ import annotations

import logging
from typing import Any, Sequence

from nao_sim_bridge.sim.motion.curves import SmoothCurve
from nao_sim_bridge.sim.speech.animations import Animation
from nao_sim_bridge.sim.speech.body_language import PlannedGesture
from nao_sim_bridge.sim.tasks import Task

log = logging.getLogger("nao_sim.speech")

# How fast joints of a gesture that is broken off go back, rad/s, and how long that takes at least, s.
RETURN_SPEED = 1.5
QUICKEST_RETURN = 0.4


class Animator:
    """Gestures of one robot.

    Where a joint was before it was first moved is its home; a gesture that begins while another one is under way, or
    on its way back, ends there, too.

    Args:
        simulation: Whose robot it is.
    """

    def __init__(self, simulation: Any) -> None:
        self._simulation = simulation
        self._running: dict[Task, Animation] = {}
        self._returns: list[Task] = []
        self._home: dict[int, float] = {}
        self._planned: list[tuple[float, PlannedGesture]] = []
        simulation.after_tick.append(self._tick)
        simulation.sound.after_reset.append(self.forget)

    # --- looking --------------------------------------------------------------------------------------------------

    @property
    def busy(self) -> bool:
        """Whether a gesture runs, comes back, or is planned."""
        return bool(self._running or self._returns or self._planned)

    def running(self, animation: Animation) -> Task | None:
        """The task of an animation that runs."""
        return next((task for task, other in self._running.items() if other is animation), None)

    # --- moving ---------------------------------------------------------------------------------------------------

    def start(self, animation: Animation, length: float | None = None) -> Task | None:
        """Begin with an animation, at once or as soon as its joints are free.

        Args:
            animation: What.
            length: How long it takes, s; as it is made when None.

        Returns:
            Its task; None when the robot cannot: its joints are limp.
        """
        robot = self._simulation.robot
        indices = self._stiff_joints(animation)
        if indices is None:
            return None
        self._break_off_others(indices)
        for index in indices:
            self._home.setdefault(index, robot.joints.commands[index])
        stretch = 1.0 if length is None else length / animation.length
        names, home = robot.joints.names, dict(self._home)

        def curves(commands: Sequence[float]) -> dict[int, SmoothCurve]:
            return {i: animation.curve(names[i], commands[i], home[i], stretch) for i in indices}

        task = robot.motion.follow("animation", indices, curves, noticed=False)
        self._running[task] = animation
        task.add_done_callback(self._ended)
        return task

    def stop(self, animation: Animation) -> None:
        """Break off an animation and bring its joints back."""
        task = self.running(animation)
        if task is not None:
            self._return(task)

    def stop_all(self) -> Task | None:
        """Break off everything; the task that brings the joints back, None when they are there."""
        self._planned.clear()
        for task in list(self._running):
            self._return(task)
        return self._returns[-1] if self._returns else None

    def plan(self, gestures: Sequence[PlannedGesture]) -> None:
        """Have gestures begin at their times, counted from now; those that were planned before are forgotten."""
        now = self._simulation.time
        self._planned = [(now + gesture.start, gesture) for gesture in gestures]

    def forget(self) -> None:
        """The robot is another one: nothing runs."""
        self._running.clear()
        self._returns.clear()
        self._home.clear()
        self._planned.clear()

    # --- inside ---------------------------------------------------------------------------------------------------

    def _tick(self, snapshot: Any) -> None:
        while self._planned and snapshot.time >= self._planned[0][0]:
            _, gesture = self._planned.pop(0)
            indices = self._stiff_joints(gesture.animation)
            # Whatever else moves the arms goes first: these gestures nobody has asked for.
            if indices is not None and not self._moved_by_others(indices):
                self.start(gesture.animation, gesture.length)

    def _stiff_joints(self, animation: Animation) -> list[int] | None:
        """Joints of an animation; None when one of them is limp. Hands may be, they stay as they are."""
        robot = self._simulation.robot
        index = {name: number for number, name in enumerate(robot.joints.names)}
        limp = [name for name in animation.joints if robot.joints.stiffnesses[index[name]] == 0.0]
        if any(not name.endswith("Hand") for name in limp):
            return None
        return [index[name] for name in animation.joints if name not in limp]

    def _moved_by_others(self, indices: Sequence[int]) -> bool:
        """Whether anybody but this animator moves one of the joints."""
        robot = self._simulation.robot
        own = {*self._running, *self._returns}
        if robot.locomotion.active:
            return True
        others = [task for task in robot.motion.tasks() if task not in own]
        return bool(others) and robot.motion.busy(indices)

    def _break_off_others(self, indices: Sequence[int]) -> None:
        """Kill gestures, and returns, that have one of these joints: else the new one would wait for them."""
        for task in [*self._running, *self._returns]:
            if set(self._joints[task]) & set(indices):
                task.kill()

    def _return(self, task: Task) -> None:
        raise NotImplementedError

    def _ended(self, task: Task) -> None:
        raise NotImplementedError
