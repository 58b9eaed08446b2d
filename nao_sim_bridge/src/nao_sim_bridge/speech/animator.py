"""Moves arms and head through gestures, and always brings them back. Simulation thread only."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Iterable, Sequence

from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.control.joints.curves import SmoothCurve
from nao_sim_bridge.control.joints.engine import CurveBuilder
from nao_sim_bridge.speech.animations import Animation
from nao_sim_bridge.speech.body_language import PlannedGesture

# How fast joints of a gesture that is broken off go back, rad/s, and how long that takes at least, s.
RETURN_SPEED = 1.5
QUICKEST_RETURN = 0.4


@dataclass(frozen=True, eq=False)
class _Move:
    """What a task of the animator does: an animation, or the way back from one (None), with these joints."""

    animation: Animation | None
    indices: frozenset[int]


class Animator:
    """Gestures of one robot.

    Where a joint was before it was first moved is its home; a gesture that begins while another one is under way, or
    on its way back, ends there, too.
    """

    def __init__(self, simulation: Any) -> None:
        self._simulation = simulation
        self._moves: dict[Task, _Move] = {}
        self._home: dict[int, float] = {}
        self._planned: list[tuple[float, PlannedGesture]] = []
        simulation.after_tick.append(self._tick)
        simulation.after_reset.append(self.forget)

    # --- looking --------------------------------------------------------------------------------------------------

    def can(self, animation: Animation) -> bool:
        """Whether the joints of an animation are stiff; hands need not be, limp ones stay as they are."""
        return self._usable_joints(animation) is not None

    @property
    def busy(self) -> bool:
        return any(move.animation is not None for move in self._moves.values())

    @property
    def plans(self) -> bool:
        """Whether gestures are still to begin."""
        return bool(self._planned)

    def running(self, animation: Animation) -> Task | None:
        return next((task for task, move in self._moves.items() if move.animation is animation), None)

    # --- moving ---------------------------------------------------------------------------------------------------

    def start(self, animation: Animation, length: float | None = None) -> Task | None:
        """Begin with an animation, `length` s long if given, when its joints are free; None when the robot cannot."""
        indices = self._usable_joints(animation)
        if indices is None:
            return None
        joints = self._simulation.robot.joints
        homes = {index: self._home.get(index, joints.commands[index]) for index in indices}
        self._clear_way(indices)
        self._home.update(homes)
        stretch = 1.0 if length is None else length / animation.length

        def curves(commands: Sequence[float]) -> dict[int, SmoothCurve]:
            return {i: animation.curve(joints.names[i], commands[i], homes[i], stretch) for i in indices}

        return self._move(animation, indices, curves)

    def stop(self, animation: Animation) -> None:
        """Break off an animation and bring its joints back."""
        task = self.running(animation)
        if task is not None:
            indices = self._moves[task].indices
            self._kill(task)
            self._bring_back(indices)

    def stop_all(self) -> list[Task]:
        """Break off everything; the tasks that bring the joints back."""
        self._planned.clear()
        for move in list(self._moves.values()):
            if move.animation is not None:
                self.stop(move.animation)
        return list(self._moves)

    def plan(self, gestures: Sequence[PlannedGesture]) -> None:
        """Have gestures begin at their times, counted from now; those that were planned before are forgotten."""
        now = self._simulation.time
        self._planned = [(now + gesture.start, gesture) for gesture in gestures]

    def drop_plans(self) -> None:
        """Forget what is planned; what runs goes on."""
        self._planned.clear()

    def forget(self) -> None:
        """The robot is another one: nothing runs."""
        self._moves.clear()
        self._home.clear()
        self._planned.clear()

    # --- inside ---------------------------------------------------------------------------------------------------

    def _tick(self, snapshot: Any) -> None:
        while self._planned and snapshot.time >= self._planned[0][0]:
            _, gesture = self._planned.pop(0)
            indices = self._usable_joints(gesture.animation)
            # Whatever else moves the robot goes first: for these gestures nobody has asked.
            if indices is not None and not self._moved_by_others(indices):
                self.start(gesture.animation, gesture.length)

    def _usable_joints(self, animation: Animation) -> list[int] | None:
        robot = self._simulation.robot
        index = robot.model.joint_index
        limp = [name for name in animation.joints if robot.joints.stiffnesses[index[name]] == 0.0]
        if any(not name.endswith("Hand") for name in limp):
            return None
        return [index[name] for name in animation.joints if name not in limp]

    def _moved_by_others(self, indices: Sequence[int]) -> bool:
        robot = self._simulation.robot
        own = {index for move in self._moves.values() for index in move.indices}
        return robot.walking or robot.motion.busy(set(indices) - own)

    def _move(self, animation: Animation | None, indices: Sequence[int], curves: CurveBuilder) -> Task:
        task = self._simulation.robot.motion.follow("animation", indices, curves, noticed=False)
        self._moves[task] = _Move(animation, frozenset(indices))
        task.add_done_callback(self._ended)
        return task

    def _clear_way(self, indices: Sequence[int]) -> None:
        """End moves that have one of these joints, which would keep the new one waiting; the others come back."""
        for task, move in list(self._moves.items()):
            if move.indices & set(indices):
                self._kill(task)
                self._bring_back(move.indices - set(indices))

    def _bring_back(self, indices: Iterable[int]) -> None:
        homes = {index: self._home[index] for index in indices if index in self._home}
        if not homes:
            return

        def curves(commands: Sequence[float]) -> dict[int, SmoothCurve]:
            way = max(abs(commands[index] - home) for index, home in homes.items())
            duration = max(way / RETURN_SPEED, QUICKEST_RETURN)
            return {index: SmoothCurve((0.0, duration), (commands[index], home)) for index, home in homes.items()}

        self._move(None, list(homes), curves)

    def _kill(self, task: Task) -> None:
        """End a move without leaving home for what follows."""
        del self._moves[task]
        task.kill()

    def _ended(self, task: Task) -> None:
        """A move has come to its end, or somebody else has killed it: its joints are at home wherever they are."""
        move = self._moves.pop(task, None)
        if move is not None:
            for index in move.indices:
                self._home.pop(index, None)
