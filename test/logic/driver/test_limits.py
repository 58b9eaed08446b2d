"""Numbers that nobody means, in messages and parameters of the driver: each is refused with its name, nothing sent."""

from __future__ import annotations

import math
from unittest.mock import MagicMock

import pytest
from boundary import variants
from genpy import Duration
from geometry_msgs.msg import Pose2D, PoseStamped, Quaternion, Transform, Twist, Vector3
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from nao_library_modules.core.errors import BadGoal
from nao_library_modules.core.fields import limit, number_parameter
from nao_library_modules.core.geometry import Place
from nao_library_modules.core.joint_trajectory import read_trajectory
from nao_library_modules.driver.base import reconfigure
from nao_library_modules.driver.joints.planar_frames import read_place, read_transform
from nao_library_modules.driver.life.nao_leds import Blinks
from nao_library_modules.driver.memory.memory_rules import MemoryRule
from nao_library_modules.driver.path_follower.path_courses import FollowerSettings, TargetCourse
from nao_library_modules.driver.teleop.teleop_nao_joy import JoyControl, JoySettings
from nao_library_modules.driver.walk.nao_footsteps import read_steps
from nao_library_modules.driver.walk.walk_commands import read_gait_config, read_step, read_target, read_velocity
from nao_library_msgs.msg import StepTarget
from naoqi.errors import NaoError

CHAINS = {"Body": ("HeadYaw", "HeadPitch"), "Head": ("HeadYaw", "HeadPitch")}


def target():
    pose = PoseStamped()
    pose.header.frame_id, pose.pose.orientation.w = "odom", 1.0
    return pose


def trajectory():
    points = [
        JointTrajectoryPoint([0.1], [0.0], [0.0], [], Duration(1)),
        JointTrajectoryPoint([0.2], [0.0], [0.0], [], Duration(2)),
    ]
    return JointTrajectory(joint_names=["Head"], points=points)


READERS = {
    "cmd_vel": (read_velocity, Twist(), "linear.x linear.y angular.z", math.isnan),
    "cmd_pose": (read_target, Pose2D(), "x y theta", None),
    "cmd_step": (read_step, StepTarget(leg=1), "pose.x pose.y pose.theta", None),
    "footstep": (lambda m: read_steps([m]), StepTarget(leg=1), "pose.x pose.y pose.theta", None),
    "move_base": (lambda m: read_place("goal", m), target(), "pose.position.x pose.position.y", None),
    "odometry": (read_transform, Transform(Vector3(), Quaternion(w=1.0)), "translation.x translation.y", None),
    "trajectory": (
        lambda m: read_trajectory(m, CHAINS),
        trajectory(),
        " ".join(f"points.{i}.{what}.0" for i in (0, 1) for what in ("positions", "velocities", "accelerations"))
        + " points.1.time_from_start",
        None,
    ),
}


@pytest.mark.parametrize("name", READERS)
def test_a_message_with_a_number_that_nobody_means_is_refused_with_its_field(name):
    read, message, places, mad = READERS[name]
    read(message)
    tried = set()
    for place, value, hostile in variants(message):
        if place in places.split() and (mad or (lambda v: math.isnan(v) or abs(v) >= 1e9))(value):
            tried.add(place)
            with pytest.raises(BadGoal) as refused:
                read(hostile)
            assert place.split(".")[-1] in str(refused.value) or place.split(".")[-2] in str(refused.value)
    assert tried == set(places.split())


def test_clamped_velocities_are_finite_whatever_comes():
    for place, value, hostile in variants(Twist()):
        if not math.isnan(value):
            velocity, _ = read_velocity(hostile)
            assert max(map(abs, (velocity.x, velocity.y, velocity.theta))) <= 1.0, (place, value)


def test_blinks_and_rules_of_memory_have_bounds():
    for numbers in ((1e6, 1.0, 0.1), (1e-320, 1.0, 0.1), (0.3, 1e9, 0.1), (0.3, 1.0, 1e9), (0.3, math.nan, 0.1)):
        with pytest.raises(BadGoal, match=r"0\.001\.\.86400 s"):
            Blinks([(1.0, 0.0, 0.0)], (0.0, 0.0, 0.0), *numbers).check()
    for rate in (1e-320, math.nan, 1e6):
        with pytest.raises(BadGoal, match="rate"):
            MemoryRule("Device/*", rate).check()


def test_a_target_out_of_all_reach_ends_the_goal_that_follows_it():
    course = TargetCourse(lambda: Place(1e6, 0.0, 0.0))
    with pytest.raises(BadGoal, match="target_pose: .*1e\\+06 m away.* up to 100 m"):
        course.aim(Place(0.0, 0.0, 0.0))


def test_an_axis_of_a_gamepad_that_is_no_number_moves_nothing():
    joy = JoyControl(JoySettings())
    joy.update([0.0] * 6, [0] * 12)
    joy.update([0.0] * 6, [int(button == 8) for button in range(12)])
    joy.update([math.nan] * 6, [0] * 12)
    assert joy.velocity.is_zero


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, 1.7e308, -5.0, True, "1", None])
def test_a_parameter_of_a_node_is_a_number_within_its_bounds(value):
    with pytest.raises(NaoError, match=r"~rate is .*: 0\.001 to 125 Hz"):
        number_parameter("~rate", value, limit("reading rate"))
    with pytest.raises(NaoError, match="stuck_time"):
        FollowerSettings(stuck_time=value)
    with pytest.raises(NaoError, match="StepHeight"):
        read_gait_config("~gait", {"StepHeight": value if value != -5.0 else math.nan})


def test_a_parameter_that_is_changed_to_no_number_is_refused(monkeypatch):
    kept = {}

    def server(description, callback, *_):
        kept["callback"] = callback
        return MagicMock()

    monkeypatch.setattr(reconfigure, "Server", server)
    node = MagicMock(param=lambda name, default: default)
    field = reconfigure.ReconfigureField("gain", 1.0, "", 0.0, 2.0)
    reconfigure.serve(node, [field], lambda before, after: after)
    with pytest.raises(reconfigure.rospy.ServiceException, match="gain is nan"):
        kept["callback"]({"gain": math.nan}, 0)
