"""Moves arms, head and trunk through gestures, and brings back what nobody else waits for. Simulation thread only."""

from __future__ import annotations

from dataclasses import dataclass
from typing import AbstractSet, Any, Sequence

from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.control.balance.posture_recognition import STANDING, recognise
from nao_sim_bridge.control.joints.curves import SmoothCurve
from nao_sim_bridge.control.joints.engine import CurveBuilder
from nao_sim_bridge.speech.animations import folder_of
from nao_sim_bridge.speech.body_language import PlannedGesture
from nao_sim_bridge.speech.gesture import Animation, is_of_legs

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
        # Animations none of whose joints can move, and when they would end.
        self._idle: list[tuple[float, Task]] = []
        simulation.after_tick.append(self._tick)
        simulation.after_reset.append(self.forget)

    # --- looking --------------------------------------------------------------------------------------------------

    def limp_joints(self, animation: Animation) -> list[str]:
        """Joints of an animation that have no stiffness and would stay where they are, but for hands and legs."""
        stiffnesses, index = self._simulation.robot.joints.stiffnesses, self._simulation.robot.model.joint_index
        upper = (name for name in animation.joints if not (name.endswith("Hand") or is_of_legs(name)))
        return [name for name in upper if stiffnesses[index[name]] == 0.0]

    @property
    def posture(self) -> str:
        """The folder of animations that fits the posture of the robot."""
        return folder_of(self._family())

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

    def start(self, animation: Animation, length: float | None = None) -> Task:
        """Begin with an animation when its joints are free; limp ones stay as they are.

        One that is to be `length` s long goes with speech and leaves the legs alone; else the trunk leans if the robot
        stands on stiff legs that nobody moves.
        """
        indices = self._usable_joints(animation)
        if length is None:
            indices += self._leaning_joints(animation)
        if not indices:
            return self._wait(animation, length or animation.length)
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
        for _, task in list(self._idle):
            task.kill()

    # --- inside ---------------------------------------------------------------------------------------------------

    def _tick(self, snapshot: Any) -> None:
        while self._planned and snapshot.time >= self._planned[0][0]:
            _, gesture = self._planned.pop(0)
            indices = self._usable_joints(gesture.animation)
            # Whatever else moves the robot goes first: for these gestures nobody has asked.
            if indices and not self._moved_by_others(indices):
                self.start(gesture.animation, gesture.length)
        while self._idle and snapshot.time >= self._idle[0][0]:
            self._idle[0][1].finish()

    def _family(self) -> str:
        return recognise(self._simulation.model, self._simulation.snapshot).family

    def _usable_joints(self, animation: Animation) -> list[int]:
        robot = self._simulation.robot
        indices = [robot.model.joint_index[name] for name in animation.joints if not is_of_legs(name)]
        return [index for index in indices if robot.joints.stiffnesses[index] > 0.0]

    def _leaning_joints(self, animation: Animation) -> list[int]:
        robot = self._simulation.robot
        legs = [robot.model.joint_index[name] for name in animation.joints if is_of_legs(name)]
        stiff = all(robot.joints.stiffnesses[index] > 0.0 for index in legs)
        if legs and stiff and not self._moved_by_others(legs) and self._family() == STANDING:
            return legs
        return []

    def _wait(self, animation: Animation, length: float) -> Task:
        """The task of an animation that moves nothing."""
        task = self._simulation.task_ids.make("animation")
        self._moves[task] = _Move(animation, frozenset())
        self._idle.append((self._simulation.time + length, task))
        self._idle.sort(key=lambda entry: entry[0])
        task.add_done_callback(self._ended)
        task.add_done_callback(lambda _: self._idle.remove(next(e for e in self._idle if e[1] is task)))
        return task

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

    def _bring_back(self, indices: AbstractSet[int]) -> None:
        """Bring joints home, but for those that a waiting task wants: it takes them from where they are."""
        for index in indices:
            if self._simulation.robot.motion.busy([index]):
                self._home.pop(index, None)
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
