"""Poses and paths of messages as places, and frames that hang below others."""

from __future__ import annotations

import math
import time

import pytest
import rospy
import tf2_ros
from geometry_msgs.msg import PoseStamped, TransformStamped
from nav_msgs.msg import Path

from nao_library_modules.driver import planar_frames
from nao_library_modules.driver.planar_frames import (
    PlanarFrames,
    level_quaternion,
    pose_stamped,
    read_path,
    read_place,
)
from nao_library_modules.driver.rotation import from_roll_pitch_yaw
from nao_library_modules.errors import BadGoal
from nao_library_modules.places import Place
from naoqi.errors import NaoError

QUARTER = math.pi / 2
NOW = rospy.Time(100)
HERE = Place(1.0, -2.0, 0.5)


def pose(x, y, frame="odom", yaw=None):
    message = PoseStamped()
    message.header.frame_id = frame
    message.pose.position.x, message.pose.position.y = x, y
    if yaw is not None:
        message.pose.orientation = level_quaternion(yaw)
    return message


def test_a_place_is_the_same_there_and_back():
    place, frame = read_place("goal", pose_stamped(HERE, "/map", NOW))
    assert place == pytest.approx(HERE)
    assert frame == "map"


@pytest.mark.parametrize(
    "message, words",
    [
        (pose(1.0, 0.0, frame="", yaw=0.0), r"goal\.header\.frame_id"),
        (pose(1.0, 0.0), r"goal\.pose\.orientation.*\(0, 0, 0, 0\).*rotation"),
        (pose(math.nan, 0.0, yaw=0.0), r"goal\.pose\.position\.x.*finite"),
        (pose(0.0, -math.inf, yaw=0.0), r"goal\.pose\.position\.y.*finite"),
    ],
)
def test_what_is_no_place_is_told(message, words):
    with pytest.raises(BadGoal, match=words):
        read_place("goal", message)


def path(*poses, frame="odom"):
    message = Path(poses=list(poses))
    message.header.frame_id = frame
    return message


def test_of_a_path_the_last_heading_counts():
    places, frame = read_path(path(pose(0, 0), pose(1, 0), pose(1, 1, yaw=0.25)))
    assert frame == "odom"
    assert places[:2] == [Place(0, 0, 0), Place(1, 0, 0)]
    assert places[2] == pytest.approx((1, 1, 0.25))


def test_without_one_it_is_that_of_the_path():
    assert read_path(path(pose(0, 0), pose(1, 0), pose(1, 1), pose(1, 1)))[0][-1].yaw == pytest.approx(QUARTER)


def test_the_frame_of_a_path_may_be_that_of_its_poses():
    assert read_path(path(pose(0, 0, "map"), pose(1, 0, "map"), frame=""))[1] == "map"
    with pytest.raises(BadGoal, match="path.poses.*all in the frame of the path, map"):
        read_path(path(pose(0, 0, "odom"), pose(1, 0, "map"), frame="map"))
    with pytest.raises(BadGoal, match="frame_id"):
        read_path(path(pose(0, 0, ""), frame=""))
    with pytest.raises(BadGoal, match=r"path\.poses\[1\]\.pose\.position\.x"):
        read_path(path(pose(0, 0), pose(math.nan, 0)))


class Buffer(tf2_ros.BufferCore):
    """Frames that come from the test; nobody waits for more."""

    def lookup_transform(self, target, source, time, timeout):
        return self.lookup_transform_core(target, source, time)


@pytest.fixture
def frames(monkeypatch):
    """Frames: map - odom - base_link - CameraTop, which looks down, and odom - ball."""
    monkeypatch.setattr(planar_frames.rospy.Time, "now", lambda: rospy.Time(NOW.secs, 500_000_000))
    buffer = Buffer()

    def add(parent, child, x, y, z=0.0, roll=0.0, pitch=0.0, yaw=0.0):
        transform = TransformStamped(child_frame_id=child)
        transform.header.frame_id, transform.header.stamp = parent, NOW
        move, turn = transform.transform.translation, transform.transform.rotation
        move.x, move.y, move.z = x, y, z
        turn.x, turn.y, turn.z, turn.w = from_roll_pitch_yaw(roll, pitch, yaw)
        buffer.set_transform(transform, "test")

    add("map", "odom", 10.0, 0.0)
    add("odom", "base_link", 1.0, 2.0, yaw=QUARTER)
    add("base_link", "CameraTop", 0.1, 0.0, 0.4, pitch=math.radians(60.0))
    add("odom", "ball", 3.0, 0.0)
    return PlanarFrames(buffer)


def test_frames_are_found_in_each_other_seen_from_above(frames):
    assert frames.locate("base_link", "map", 0.0) == pytest.approx((11.0, 2.0, QUARTER))
    assert frames.locate("CameraTop", "odom", 0.0) == pytest.approx((1.0, 2.1, QUARTER))


def test_a_pose_of_a_frame_that_looks_down_is_turned_before_it_is_laid_flat(frames):
    ahead = pose(1.0, 0.0, "CameraTop", yaw=0.0)
    assert frames.place_in("odom", ahead, 0.0) == pytest.approx((1.0, 2.1 + math.cos(math.radians(60.0)), QUARTER))
    assert frames.place_in("base_link", pose(3.0, 0.0, "odom", yaw=0.0), 0.0) == pytest.approx((-2.0, -2.0, -QUARTER))


def test_a_pose_of_a_time_that_is_not_known_counts_as_of_now(frames):
    late = pose(0.5, 0.0, "base_link", yaw=0.0)
    late.header.stamp = rospy.Time(NOW.secs + 50)
    assert frames.place_in("odom", late, 0.0) == pytest.approx((1.0, 2.5, QUARTER))


def test_frames_below_odometry_are_known(frames):
    assert [frames.inside(frame, "odom") for frame in ("base_link", "CameraTop", "odom", "ball")] == [True] * 4
    assert [frames.inside(frame, "odom") for frame in ("map", "nowhere")] == [False] * 2


def test_before_the_first_message_there_are_no_frames():
    frames = PlanarFrames(Buffer())
    assert not frames.inside("base_link", "odom")
    with pytest.raises(NaoError, match="base_link cannot be found in odom"):
        frames.locate("base_link", "odom", 0.0)


def test_a_robot_that_is_not_heard_of_any_more_is_told(frames, monkeypatch):
    monkeypatch.setattr(planar_frames.rospy.Time, "now", lambda: rospy.Time(NOW.secs + 4))
    frames.locate("base_link", "odom", 0.0)  # simulated time may have run on; in real time it was just now
    real = time.monotonic
    monkeypatch.setattr(time, "monotonic", lambda: real() + 3.0)
    with pytest.raises(NaoError, match=r"base_link is in odom was told 4\.0 s ago: does nao_joint_states run"):
        frames.locate("base_link", "odom", 0.0)
