"""Motion functions for joints: angles, trajectories, poses, hands, postures, stiffness, waking up and resting."""

from __future__ import annotations

from collections.abc import Container, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from naoqi.errors import NaoError

from ..core.chain import checked_by
from ..core.errors import BadGoal, did_you_mean
from ..core.fields import KEY_FRAMES, require_known, require_length
from ..core.files import config_file
from ..core.joint_trajectory import KeyFrames, read_trajectory
from ..core.poses import read_poses
from ..core.robot import wait_for_calls
from ..core.waiting import OncePerConnection
from .motion_fields import (
    POSTURE_SPEED,
    Angles,
    Changes,
    Commanded,
    Duration,
    Hands,
    HandStiffness,
    Joints,
    KeyAngles,
    KeyStiffnesses,
    Pose,
    PoseJoints,
    PosePoint,
    Posture,
    PostureSpeed,
    Relative,
    SmoothTrajectory,
    Speed,
    Speeds,
    Stiffness,
    Stiffnesses,
    Times,
    Trajectory,
    TrajectoryJoints,
    Tries,
)
from .motion_plan import BODY, DEFAULT_SPEED, MOTION, POSTURE_TIME, POSTURES, BodyPart, MotionFacts, RobotBody, one_each

if TYPE_CHECKING:
    from ..nao_basic import NaoBasic
    from ..ros.nao_robot_driver import NaoRobotDriver


SUFFIX = ".xap"
OURS = "poses.xap"
SEPARATOR = ":"


class NamedPoses:
    """Finds poses by name.

    A pose is named as in its file (`Wave`), or, when several files know the name, with the file (`mine.xap:Wave`).
    `folder`: where the user's pose libraries (.xap) are.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def find(self, name: str, joints: Container[str]) -> dict[str, float]:
        """Joint -> angle in rad of a pose, as far as the robot has the joints.

        Raises BadGoal if there is no such pose or file, or the file is broken.
        """
        file, separator, pose = name.strip().rpartition(SEPARATOR)
        poses = self._of_file(file) if separator else self._all()
        if pose not in poses:
            problem = f"there is no pose {pose!r}{did_you_mean(pose, poses)}"
            raise BadGoal("str_param", name, f"one of {', '.join(poses)}", problem=problem)
        return {joint: angle for joint, angle in poses[pose].items() if joint in joints}

    def names(self) -> list[str]:
        return list(self._all())

    def _files(self) -> dict[str, Path]:
        files = {OURS: config_file(OURS)}
        if self._folder.is_dir():
            files.update({path.name: path for path in sorted(self._folder.glob(f"*{SUFFIX}"))})
        return files

    def _of_file(self, file: str) -> dict[str, dict[str, float]]:
        files = self._files()
        if file not in files:
            allowed = f"one of {', '.join(files)}{did_you_mean(file, files)}"
            raise BadGoal("str_param", file, allowed, problem=f"no pose library {file!r} in {self._folder}")
        return self._read(files[file])

    def _all(self) -> dict[str, dict[str, float]]:
        poses: dict[str, dict[str, float]] = {}
        for path in self._files().values():
            poses.update(self._read(path))
        return poses

    @staticmethod
    def _read(path: Path) -> dict[str, dict[str, float]]:
        try:
            return read_poses(path)
        except NaoError as error:
            raise BadGoal("str_param", path.name, "a pose library of Choregraphe", problem=str(error)) from error


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


class PostureFunctions(BodyPart):
    def __init__(self, body: RobotBody, robot: Any) -> None:
        super().__init__(body)
        self._known = OncePerConnection(robot, lambda: list(body.call(POSTURES, "getPostureList")))

    def _check_posture(self, str_param: str, speed: float) -> None:
        name = require_known("str_param", str_param, self._known(), "posture")
        self.body.plan.require_fit_legs()
        self.body.plan.change_posture(POSTURE_TIME / (speed or POSTURE_SPEED), name)

    def _check_applied(self, str_param: str, speed: float, stiffness: float) -> None:
        self.body.plan.require_stiff(list(self.body.facts.chains[BODY]), stiffness)
        self._check_posture(str_param, speed)

    @checked_by(_check_posture)
    def go_to_posture(self, str_param: Posture, speed: PostureSpeed) -> None:
        """Go to a posture from wherever the robot is, getting up if need be; awake afterwards."""
        self._reach("goToPosture", str_param.strip(), speed)

    @checked_by(_check_applied)
    def apply_posture(self, str_param: Posture, speed: PostureSpeed, stiffness: Stiffness) -> None:
        """Take the angles of a posture straight away; the robot may fall."""
        self.body.stiffen(list(self.body.facts.chains[BODY]), stiffness)
        self._reach("applyPosture", str_param.strip(), speed)

    def get_posture(self) -> str:
        """Name of the posture that the robot is in, or Unknown."""
        return str(self._postures("getPosture"))

    def get_posture_family(self) -> str:
        """Family of the posture that the robot is in: Standing, Sitting, LyingBelly, ..."""
        return str(self._postures("getPostureFamily"))

    def get_posture_list(self) -> list[str]:
        """Postures that goToPosture knows."""
        return self._known()

    def get_posture_family_list(self) -> list[str]:
        """Families that getPostureFamily tells apart."""
        return list(self._postures("getPostureFamilyList"))

    def set_max_try_number(self, values: Tries) -> None:
        """How often goToPosture tries before it gives up."""
        self._postures("setMaxTryNumber", int(values[0]))

    def _reach(self, method: str, posture: str, speed: float) -> None:
        if not self._postures(method, posture, speed or POSTURE_SPEED):
            now, family = self.get_posture(), self.get_posture_family()
            raise NaoError(f"the robot did not reach {posture}: it is in posture {now} of the family {family}")

    def _postures(self, method: str, *args: Any) -> Any:
        return self.body.call(POSTURES, method, *args)

    functions = {
        "goToPosture": go_to_posture,
        "applyPosture": apply_posture,
        "getPosture": get_posture,
        "getPostureFamily": get_posture_family,
        "getPostureList": get_posture_list,
        "getPostureFamilyList": get_posture_family_list,
        "setMaxTryNumber": set_max_try_number,
    }


class StiffnessFunctions(BodyPart):
    def _check_wake_up(self) -> None:
        self.body.plan.require_fit_legs()
        self.body.plan.change_posture(POSTURE_TIME)

    @checked_by(_check_wake_up)
    def wake_up(self) -> None:
        """Switch the motors on; a robot on its feet stands up."""
        self.motion("wakeUp")

    def _check_rest(self) -> None:
        plan = self.body.plan
        plan.change_posture(POSTURE_TIME)
        plan.stiffnesses.update(dict.fromkeys(plan.facts.chains[BODY], 0.0))

    @checked_by(_check_rest)
    def rest(self) -> None:
        """Go to a safe posture and switch the motors off."""
        self.motion("rest")

    def robot_is_wake_up(self) -> bool:
        """Whether the robot is awake."""
        return bool(self.motion("robotIsWakeUp"))

    def _check_stiffnesses(self, names: Sequence[str], angles: Sequence[float]) -> None:
        joints = self.body.joints(names)
        self.body.plan.stiffnesses.update(zip(joints, one_each(angles, joints, "angles")))

    @checked_by(_check_stiffnesses)
    def set_stiffnesses(self, names: Joints, angles: Stiffnesses) -> None:
        """Make joints and chains stiff (1) or limp (0) at once."""
        joints = self.body.joints(names)
        self.motion("setStiffnesses", joints, one_each(angles, joints, "angles"))

    def _check_names(self, names: Sequence[str]) -> None:
        self.body.joints(names)

    @checked_by(_check_names)
    def get_stiffnesses(self, names: Joints) -> list[float]:
        """Stiffnesses of joints and chains, 0..1."""
        return list(self.motion("getStiffnesses", self.body.joints(names)))

    def _check_interpolation(self, names: Sequence[str], angles: Sequence[float], times: Sequence[float]) -> None:
        if len(angles) != len(times):
            raise BadGoal("angles", list(angles), f"{len(times)}, one a time, the same for all joints")
        joints = self.body.joints(names)
        require_length("times", len(times) * len(joints), KEY_FRAMES)
        self.body.plan.stiffnesses.update(dict.fromkeys(joints, angles[-1]))
        self.body.plan.takes(times[-1])

    @checked_by(_check_interpolation)
    def stiffness_interpolation(self, names: Joints, angles: KeyStiffnesses, times: Times) -> None:
        """Change stiffness along key values at given times, and wait for the end."""
        joints = self.body.joints(names)
        count = len(joints)
        self.motion("stiffnessInterpolation", joints, [list(angles)] * count, [list(times)] * count)

    functions = {
        "wakeUp": wake_up,
        "rest": rest,
        "robotIsWakeUp": robot_is_wake_up,
        "setStiffnesses": set_stiffnesses,
        "getStiffnesses": get_stiffnesses,
        "stiffnessInterpolation": stiffness_interpolation,
    }
