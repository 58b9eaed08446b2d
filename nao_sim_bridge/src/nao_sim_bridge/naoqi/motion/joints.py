"""Parts of ALMotion about joints: names and limits, angles, stiffnesses, key frames, and the tasks that move them."""

from __future__ import annotations

from typing import Any, Sequence

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.control.joints.bezier import BezierCurve
from nao_sim_bridge.control.joints.curves import Ramp, SmoothCurve
from nao_sim_bridge.model.robot_model import joint_names
from nao_sim_bridge.naoqi.binding.arguments import known, number, per_item
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.motion.arguments import bezier_curve, bezier_key_points, key_frames
from nao_sim_bridge.naoqi.motion.part import MotionPart

OPEN, CLOSED = 1.0, 0.0
# Hands open and close at this fraction of their top speed.
HAND_SPEED = 0.3


class Body(MotionPart):
    """Names, limits, configuration, summary."""

    def getBodyNames(self, name: str) -> list[str]:
        if name == "Chains":
            return list(self._model.chain_names)
        if name in self._model.chains:
            return list(self._model.chains[name])
        return joint_names(name, self._model)

    getJointNames = getBodyNames

    def getLimits(self, name: str) -> list[list[float]]:
        joints = [self._model.joint(n) for n in joint_names(name, self._model)]
        return [[j.lower, j.upper, j.max_velocity, j.max_torque] for j in joints]

    def getMotionCycleTime(self) -> int:
        return round(1000.0 * self._runner.simulation.settings.tick_s)

    def getRobotConfig(self) -> list:
        version = {"V6": "VERSION_60", "V5": "VERSION_50"}[self._runner.simulation.scene.version]
        values = {
            "Model Type": "naoH25",
            "Head Version": version,
            "Body Version": version,
            "Laser": False,
            "Extended Arms": True,
            "Number of Legs": 2,
            "Number of Arms": 2,
            "Number of Hands": 2,
        }
        return [list(values), list(values.values())]

    def getSummary(self) -> str:
        """One line a joint: name, stiffness, command and sensor angle (rad)."""
        now, head = self._runner.snapshot, "---------------------- Model ---------------------------"
        lines = [head, "       JointName   Stiffness     Command      Sensor"]
        for joint, *values in zip(self._model.joints, now.stiffnesses, now.commands, now.positions):
            lines.append("{:>16}    {:8.6f}   {:9.6f}   {:9.6f}".format(joint.name, *values))
        return "\n".join([*lines, "-" * len(head), ""])


class Joints(MotionPart):
    """Angles and stiffnesses of joints, read, set at once, and led along curves."""

    def getAngles(self, names: Any, use_sensors: bool) -> list[float]:
        indices = [self._model.joint_index[n] for n in joint_names(names, self._model)]
        angles = self._runner.snapshot.positions if use_sensors else self._robot.joints.commands
        return [angles[i] for i in indices]

    def setAngles(self, names: Any, angles: Any, fraction: Any) -> Task:
        targets, speeds = self._targets(names, angles, "angles", fraction)
        return self._runner.execute(lambda: self._robot.motion.set_targets(targets, speeds), "setAngles")

    def changeAngles(self, names: Any, changes: Any, fraction: float) -> Task:
        steps, speeds = self._targets(names, changes, "changes", fraction)

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
        targets, speeds = self._targets(names, angles, "targetAngles", fraction)
        call = "angleInterpolationWithSpeed"

        def ramps(commands: Sequence[float]) -> dict[int, Ramp]:
            self._robot.motion.notices.check_targets(call, targets)
            clamp = self._robot.joints.clamp_alone  # what is beyond a limit takes no time
            return {i: Ramp(commands[i], clamp(i, target), speeds[i]) for i, target in targets.items()}

        return self._follow(call, list(targets), ramps)

    def openHand(self, name: str) -> Task:
        """The motor of the hand is stiff while it moves, and off afterwards: its gears hold what it has."""
        return self._move_hand("openHand", name, OPEN)

    def closeHand(self, name: str) -> Task:
        return self._move_hand("closeHand", name, CLOSED)

    def _targets(self, names: Any, angles: Any, field: str, fraction: Any) -> tuple[dict[int, float], dict[int, float]]:
        """Angles (rad) and speeds (rad/s) by joint."""
        indices = self._indices(names)
        targets = dict(zip(indices, per_item(angles, len(indices), field)))
        fractions = per_item(fraction, len(indices), "fractionMaxSpeed", 0.0, 1.0)
        if 0.0 in fractions:
            raise NaoqiError("fractionMaxSpeed is 0, allowed is above 0 to 1")
        return targets, {i: share * self._model.joints[i].max_velocity for i, share in zip(indices, fractions)}

    def _move_hand(self, call: str, name: str, value: float) -> Task:
        index = self._model.joint_index[known(name, "hand", ("LHand", "RHand"))]
        speed = HAND_SPEED * self._model.joints[index].max_velocity

        def start() -> Task:
            self._hold_limp([index])
            motion = self._robot.motion
            motion.set_stiffness_now({index: 1.0})
            task = motion.follow(call, [index], lambda commands: {index: Ramp(commands[index], value, speed)})
            task.add_done_callback(lambda _: motion.set_stiffness_now({index: 0.0}))
            return task

        return self._runner.execute(start, call)

    def angleInterpolationBezier(self, names: Any, times: Any, points: Any) -> Task:
        return self._play("angleInterpolationBezier", names, times, points, True)

    def animation(self, names: Any, times: Any, points: Any, is_absolute: bool, supports: Any) -> Task:
        if supports:
            raise BadValue("supportSequence", supports, "an empty list: both feet stay on the ground")
        return self._play("animation", names, times, points, is_absolute)

    def _play(self, call: str, names: Any, times: Any, points: Any, is_absolute: bool) -> Task:
        indices = self._indices(names)
        key_points = bezier_key_points(len(indices), times, points)

        def curves(commands: Sequence[float]) -> dict[int, BezierCurve]:
            return {i: bezier_curve(commands[i], points, is_absolute) for i, points in zip(indices, key_points)}

        return self._follow(call, indices, curves)

    def getStiffnesses(self, names: Any) -> list[float]:
        stiffnesses = self._robot.joints.stiffnesses
        return [stiffnesses[self._model.joint_index[n]] for n in joint_names(names, self._model)]

    def setStiffnesses(self, names: Any, stiffnesses: Any) -> Task:
        indices = self._indices(names)
        values = dict(zip(indices, per_item(stiffnesses, len(indices), "stiffnesses", 0.0, 1.0)))

        def stiffen() -> None:
            self._hold_limp(indices)
            self._robot.motion.set_stiffness_now(values)

        return self._runner.execute(stiffen, "setStiffnesses")

    def stiffnessInterpolation(self, names: Any, stiffnesses: Any, times: Any) -> Task:
        indices = self._indices(names)
        frames = key_frames(len(indices), stiffnesses, times, "stiffnessLists")
        for _, values in frames:
            for value in values:
                number(value, "stiffnessLists", 0.0, 1.0)

        def curves(now: Sequence[float]) -> dict[int, SmoothCurve]:
            return {i: SmoothCurve((0.0, *at), (now[i], *values)) for i, (at, values) in zip(indices, frames)}

        def start() -> Task:
            self._hold_limp(indices)
            return self._robot.motion.stiffen("stiffnessInterpolation", indices, curves)

        return self._runner.execute(start, "stiffnessInterpolation")


class TaskList(MotionPart):
    """Tasks, resources, kill."""

    def getTaskList(self) -> Task:
        return self._runner.execute(
            lambda: [[task.name, task.task_id] for task in self._robot.motion.tasks()], "getTaskList"
        )

    def areResourcesAvailable(self, names: list[str]) -> Task:
        indices = self._indices(names)
        return self._runner.execute(lambda: not self._robot.motion.busy(indices), "areResourcesAvailable")

    def killTask(self, task_id: int) -> Task:
        def kill() -> bool:
            for task in self._robot.motion.tasks():
                if task.task_id == task_id:
                    return task.kill()
            return False

        return self._runner.execute(kill, "killTask")

    def killTasksUsingResources(self, names: list[str]) -> Task:
        indices = self._indices(names)
        return self._runner.execute(lambda: self._robot.motion.kill_using(indices), "kill")

    def killAll(self) -> Task:
        return self._runner.execute(lambda: self._robot.motion.kill_all(), "killAll")
