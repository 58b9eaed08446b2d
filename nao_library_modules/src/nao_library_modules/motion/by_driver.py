"""A robot whose motion goes through a driver: methods of ALMotion as actions and services of nao_robot. No ROS.

What has no words in nao_robot's interface (effectors, gaits, everything that only asks), none that tell what became of
it (targets that are set and not waited for), or none that can be taken back (wakeUp, rest), goes to NAOqi, as all does
without a driver; and so does the order to stop a walk, which must not depend on a node. The functions of the module do
not know which way their calls take. A call of the driver is what `proxy.call_async` gives: it can be waited for and
cancelled; None where nobody takes it.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

from ..base.places import Place
from ..functions.joint_trajectory import KeyFrames

if TYPE_CHECKING:
    from ..ros.nao_robot_driver import NaoRobotDriver

MOTION, POSTURE = "ALMotion", "ALRobotPosture"
WALKS = ("moveTo", "moveToward")
"""The node of the driver that walks owns the robot's walk as well, and goes on when who asked for it dies."""
SOON = 0.05
"""s in which stiffnesses are set that NAOqi would set at once: a trajectory takes time."""
SAME = 1e-6
"""s and rad that a tangent may be off what velocities say."""


class RobotByDriver:
    """Stands for a Robot whose driver may come and go. What it does not have, it has from the robot itself."""

    def __init__(self, robot: Any, driver: NaoRobotDriver) -> None:
        self._robot = robot
        self._proxies = {
            MOTION: ProxyByDriver(robot, MOTION, driver, _MotionWays(driver).all),
            POSTURE: ProxyByDriver(robot, POSTURE, driver, {"goToPosture": driver.take_posture}),
        }

    def proxy(self, name: str) -> Any:
        """Proxy of a NAOqi module, the same object every time."""
        return self._proxies.get(name) or self._robot.proxy(name)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._robot, name)


class ProxyByDriver:
    """Stands for the proxy of a module.

    `ways`: name of a method -> the call of the driver for its arguments, None if nao_robot has no words for them.
    """

    def __init__(self, robot: Any, module: str, driver: NaoRobotDriver, ways: dict[str, Callable[..., Any]]) -> None:
        self._proxy = robot.proxy(module)
        self._answering_time = robot.connection.answering_time
        self._witness = partial(robot.owners.sending, module)
        self._driver = driver
        self._ways = ways

    def call_async(self, method: str, *args: Any) -> Any:
        way = self._ways.get(method)
        call = way(*args) if way is not None and self._driver.there() else None
        if call is None:
            return self._proxy.call_async(method, *args)
        call.clock = self._answering_time
        # It would go on without this process all the same.
        ended = self._witness(method, args, self._driver.walk_cure() if method in WALKS else None)
        if ended is not None:
            call.add_done_callback(ended)
        return call

    def __getattr__(self, name: str) -> Any:
        return getattr(self._proxy, name)


class _MotionWays:
    """Methods of ALMotion; arguments are NAOqi's, in the forms that the functions of the module send."""

    def __init__(self, driver: NaoRobotDriver) -> None:
        self._driver = driver
        self.all = {
            "angleInterpolation": self._interpolation,
            "angleInterpolationBezier": self._bezier,
            "angleInterpolationWithSpeed": self._with_speed,
            "setStiffnesses": self._stiffnesses,
            "stiffnessInterpolation": self._stiffness_interpolation,
            "moveTo": self._move_to,
            "moveToward": self._move_toward,
            "stopMove": driver.leave_walk,  # and then NAOqi's own
        }

    def _interpolation(self, names: Any, values: Any, times: Any, absolute: bool) -> Any:
        frames = _frames(names, values, times, relative=not absolute)
        return frames and self._driver.follow(frames)

    def _bezier(self, names: Any, times: Any, points: Any) -> Any:
        frames = _hermite(names, times, points)
        return frames and self._driver.follow(frames)

    def _with_speed(self, names: Any, angles: Any, speed: Any) -> Any:
        return self._driver.go(names, angles, speed) if _one_each(names, angles) else None

    def _stiffnesses(self, names: Any, values: Any) -> Any:
        if not _one_each(names, values):
            return None
        return self._driver.stiffen(KeyFrames(tuple(names), (SOON,), tuple((float(value),) for value in values)))

    def _stiffness_interpolation(self, names: Any, values: Any, times: Any) -> Any:
        frames = _frames(names, values, times)
        return frames and self._driver.stiffen(frames)

    def _move_to(self, *args: Any) -> Any:
        return self._driver.walk_by(Place(*args)) if len(args) == 3 and not isinstance(args[0], list) else None

    def _move_toward(self, *args: Any) -> Any:
        return self._driver.walk_at(*args) if len(args) == 3 else None


def _one_each(names: Any, values: Any) -> bool:
    return isinstance(names, list) and isinstance(values, list) and len(names) == len(values)


def _frames(names: Any, values: Any, times: Any, relative: bool = False) -> KeyFrames | None:
    """Key frames, if all joints have the same times, as in a message of a trajectory."""
    if not _one_each(names, values) or not _one_each(names, times) or any(each != times[0] for each in times):
        return None
    return KeyFrames(tuple(names), tuple(times[0]), tuple(map(tuple, values)), None, relative)


def _hermite(names: Any, times: Any, points: Any) -> KeyFrames | None:
    """Key frames with velocities, if all tangents reach a third of the time, as velocities say nothing else."""
    values = [[point[0] for point in row] for row in points]
    frames = _frames(names, values, times)
    if frames is None:
        return None
    lengths = [time - before for before, time in zip((0.0, *frames.times), frames.times)]
    velocities = []
    for row in points:
        row_velocities = []
        for (_, (_, reach, rise), (_, ahead, ahead_rise)), before, after in zip(row, lengths, (*lengths[1:], 0.0)):
            velocity = rise / reach if reach else 0.0
            off = reach + before / 3.0, ahead - after / 3.0, ahead_rise - velocity * ahead
            if max(map(abs, off)) > SAME:
                return None
            row_velocities.append(velocity)
        velocities.append(tuple(row_velocities))
    return KeyFrames(frames.joints, frames.times, frames.values, tuple(velocities), False)
