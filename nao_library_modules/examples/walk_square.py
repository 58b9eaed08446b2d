#!/usr/bin/env python3
"""Walks a square, one side after the other: `walk_square.py --side 0.5`. Corrects its way by the odometry.

Needs a running driver, for example `roslaunch nao_library nao_sim.launch`, and a robot that stands:
`rosservice call wakeup`.
"""

from __future__ import annotations

import argparse
import math
import sys

import rospy
from geometry_msgs.msg import Pose2D
from nav_msgs.msg import Odometry

from nao_library_msgs.srv import CmdPoseService

LIMIT = 10.0


def square(side: float) -> list[tuple[float, float, float]]:
    """Corners of a square to the left of its first side: x and y in m, heading in rad, seen from the start."""
    quarter = math.pi / 2
    return [(side, 0.0, quarter), (side, side, math.pi), (0.0, side, -quarter), (0.0, 0.0, 0.0)]


def seen_from(place: tuple[float, float, float], target: tuple[float, float, float]) -> tuple[float, float, float]:
    """A target in the frame of a place; both are x and y in m, heading in rad, in one frame."""
    x, y, heading = place
    ahead, aside = target[0] - x, target[1] - y
    turn = math.remainder(target[2] - heading, 2 * math.pi)
    cosine, sine = math.cos(heading), math.sin(heading)
    return cosine * ahead + sine * aside, cosine * aside - sine * ahead, turn


def in_odometry(start: tuple[float, float, float], target: tuple[float, float, float]) -> tuple[float, float, float]:
    """The opposite: a target that is seen from the start, in the frame of the odometry."""
    x, y, heading = start
    cosine, sine = math.cos(heading), math.sin(heading)
    return x + cosine * target[0] - sine * target[1], y + sine * target[0] + cosine * target[1], heading + target[2]


def place() -> tuple[float, float, float]:
    """Where the odometry has the robot: x and y in m, heading in rad."""
    began = rospy.Time.now()
    while True:
        message = rospy.wait_for_message("odom", Odometry, LIMIT)
        if message.header.stamp >= began:
            break
    pose = message.pose.pose
    turn = pose.orientation
    heading = math.atan2(2 * (turn.w * turn.z + turn.x * turn.y), 1 - 2 * (turn.y**2 + turn.z**2))
    return pose.position.x, pose.position.y, heading


def main() -> int:
    """Walk it; the exit status tells whether the robot got around."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--side", type=float, default=1.0, help="length of a side in m (default: 1)")
    options = parser.parse_args(rospy.myargv()[1:])
    rospy.init_node("walk_square", anonymous=True)
    walk = rospy.ServiceProxy("cmd_pose_srv", CmdPoseService)
    try:
        walk.wait_for_service(LIMIT)
        start = place()
        for number, corner in enumerate(square(options.side), start=1):
            walk(Pose2D(*seen_from(place(), in_odometry(start, corner))))
            x, y, turn = seen_from(start, place())
            print(f"corner {number}: {x:.2f} m, {y:.2f} m, {math.degrees(turn):.0f} degrees from the start", flush=True)
    except (rospy.ROSException, rospy.ServiceException) as error:
        print(f"the square ends here: {error}")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
