#!/usr/bin/env python3
"""Prints where the robot is, how its head is turned, and where its top camera looks from.

Needs a running driver, for example `roslaunch nao_library nao_sim.launch`.
"""

from __future__ import annotations

import math
import sys

import rospy
import tf2_ros
from nav_msgs.msg import Odometry
from sensor_msgs.msg import JointState

LIMIT = 10.0


def main() -> int:
    """Print it once; the exit status tells whether the robot could be seen."""
    rospy.init_node("robot_state", anonymous=True)
    frames = tf2_ros.Buffer()
    listener = tf2_ros.TransformListener(frames)
    try:
        joints = rospy.wait_for_message("joint_states", JointState, LIMIT)
        pose = rospy.wait_for_message("odom", Odometry, LIMIT).pose.pose
        camera = frames.lookup_transform("odom", "CameraTop_frame", rospy.Time(), rospy.Duration(LIMIT))
    except (rospy.ROSException, tf2_ros.TransformException) as error:
        print(f"nothing to be seen: {error}")
        return 1
    finally:
        listener.unregister()
    angles = dict(zip(joints.name, joints.position))
    turn = pose.orientation
    heading = math.atan2(2 * (turn.w * turn.z + turn.x * turn.y), 1 - 2 * (turn.y**2 + turn.z**2))
    place = camera.transform.translation
    print(f"torso   x {pose.position.x:.2f} m, y {pose.position.y:.2f} m, z {pose.position.z:.2f} m, {heading:.2f} rad")
    print(f"head    yaw {angles['HeadYaw']:.2f} rad, pitch {angles['HeadPitch']:.2f} rad")
    print(f"camera  x {place.x:.2f} m, y {place.y:.2f} m, z {place.z:.2f} m")
    return 0


if __name__ == "__main__":
    sys.exit(main())
