#!/usr/bin/env python3
"""Walks along a path that begins where the robot stands: `walk_path.py square`, `walk_path.py curve --size 0.5`.

Needs a running driver, for example `roslaunch nao_library nao_sim.launch`. The robot has to stand: `rosservice call
wakeup`. Ctrl-C stops it.
"""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Sequence

import rospy
from actionlib import SimpleActionClient
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import PoseStamped

from nao_library_actions.msg import FollowPathAction, FollowPathFeedback, FollowPathGoal
from nao_library_modules.ros.driver_types import spoken

LIMIT = rospy.Duration(20)
WALK_LIMIT = rospy.Duration(300)
PIECES = 40


def square(size: float) -> list[tuple[float, float]]:
    """Corners of a square to the left of the robot, x and y in m, back to where it begins."""
    return [(0.0, 0.0), (size, 0.0), (size, size), (0.0, size), (0.0, 0.0)]


def curve(size: float) -> list[tuple[float, float]]:
    """An S: to the left, to the right and on, `size` m ahead in all; x and y in m."""
    shares = [i / PIECES for i in range(PIECES + 1)]
    return [(size * share, 0.12 * size * (1.0 - math.cos(2 * math.pi * share))) for share in shares]


def goal(points: Sequence[tuple[float, float]]) -> FollowPathGoal:
    """A path through points in the frame of the robot. Headings are left to the path."""
    path = FollowPathGoal()
    path.path.header.frame_id = "base_footprint"
    for x, y in points:
        pose = PoseStamped()
        pose.pose.position.x, pose.pose.position.y = x, y
        path.path.poses.append(pose)
    return path


def main() -> int:
    """Walk along it; the exit status tells whether the robot got to the end."""
    parser = argparse.ArgumentParser(description=__doc__)
    shapes = {"square": square, "curve": curve}
    parser.add_argument("shape", choices=shapes, nargs="?", default="curve", help="shape of the path (curve)")
    parser.add_argument("--size", type=float, default=1.0, help="m from one end to the other (1)")
    options = parser.parse_args(rospy.myargv()[1:])
    points = shapes[options.shape](options.size)
    rospy.init_node("walk_path", anonymous=True)
    rospy.sleep(0.0)  # simulated time begins at zero and jumps with the first message of /clock
    client = SimpleActionClient("walk_path", spoken(FollowPathAction))
    if not client.wait_for_server(LIMIT):
        print("there is no nao_path_follower: start it with roslaunch nao_library nao_sim.launch")
        return 1

    def show(feedback: FollowPathFeedback) -> None:
        print(f"\rwaypoint {feedback.index} of {len(points) - 1} is next", end="", flush=True)

    rospy.on_shutdown(lambda: client.get_state() == GoalStatus.ACTIVE and client.cancel_goal())
    client.send_goal(goal(points), feedback_cb=show)
    if not client.wait_for_result(WALK_LIMIT):
        client.cancel_goal()
        print(f"\nno result within {WALK_LIMIT.to_sec():g} s")
        return 1
    state = client.get_state()
    print(f"\n{GoalStatus.to_string(state).lower()} {client.get_goal_status_text()}".rstrip())
    return 0 if state == GoalStatus.SUCCEEDED else 1


if __name__ == "__main__":
    sys.exit(main())
