"""Moving and stiffening joints for nao_controller: ALMotion called the way nao_robot did. No ROS."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from naoqi.errors import NaoError
from naoqi.limits import MOVE_LIMIT

from ...core.errors import BadGoal, Preempted
from ...core.fields import limit, number_parameter, require_within
from ...core.joint_trajectory import KeyFrames, check_range, expand_names, one_each, read_trajectory
from ...core.nao_facts import MOTION, JointNames
from ...core.robot import ask, run_task
from ...core.waiting import CancellationToken

log = logging.getLogger(__name__)

MotionReport = Callable[[Sequence[str], Sequence[float], Sequence[float]], None]
FRACTION = limit("fraction")
LIFE = "ALAutonomousLife"
INIT_STIFFNESS = "~init_stiffness"
STIFFEN_TIME = 0.5
"""s in which the whole body gets stiff or limp."""
REPORT_PERIOD = 0.1
"""s of wall time between two reports of a motion under way."""
ALIVE, LIFELESS = "solitary", "disabled"


@dataclass(frozen=True)
class Reached:
    """Measured angles in rad (stiffnesses: 0..1), one for each joint."""

    values: list[float]
    preempted: bool  # interrupted before its end


class JointController:
    """Joint motion of one robot. Every method may be called from any thread.

    They raise NaoError if an argument is wrong, or the robot refuses or is lost. Names are those of joints and chains;
    values are one for each joint, or one for all: angles in rad, stiffnesses 0..1. Speeds are fractions of the top
    speed, above 0 to 1. `set_angles` and `set_stiffnesses` return when the robot has taken the command.
    """

    def __init__(self, robot: Any) -> None:
        self._robot = robot
        self.names = JointNames(robot)

    # --- at once --------------------------------------------------------------------------------------------------

    def set_angles(self, names: Sequence[str], angles: Sequence[float], speed: float, relative: bool) -> None:
        """Start moving joints; a newer call replaces an older one. Relative angles add to the commanded ones."""
        joints, values, speed = self._angles(names, angles, speed)
        self._quick("changeAngles" if relative else "setAngles", list(joints), list(values), speed)

    def set_stiffnesses(self, names: Sequence[str], stiffnesses: Sequence[float]) -> None:
        chains = self.names.chains
        joints = expand_names(names, chains, "name")
        values = one_each(stiffnesses, names, chains, "effort")
        for joint, value in zip(joints, values):
            if not 0.0 <= value <= 1.0:
                raise BadGoal("effort", value, "0 to 1", problem=f"the stiffness of {joint} is to be {value:g}")
        self._quick("setStiffnesses", list(joints), list(values))

    # --- goals ----------------------------------------------------------------------------------------------------

    def trajectory(self, trajectory: Any, relative: bool) -> KeyFrames:
        return read_trajectory(trajectory, self.names.chains, relative)

    def stiffness_trajectory(self, trajectory: Any) -> KeyFrames:
        """Check a trajectory of stiffnesses; velocities in it are ignored."""
        frames = read_trajectory(trajectory, self.names.chains)
        check_range(frames, 0.0, 1.0)
        return frames

    def joints_of(self, names: Sequence[str]) -> tuple[str, ...]:
        return expand_names(names, self.names.chains)

    def follow(self, frames: KeyFrames, interrupt: CancellationToken, report: MotionReport | None = None) -> Reached:
        """Move joints along key frames, to the end or to the interrupt.

        Ten times a second meanwhile `report` gets the joints, their commanded and their measured angles, rad.
        """
        motion = self._robot.proxy(MOTION)
        joints = list(frames.joints)
        if frames.velocities is None:
            call = motion.call_async("angleInterpolation", *frames.interpolation_arguments())
        else:
            # From the commands, as the robot counts relative angles, and not from what a loaded joint sags to.
            start = self._quick("getAngles", joints, False) if frames.needs_start else ()
            call = motion.call_async("angleInterpolationBezier", *frames.absolute(start).bezier_arguments())
        if report is not None:
            self._report_until_finished(call, joints, interrupt, report)
        return self._motion_ended(call, joints, interrupt)

    def _report_until_finished(
        self, call: Any, joints: list[str], interrupt: CancellationToken, report: MotionReport
    ) -> None:
        finished = threading.Event()
        call.add_done_callback(lambda _: finished.set())
        try:
            with interrupt.waking(finished.set):
                while not finished.wait(REPORT_PERIOD):
                    report(joints, *(self._quick("getAngles", joints, measured) for measured in (False, True)))
        except Exception as error:  # the motion is seen to its end, reported or not
            log.warning("%s: the motion is no longer reported: %s", ", ".join(joints), error)

    def move(
        self, names: Sequence[str], angles: Sequence[float], speed: float, relative: bool, interrupt: CancellationToken
    ) -> Reached:
        """Move joints to angles, to the end or to the interrupt. Relative angles add to the measured ones."""
        joints, values, speed = self._angles(names, angles, speed)
        if relative:
            values = tuple(now + step for now, step in zip(self._quick("getAngles", list(joints), True), values))
        motion = self._robot.proxy(MOTION)
        call = motion.call_async("angleInterpolationWithSpeed", list(joints), list(values), speed)
        return self._motion_ended(call, list(joints), interrupt)

    def stiffen(self, frames: KeyFrames, interrupt: CancellationToken) -> Reached:
        joints = list(frames.joints)
        call = self._robot.proxy(MOTION).call_async("stiffnessInterpolation", *frames.interpolation_arguments()[:3])

        def stop() -> None:
            self._quick("setStiffnesses", joints, self._quick("getStiffnesses", joints))

        preempted = self._ended(call, interrupt, stop)
        return Reached(self._quick("getStiffnesses", joints), preempted)

    # --- services -------------------------------------------------------------------------------------------------

    def set_body_stiffness(self, stiffness: float) -> None:
        """Bring the whole body to a stiffness (0..1), in half a second."""
        self._service(MOTION, "stiffnessInterpolation", "Body", float(stiffness), STIFFEN_TIME)

    def wake_up(self) -> None:
        """Switch the motors on and stand up, if the robot can."""
        self._service(MOTION, "wakeUp")

    def rest(self) -> None:
        """Go to a safe posture and switch the motors off."""
        self._service(MOTION, "rest")

    def set_life(self, alive: bool) -> None:
        self._service(LIFE, "setState", ALIVE if alive else LIFELESS)

    def life_state(self) -> str:
        return str(self._service(LIFE, "getState"))

    # --- parts ----------------------------------------------------------------------------------------------------

    def _angles(
        self, names: Sequence[str], angles: Sequence[float], speed: float
    ) -> tuple[tuple[str, ...], tuple[float, ...], float]:
        chains = self.names.chains
        joints = expand_names(names, chains)
        values = one_each(angles, names, chains, "joint_angles")
        return joints, values, require_within("speed", speed, FRACTION)

    def _motion_ended(self, call: Any, joints: list[str], interrupt: CancellationToken) -> Reached:
        preempted = self._ended(call, interrupt, lambda: self._quick("killTasksUsingResources", joints))
        return Reached(self._quick("getAngles", joints, True), preempted)

    @staticmethod
    def _ended(call: Any, interrupt: CancellationToken, stop: Callable[[], Any]) -> bool:
        try:
            run_task(call, interrupt, stop)
        except Preempted:
            return True
        return False

    def _quick(self, method: str, *arguments: Any) -> Any:
        return ask(self._robot, MOTION, method, *arguments)

    def _service(self, module: str, method: str, *arguments: Any) -> Any:
        return ask(self._robot, module, method, *arguments, limit=MOVE_LIMIT)


class InitialStiffness:
    """The parameter `~init_stiffness`: stiffness that the body gets when the robot is first reached, if above 0.

    Raises NaoError if it is no share.
    """

    def __init__(self, joints: JointController, get_param: Callable[[str, Any], Any]) -> None:
        self._joints = joints
        self._stiffness = number_parameter(INIT_STIFFNESS, get_param(INIT_STIFFNESS, 0.0), limit("share"))

    def apply(self) -> None:
        """Set it, once: a robot that restarts stays limp. The log has it if the robot refuses."""
        if self._stiffness > 0.0:
            stiffness, self._stiffness = self._stiffness, 0.0
            try:
                self._joints.set_body_stiffness(stiffness)
            except NaoError as error:
                log.error("%s: %s", INIT_STIFFNESS, error)
