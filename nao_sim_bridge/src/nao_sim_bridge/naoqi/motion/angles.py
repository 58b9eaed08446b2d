"""Part of ALMotion: joint angles, read, set and moved along curves."""

from __future__ import annotations

from typing import Any, Sequence

from nao_sim_bridge.base.errors import UnknownName
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.control.joints.curves import Ramp, SmoothCurve
from nao_sim_bridge.model.robot_model import joint_names
from nao_sim_bridge.naoqi.binding.arguments import per_item
from nao_sim_bridge.naoqi.motion.arguments import key_frames
from nao_sim_bridge.naoqi.motion.part import MotionPart

OPEN, CLOSED = 1.0, 0.0
# Hands open and close at this fraction of their top speed.
HAND_SPEED = 0.3


class Angles(MotionPart):
    """Targets (setAngles), interpolations, hands."""

    def getAngles(self, names: Any, use_sensors: bool) -> list[float]:
        indices = [self._model.joint_index[n] for n in joint_names(names, self._model)]
        angles = self._runner.snapshot.positions if use_sensors else self._robot.joints.commands
        return [angles[i] for i in indices]

    def setAngles(self, names: Any, angles: Any, fraction: Any) -> Task:
        indices = self._indices(names)
        targets = dict(zip(indices, per_item(angles, len(indices), "angles")))
        speeds = self._speeds(indices, fraction)
        return self._runner.execute(lambda: self._robot.motion.set_targets(targets, speeds), "setAngles")

    def changeAngles(self, names: Any, changes: Any, fraction: float) -> Task:
        indices = self._indices(names)
        steps = dict(zip(indices, per_item(changes, len(indices), "changes")))
        speeds = self._speeds(indices, fraction)

        def change() -> None:
            motion = self._robot.motion
            motion.set_targets({i: motion.target_of(i) + step for i, step in steps.items()}, speeds)

        return self._runner.execute(change, "changeAngles")

    def angleInterpolation(self, names: Any, angles: Any, times: Any, is_absolute: bool) -> Task:
        indices = self._indices(names)
        frames = key_frames(len(indices), angles, times, "angleLists")

        def curves(commands: Sequence[float]) -> dict[int, SmoothCurve]:
            return {
                i: SmoothCurve((0.0, *at), (commands[i], *(v if is_absolute else commands[i] + v for v in values)))
                for i, (at, values) in zip(indices, frames)
            }

        return self._follow("angleInterpolation", indices, curves)

    def angleInterpolationWithSpeed(self, names: Any, angles: Any, fraction: float) -> Task:
        indices = self._indices(names)
        targets = dict(zip(indices, per_item(angles, len(indices), "targetAngles")))
        speeds = self._speeds(indices, fraction)
        call = "angleInterpolationWithSpeed"

        def ramps(commands: Sequence[float]) -> dict[int, Ramp]:
            self._robot.motion.notices.check_targets(call, targets)
            clamp = self._robot.joints.clamp_alone  # what is beyond a limit takes no time
            return {i: Ramp(commands[i], clamp(i, target), speeds[i]) for i, target in targets.items()}

        return self._follow(call, indices, ramps)

    def openHand(self, name: str) -> Task:
        """The motor of the hand is stiff while it moves, and off afterwards: its gears hold what it has."""
        return self._move_hand("openHand", name, OPEN)

    def closeHand(self, name: str) -> Task:
        return self._move_hand("closeHand", name, CLOSED)

    def _move_hand(self, call: str, name: str, value: float) -> Task:
        if name not in ("LHand", "RHand"):
            raise UnknownName("hand", name, ["LHand", "RHand"])
        index = self._model.joint_index[name]
        speed = HAND_SPEED * self._model.joints[index].max_velocity

        def start() -> Task:
            self._hold_limp([index])
            motion = self._robot.motion
            motion.set_stiffness_now({index: 1.0})
            task = motion.follow(call, [index], lambda commands: {index: Ramp(commands[index], value, speed)})
            task.add_done_callback(lambda _: motion.set_stiffness_now({index: 0.0}))
            return task

        return self._runner.execute(start, call)
