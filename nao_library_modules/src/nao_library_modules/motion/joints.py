"""Motion functions that move joints to angles: targets, key frames, trajectories, poses, hands."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from naoqi.errors import NaoError

from ..base.errors import BadGoal
from ..base.field_checks import KEY_FRAMES, require_length
from ..base.suggestion import did_you_mean
from ..functions.chain import checked_by
from ..functions.joint_trajectory import KeyFrames, read_trajectory
from ..robot.robot import wait_for_calls
from .body import DEFAULT_SPEED, BodyPart, RobotBody
from .facts import BODY, MOTION, MotionFacts, one_each
from .fields import (
    Angles,
    Changes,
    Commanded,
    Duration,
    Hands,
    HandStiffness,
    Joints,
    KeyAngles,
    Pose,
    PoseJoints,
    PosePoint,
    Relative,
    SmoothTrajectory,
    Speed,
    Speeds,
    Stiffness,
    Times,
    Trajectory,
    TrajectoryJoints,
)
from .poses import NamedPoses

if TYPE_CHECKING:
    from ..ros.nao_robot_driver import NaoRobotDriver
    from ..server.nao_basic import NaoBasic

# A hand closes or opens in about this time, s.
HAND_TIME = 0.6


def _angles_of(facts: MotionFacts, names: Sequence[str], angles: Sequence[float]) -> dict[str, float]:
    joints = facts.joints(names)
    return dict(zip(joints, one_each(angles, joints, "angles")))


def _key_angles(
    facts: MotionFacts, names: Sequence[str], angles: Sequence[float], times: Sequence[float]
) -> dict[str, list[float]]:
    """Joint -> its values at the times, from one flat list: one joint after the other."""
    joints = facts.joints(names)
    count = len(times)
    require_length("times", count * len(joints), KEY_FRAMES)
    if len(angles) == count:
        return {joint: list(angles) for joint in joints}
    if len(angles) != count * len(joints):
        raise BadGoal("angles", list(angles), *_angles_needed(len(angles), joints, count))
    return {joint: list(angles[i * count : (i + 1) * count]) for i, joint in enumerate(joints)}


def _angles_needed(given: int, joints: Sequence[str], times: int) -> tuple[str, str]:
    """What to write instead of angles whose number does not fit, and what is wrong with them."""
    here = f"here {'is' if given == 1 else 'are'} {given}"
    need = f"{times} time{'s need' if times > 1 else ' needs'} {times} angle{'s' * (times > 1)}"
    if len(joints) == 1:
        return here, f"{need} for {joints[0]}"
    return here, (
        f"{need} for all of the {len(joints)} joints, or {times * len(joints)}: {times} for {joints[0]}, "
        f"then {times} for {joints[1]}{' and so on' if len(joints) > 2 else ''}"
    )


def _key_frames(facts: MotionFacts, names: Sequence[str], trajectory: Any, relative: bool) -> KeyFrames:
    """The trajectory of a message; its joints are named in it, or in `names`."""
    if not trajectory.joint_names:
        trajectory.joint_names = list(names)
    elif names and list(names) != list(trajectory.joint_names):
        raise BadGoal("names", list(names), "nothing, or the joint_names of the trajectory")
    return read_trajectory(trajectory, facts.chains, relative)


class JointMotion(BodyPart):
    left_by_goals = frozenset({"poses"})

    def __init__(self, module: NaoBasic, body: RobotBody, poses: NamedPoses, driver: NaoRobotDriver | None) -> None:
        super().__init__(body)
        self._module = module
        self.poses = poses
        self._driver = driver  # its pose_manager knows more poses

    def _check_joints(self, names: Sequence[str]) -> None:
        self.body.plan.ask(self.body.joints(names))

    @checked_by(_check_joints)
    def get_angles(self, names: Joints, commanded: Commanded) -> list[float]:
        """Angles of joints and chains now, measured or as told; the result has them in `name` and `position`."""
        joints = self.body.joints(names)
        angles = list(self.motion("getAngles", joints, not commanded))
        self.body.plan.answers.update(zip(joints, angles))
        return angles

    def _check_angles(
        self, names: Sequence[str], angles: Sequence[float], speeds: Sequence[float], stiffness: float, relative: bool
    ) -> None:
        plan = self.body.plan
        wanted = _angles_of(plan.facts, names, angles)
        if speeds:
            one_each(speeds, list(wanted), "speeds")
        plan.require_stiff(list(wanted), stiffness)
        # Nobody waits for targets: they take no time.
        plan.move(plan.targets(wanted, relative), 0.0)
        plan.aim(wanted)

    @checked_by(_check_angles)
    def set_angles(
        self, names: Joints, angles: Angles, speed: Speed, speeds: Speeds, stiffness: Stiffness, relative: Relative
    ) -> None:
        """Give joints targets and go on at once; newer targets replace older ones."""
        wanted = _angles_of(self.body.facts, names, angles)
        given = one_each(speeds, list(wanted), "speeds") if speeds else [speed]
        fractions = [self.body.careful(wanted, fraction or DEFAULT_SPEED) for fraction in given]
        self.body.stiffen(list(wanted), stiffness)
        if relative:
            now = self.motion("getAngles", list(wanted), False)
            wanted = {joint: angle + before for (joint, angle), before in zip(wanted.items(), now)}
        self.motion("setAngles", list(wanted), list(wanted.values()), fractions if speeds else fractions[0])

    def _check_changes(self, names: Sequence[str], angles: Sequence[float], stiffness: float) -> None:
        self._check_angles(names, angles, (), stiffness, True)

    @checked_by(_check_changes)
    def change_angles(self, names: Joints, angles: Changes, speed: Speed, stiffness: Stiffness) -> None:
        """Change the targets of joints and go on at once."""
        wanted = _angles_of(self.body.facts, names, angles)
        self.body.stiffen(list(wanted), stiffness)
        self.motion(
            "changeAngles", list(wanted), list(wanted.values()), self.body.careful(wanted, speed or DEFAULT_SPEED)
        )

    def _check_interpolation(
        self, names: Sequence[str], angles: Sequence[float], times: Sequence[float], relative: bool, stiffness: float
    ) -> None:
        plan = self.body.plan
        values = _key_angles(plan.facts, names, angles, times)
        plan.require_stiff(list(values), stiffness)
        plan.follow(values, times, relative)

    @checked_by(_check_interpolation)
    def angle_interpolation(
        self, names: Joints, angles: KeyAngles, times: Times, relative: Relative, stiffness: Stiffness
    ) -> None:
        """Move joints through key angles at given times, and wait for the end."""
        values = _key_angles(self.body.facts, names, angles, times)
        self.body.stiffen(list(values), stiffness)
        start = self.motion("getAngles", list(values), False) if relative else [0.0] * len(values)
        moments = [list(times)] * len(values)
        self.motion("angleInterpolation", list(values), list(values.values()), moments, not relative)
        self.body.require_reached({joint: s + path[-1] for (joint, path), s in zip(values.items(), start)})

    def _check_with_speed(self, names: Sequence[str], angles: Sequence[float], speed: float, stiffness: float) -> None:
        self._check_go(_angles_of(self.body.facts, names, angles), speed, stiffness)

    @checked_by(_check_with_speed)
    def angle_interpolation_with_speed(self, names: Joints, angles: Angles, speed: Speed, stiffness: Stiffness) -> None:
        """Move joints to angles at a fraction of their top speed, and wait for the end."""
        self._go(_angles_of(self.body.facts, names, angles), speed, stiffness)

    def _check_trajectory(self, names: Sequence[str], trajectory: Any, relative: bool, stiffness: float) -> None:
        plan = self.body.plan
        frames = _key_frames(plan.facts, names, trajectory, relative)
        plan.require_stiff(frames.joints, stiffness)
        if frames.needs_start:
            start = [plan.angles[joint] for joint in frames.joints]
            known = [angle for angle in start if angle is not None]
            if len(known) == len(start):
                frames = frames.absolute(known)
            elif frames.relative:
                allowed = "false, where the trajectory has velocities and an earlier function moves"
                raise BadGoal("relative", relative, allowed)
        plan.follow(dict(zip(frames.joints, frames.values)), frames.times, frames.relative, "trajectory.points")

    @checked_by(_check_trajectory)
    def set_trajectory(
        self, names: TrajectoryJoints, trajectory: Trajectory, relative: Relative, stiffness: Stiffness
    ) -> None:
        """Move joints along a trajectory: through its positions, with its velocities where it has some."""
        frames = _key_frames(self.body.facts, names, trajectory, relative)
        self.body.stiffen(frames.joints, stiffness)
        if frames.relative or frames.needs_start:
            frames = frames.absolute(self.motion("getAngles", list(frames.joints), False))
        if frames.velocities is None:
            self.motion("angleInterpolation", *frames.interpolation_arguments())
        else:
            self.motion("angleInterpolationBezier", *frames.bezier_arguments())
        self.body.require_reached(frames.targets)

    def _check_bezier(self, names: Sequence[str], trajectory: Any, stiffness: float) -> None:
        self._check_trajectory(names, trajectory, False, stiffness)

    @checked_by(_check_bezier)
    def angle_interpolation_bezier(
        self, names: TrajectoryJoints, trajectory: SmoothTrajectory, stiffness: Stiffness
    ) -> None:
        """Move joints along the smooth curves of a trajectory with velocities."""
        self.set_trajectory(names, trajectory, False, stiffness)

    def _check_pose(
        self,
        names: Sequence[str],
        angles: Sequence[float],
        str_param: str,
        trajectory: Any,
        speed: float,
        duration: float,
        stiffness: float,
    ) -> None:
        plan = self.body.plan
        if self.is_of_driver(str_param):
            for field, value in (("names", names), ("angles", angles), ("speed", speed), ("duration", duration)):
                if value:
                    raise BadGoal(field, value, f"nothing: the driver's pose {str_param.strip()!r} has its own")
            if trajectory.points:
                raise BadGoal("trajectory.points", len(trajectory.points), "none beside the name of a pose")
            joints = list(plan.facts.chains[BODY])
            plan.require_stiff(joints, stiffness)
            plan.leave_to_robot(joints)
            return
        pose, time = self.pose(names, angles, str_param, trajectory, duration)
        if time > 0.0:
            plan.require_stiff(list(pose), stiffness)
            plan.follow({joint: [angle] for joint, angle in pose.items()}, [time], False)
        else:
            self._check_go(pose, speed, stiffness)

    def _check_go(self, pose: Mapping[str, float], speed: float, stiffness: float) -> None:
        plan = self.body.plan
        plan.require_stiff(list(pose), stiffness)
        plan.move_with_speed(plan.targets(pose, False), dict.fromkeys(pose, speed or DEFAULT_SPEED))

    @checked_by(_check_pose)
    def set_pose(
        self,
        names: PoseJoints,
        angles: Angles,
        str_param: Pose,
        trajectory: PosePoint,
        speed: Speed,
        duration: Duration,
        stiffness: Stiffness,
    ) -> None:
        """Take a pose of one or several chains at a speed or in a time: angles, a point, or a pose by name.

        Names that only the driver's pose_manager knows are left to it.
        """
        if self.is_of_driver(str_param):
            self.body.stiffen(list(self.body.facts.chains[BODY]), stiffness)
            call = self._driver.take_pose(str_param.strip())
            if call is None:
                raise NaoError("the driver's pose_manager has gone")
            wait_for_calls([call], self._module.interrupt)
            return
        pose, time = self.pose(names, angles, str_param, trajectory, duration)
        if time > 0.0:
            self.body.stiffen(list(pose), stiffness)
            self.motion("angleInterpolation", list(pose), [[a] for a in pose.values()], [[time]] * len(pose), True)
            self.body.require_reached(pose)
        else:
            self._go(pose, speed, stiffness)

    def _check_hands(self, names: Sequence[str], stiffness: HandStiffness) -> None:
        hands = self.body.joints(names)
        known = [joint for joint in self.body.facts.limits if joint.endswith("Hand")]
        for hand in hands:
            if hand not in known:
                problem = f"{hand!r} is no hand{did_you_mean(hand, known)}"
                raise BadGoal("names", hand, ", ".join(known), problem=problem)
        self.body.plan.leave_to_robot(hands, HAND_TIME)

    @checked_by(_check_hands)
    def open_hand(self, names: Hands) -> None:
        """Open hands, and wait until they are; they are limp then."""
        self._hands("openHand", names)

    @checked_by(_check_hands)
    def close_hand(self, names: Hands) -> None:
        """Close hands, and wait until they are; they are limp then."""
        self._hands("closeHand", names)

    def is_of_driver(self, str_param: str) -> bool:
        """Whether only the driver knows a pose of that name."""
        name, driver = str_param.strip(), self._driver
        return bool(name) and driver is not None and name in driver.poses() and name not in self.poses.names()

    def pose(
        self, names: Sequence[str], angles: Sequence[float], str_param: str, trajectory: Any, duration: float
    ) -> tuple[Mapping[str, float], float]:
        """The pose that a message means, and the time to take it in, s; 0 where a speed is meant.

        Raises BadGoal if the message gives none, or more than one.
        """
        given = [bool(angles), bool(trajectory.points), bool(str_param.strip())]
        if sum(given) != 1:
            problem = "there is no pose" if not any(given) else "there is more than one pose"
            allowed = "either angles, or one point in trajectory, or a pose's name in str_param"
            raise BadGoal("angles", list(angles), allowed, problem=problem)
        if angles:
            return _angles_of(self.body.facts, names, angles), duration
        if trajectory.points:
            joints = list(trajectory.joint_names) or list(names)
            point = trajectory.points[0]
            return _angles_of(self.body.facts, joints, point.positions), duration or point.time_from_start.to_sec()
        pose = self.poses.find(str_param, self.body.facts.limits)
        if names:
            wanted = self.body.joints(names)
            pose = {joint: angle for joint, angle in pose.items() if joint in wanted}
        return pose, duration

    def _go(self, pose: Mapping[str, float], speed: float, stiffness: float) -> None:
        self.body.stiffen(list(pose), stiffness)
        fraction = self.body.careful(pose, speed or DEFAULT_SPEED)
        self.motion("angleInterpolationWithSpeed", list(pose), list(pose.values()), fraction)
        self.body.require_reached(pose)

    def _hands(self, method: str, names: Sequence[str]) -> None:
        motion = self._module.robot.proxy(MOTION)
        self._module.call_all(motion, method, [(hand,) for hand in self.body.joints(names)])

    functions = {
        "getAngles": get_angles,
        "setAngles": set_angles,
        "changeAngles": change_angles,
        "angleInterpolation": angle_interpolation,
        "angleInterpolationWithSpeed": angle_interpolation_with_speed,
        "angleInterpolationBezier": angle_interpolation_bezier,
        "setTrajectory": set_trajectory,
        "setPose": set_pose,
        "openHand": open_hand,
        "closeHand": close_hand,
    }
