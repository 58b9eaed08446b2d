"""Commands straight to actuators, past ALMotion and ALLeds: joints, stiffnesses and LEDs of one robot.

Simulation thread only.
"""

from __future__ import annotations

from typing import Callable, Mapping, Sequence

from nao_sim_bridge.base.errors import MoveRefused, UnknownName
from nao_sim_bridge.base.sizes import require_few
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.base.timed_commands import Point, Polyline, merged, polyline
from nao_sim_bridge.body.leds import LedKeyframe
from nao_sim_bridge.core.robot import SimulatedRobot

NAME = "DCM"
POSITION, HARDNESS = "/Position/Actuator/Value", "/Hardness/Actuator/Value"
LEGS = ("LLeg", "RLeg")


class DeviceCommands:
    """Timed commands for the actuators of a robot, which are taken from whoever else moves them.

    Args:
        robot: Which robot there is now; a new one has no commands.
        milliseconds: The time of now, ms.
    """

    def __init__(self, robot: Callable[[], SimulatedRobot], milliseconds: Callable[[], int]) -> None:
        self._robot_now = robot
        self._milliseconds = milliseconds
        self._robot: SimulatedRobot | None = None
        self._points: dict[str, Sequence[Point]] = {}
        self._tasks: dict[str, Task] = {}

    def set(self, commands: Mapping[str, Sequence[Point]], update: str) -> None:
        """Give actuators new commands, values at moments in ms; for `update` see `merged`.

        Raises:
            BadValue: There is no such update, or an actuator would have too many commands.
            MoveRefused: The robot walks with one of the joints.
        """
        robot = self._robot_now()
        if robot is not self._robot:
            self._robot, self._points, self._tasks = robot, {}, {}
        self._require_free(robot, commands)
        now = self._milliseconds()
        for device, new in commands.items():
            old = [point for point in self._points.get(device, ()) if point[1] > now]
            points = merged(old, new, update)
            require_few(device, len(points), "commands")
            self._points[device] = points
            self._follow(robot, device, now)

    def _follow(self, robot: SimulatedRobot, device: str, now: int) -> None:
        """Let an actuator go the way of its commands from where it is."""
        former = self._tasks.pop(device, None)
        if former is not None:
            former.kill()
        index = index_of(robot, device)
        way = polyline(self._points[device], now, self._value(robot, device, index))
        if way is None:
            return
        if device.endswith(POSITION):
            robot.motion.kill_using([index])
            self._tasks[device] = robot.motion.follow(NAME, [index], lambda _: {index: way})
        elif device.endswith(HARDNESS):
            self._tasks[device] = robot.motion.stiffen(NAME, [index], lambda _: {index: way})
        else:
            self._tasks[device] = robot.leds.animate(NAME, _keyframes(index, way), robot.time)

    @staticmethod
    def _value(robot: SimulatedRobot, device: str, index: int) -> float:
        if device.endswith(POSITION):
            return robot.joints.commands[index]
        if device.endswith(HARDNESS):
            return robot.joints.stiffnesses[index]
        return robot.leds.values[index]

    @staticmethod
    def _require_free(robot: SimulatedRobot, devices: Mapping[str, object]) -> None:
        if not robot.walking:
            return
        walking = {joint for leg in LEGS for joint in robot.model.chains[leg]}
        for device in devices:
            joint = device[: -len(POSITION)]
            if device.endswith(POSITION) and joint in walking:
                raise MoveRefused(f"the robot walks, and {joint} with it: stop it first")


def index_of(robot: SimulatedRobot, device: str) -> int:
    """Index of an actuator among the joints or LEDs.

    Raises:
        UnknownName: There is no such actuator.
    """
    for suffix in (POSITION, HARDNESS):
        joint = device[: -len(suffix)]
        if device.endswith(suffix) and joint in robot.model.joint_index:
            return robot.model.joint_index[joint]
    if device in robot.led_layout.devices:
        return robot.led_layout.devices.index(device)
    raise UnknownName("actuator", device, actuators(robot))


def actuators(robot: SimulatedRobot) -> list[str]:
    joints = [joint + suffix for joint in robot.model.joint_index for suffix in (POSITION, HARDNESS)]
    return [*joints, *robot.led_layout.devices]


def _keyframes(index: int, way: Polyline) -> list[LedKeyframe]:
    return [LedKeyframe(time, {index: value}) for time, value in zip(way.times[1:], way.values[1:])]
