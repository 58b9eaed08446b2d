"""A reading as messages: frames, units, covariances."""

from __future__ import annotations

import dataclasses
import math

import pytest
from rospy import Time

from nao_library_modules.driver import state_messages as messages
from nao_library_modules.driver.joint_sensors import Reading

STAMP = Time(12, 500)
QUARTER = math.pi / 2
READING = Reading(
    positions=(0.5, -0.25),
    efforts=(0.1, math.nan),
    roll=0.0,
    pitch=0.0,
    angular_velocity=(0.0, 0.0, 0.3),
    acceleration=(0.0, 0.0, 9.81),
    torso=(1.0, 2.0, 0.33, 0.0, 0.0, QUARTER),
)


def test_joint_state_keeps_the_order():
    message = messages.joint_state(STAMP, ("HeadYaw", "LHand"), READING, [0.2, 0.0])
    assert message.header.stamp == STAMP
    assert (message.name, message.position, message.velocity) == (["HeadYaw", "LHand"], (0.5, -0.25), [0.2, 0.0])
    assert message.effort[0] == 0.1


def test_velocity_of_odometry_is_told_in_the_frame_of_the_torso():
    message = messages.odometry(STAMP, "odom", "base_link", READING, (0.0, 0.1, 0.0))
    assert (message.header.frame_id, message.child_frame_id) == ("odom", "base_link")
    ahead = message.twist.twist.linear
    assert (ahead.x, ahead.y, ahead.z) == pytest.approx((0.1, 0.0, 0.0))  # it looks along Y, and goes there
    assert message.twist.twist.angular.z == 0.3


def test_pose_and_frame_of_odometry_are_the_same():
    pose = messages.odometry(STAMP, "odom", "base_link", READING, (0.0, 0.0, 0.0)).pose.pose
    frame = messages.odometry_transform(STAMP, "odom", "base_link", READING)
    assert frame.child_frame_id == "base_link"
    assert (frame.transform.translation.x, frame.transform.translation.y) == (1.0, 2.0)
    assert frame.transform.rotation == pose.orientation
    assert pose.orientation.z == pytest.approx(math.sin(QUARTER / 2))


def test_the_heading_of_the_inertial_unit_is_that_of_odometry_or_unknown():
    known = messages.imu(STAMP, "base_link", READING)
    unknown = messages.imu(STAMP, "base_link", dataclasses.replace(READING, torso=None))
    assert known.orientation.z == pytest.approx(math.sin(QUARTER / 2))
    assert unknown.orientation.w == 1.0
    assert unknown.orientation_covariance[8] > 1e3 * known.orientation_covariance[8]
    assert known.linear_acceleration.z == 9.81


def test_covariances_are_diagonal():
    assert messages.diagonal(1.0, 2.0, 3.0) == [1.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 3.0]
