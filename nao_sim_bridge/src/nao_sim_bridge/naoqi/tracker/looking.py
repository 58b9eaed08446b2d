"""Part of ALTracker: looking and pointing once, and where the robot is by landmarks whose places are known."""

from __future__ import annotations

import math
from typing import Any, Mapping, Sequence

import numpy as np

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.control.joints.curves import Ramp
from nao_sim_bridge.core.robot_runner import RobotRunner
from nao_sim_bridge.model.frames import TORSO
from nao_sim_bridge.naoqi.binding.arguments import numbers, one_of, speed_share, vector
from nao_sim_bridge.naoqi.motion.arguments import space_of
from nao_sim_bridge.naoqi.tracker.tracking import Tracking
from nao_sim_bridge.tracking import geometry
from nao_sim_bridge.tracking.follower import EFFECTORS

FARTHEST = 1000.0


class Looking:
    """Looks and points at places, and knows places of landmarks. Only NAOqi methods are public."""

    def __init__(self, tracking: Tracking, runner: RobotRunner) -> None:
        self._tracking = tracking
        self._simulation = runner.simulation
        self._runner = runner
        self._marks: dict[int, list[float]] = {}

    def lookAt(self, position: Any, *rest: Any) -> Task:
        """(position, frame, fraction of the top speed, whole body) or without the frame, which is that of the torso.

        Ends when the robot looks there, as far as it can.
        """
        frame, fraction, whole_body = _frame_first(rest, 3)
        point, share = _point(position), speed_share(fraction, "pFractionMaxSpeed")

        def look() -> Task:
            in_torso = self._in_torso(point, frame)
            if whole_body:
                return self._tracking.follower.look_once(in_torso)
            return self._move("lookAt", dict(zip(geometry.HEAD, self._head(in_torso))), share)

        return self._runner.execute(look, "lookAt")

    def pointAt(self, effector: str, position: Any, *rest: Any) -> Task:
        """(arm, position, frame, fraction of the top speed) or without the frame; "Arms" is the nearer one."""
        frame, fraction = _frame_first(rest, 2)
        one_of(effector, "pEffector", [name for name in EFFECTORS if name != "None"])
        point, share = _point(position), speed_share(fraction, "pFractionMaxSpeed")

        def aim() -> Task:
            in_torso = self._in_torso(point, frame)
            arm = effector if effector != "Arms" else ("LArm" if in_torso[1] >= 0.0 else "RArm")
            return self._move("pointAt", geometry.arm_angles(self._simulation.model, arm, in_torso), share)

        return self._runner.execute(aim, "pointAt")

    # --- where the robot is ---------------------------------------------------------------------------------------

    def setTargetCoordinates(self, coordinates: Any) -> None:
        """[[mark, [x, y, z, ...]], ...] in a world of the client's choice, m."""
        if not isinstance(coordinates, (list, tuple)):
            raise BadValue("pCoord", coordinates, "[[mark, [x, y, z]], ...]")
        marks = {}
        for entry in coordinates:
            if not isinstance(entry, (list, tuple)) or len(entry) != 2 or not isinstance(entry[0], int):
                raise BadValue("pCoord", entry, "[mark, [x, y, z]]")
            place = numbers(entry[1], "pCoord", -FARTHEST, FARTHEST)
            if len(place) not in (3, 6):
                raise BadValue("pCoord", entry, "[mark, [x, y, z]], or with wx, wy, wz")
            marks[entry[0]] = place
        self._marks = marks

    def getTargetCoordinates(self) -> list:
        return [[mark, place] for mark, place in self._marks.items()]

    def getRobotPosition(self) -> list[float]:
        """[x, y, wz] in the world of these coordinates, m and rad; empty unless two known marks or more are seen."""
        seen = [s for s in self._tracking.sightings if s.number in self._marks]
        return robot_position([s.place for s in seen], [self._marks[s.number] for s in seen])

    def _in_torso(self, point: Sequence[float], frame: int) -> geometry.Point:
        model = self._simulation.model
        return geometry.in_torso(model, geometry.placement(model, self._simulation.snapshot), point, frame)

    def _head(self, in_torso: geometry.Point) -> tuple[float, float]:
        yaw, pitch = geometry.head_angles(self._simulation.model, in_torso)
        pitching = self._simulation.model.joint_index[geometry.HEAD[1]]
        low, high = self._simulation.robot.joints.limits_beside(pitching, yaw)
        return yaw, min(max(pitch, low), high)

    def _move(self, name: str, angles: Mapping[str, float], share: float) -> Task:
        robot = self._simulation.robot
        targets = {robot.model.joint_index[joint]: angle for joint, angle in angles.items()}
        speeds = {i: share * robot.model.joints[i].max_velocity for i in targets}
        return robot.motion.follow(
            name, targets, lambda now: {i: Ramp(now[i], angle, speeds[i]) for i, angle in targets.items()}
        )


def robot_position(seen: Sequence[Sequence[float]], known: Sequence[Sequence[float]]) -> list[float]:
    """The pose (x, y in m, heading in rad) that brings places seen from the robot onto their places in a world.

    Both are x, y, ... of each in m, in the frame of the robot and in the world. Empty for less than two.
    """
    if len(seen) < 2:
        return []
    here, there = (np.array([place[:2] for place in places]) for places in (seen, known))
    a, b = here - here.mean(axis=0), there - there.mean(axis=0)
    yaw = math.atan2(float(np.sum(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])), float(np.sum(a * b)))
    turn = np.array(((math.cos(yaw), -math.sin(yaw)), (math.sin(yaw), math.cos(yaw))))
    x, y = there.mean(axis=0) - turn @ here.mean(axis=0)
    return [float(x), float(y), yaw]


def _frame_first(rest: tuple[Any, ...], most: int) -> tuple[Any, ...]:
    """The arguments after the position with the frame that is meant when there is none."""
    return (space_of(rest[0]), *rest[1:]) if len(rest) == most else (TORSO, *rest)


def _point(position: Any) -> list[float]:
    return vector(position, "pPosition", 3, "[x, y, z] in m", -FARTHEST, FARTHEST)
