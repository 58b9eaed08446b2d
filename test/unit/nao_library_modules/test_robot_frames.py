"""Frames of /tf, seen from the robot: on a buffer that is filled by hand."""

from __future__ import annotations

import math

import pytest
import rospy
import tf2_ros
from geometry_msgs.msg import TransformStamped

from nao_library_modules import robot_frames
from naoqi.errors import NaoError


def transform(parent, child, x, y, z, turn):
    stamped = TransformStamped()
    stamped.header.frame_id, stamped.child_frame_id = parent, child
    stamped.header.stamp = rospy.Time(1)
    move, rotation = stamped.transform.translation, stamped.transform.rotation
    move.x, move.y, move.z = x, y, z
    rotation.x, rotation.y, rotation.z, rotation.w = turn
    return stamped


def about_z(angle):
    return (0.0, 0.0, math.sin(angle / 2), math.cos(angle / 2))


@pytest.fixture
def frames(monkeypatch):
    # A lookup with patience waits on ROS time; without a node nothing would come to end it.
    monkeypatch.setattr(robot_frames, "PATIENCE", 0.0)
    monkeypatch.setattr(robot_frames.tf2_ros, "TransformListener", lambda buffer: None)
    monkeypatch.setattr(robot_frames.tf2_ros, "Buffer", lambda: tf2_ros.BufferCore(rospy.Duration(10)))
    monkeypatch.setattr(robot_frames.rospy, "search_param", lambda name: None)
    frames = robot_frames.RobotFrames()
    core = frames._buffer
    lookup = core.lookup_transform_core
    monkeypatch.setattr(
        frames, "_buffer", type("Buffer", (), {"lookup_transform": lambda self, a, b, t, patience: lookup(a, b, t)})()
    )
    core.set_transform(transform("odom", "base_footprint", 1.0, 0.0, 0.0, about_z(math.pi / 2)), "test")
    core.set_transform(transform("odom", "table", 1.0, 0.6, 0.4, about_z(math.pi)), "test")
    return frames


def test_a_frame_is_seen_from_the_robot(frames):
    assert frames.locate("table") == pytest.approx((0.6, 0.0, math.pi / 2))
    assert frames.locate("/odom") == pytest.approx((0.0, 1.0, -math.pi / 2))


def test_a_frame_that_is_not_there_is_named(frames):
    with pytest.raises(NaoError, match="the frame chair cannot be found from base_footprint"):
        frames.locate("chair")


def test_frames_of_one_of_several_robots_have_its_prefix(frames, monkeypatch):
    monkeypatch.setattr(robot_frames.rospy, "search_param", lambda name: "/robot1/tf_prefix")
    monkeypatch.setattr(robot_frames.rospy, "get_param", lambda name: "/robot1/")
    with pytest.raises(NaoError, match="robot1/base_footprint"):
        frames.locate("table")
