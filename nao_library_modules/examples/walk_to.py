#!/usr/bin/env python3
"""Walks to a place: `walk_to.py 0.5 0.2 --turn 90` is half a metre ahead, 20 cm to the left, and a quarter turn left.

Needs a running driver, for example `roslaunch nao_library nao_sim.launch`. The robot has to stand: `rosservice call
wakeup`. Ctrl-C stops it.
"""

from __future__ import annotations

import argparse
import math
import sys

import rospy
from actionlib import SimpleActionClient
from actionlib_msgs.msg import GoalStatus
from move_base_msgs.msg import MoveBaseAction, MoveBaseFeedback, MoveBaseGoal

LIMIT = rospy.Duration(20)
WALK_LIMIT = rospy.Duration(300)


def goal(x: float, y: float, turn: float, frame: str) -> MoveBaseGoal:
    """A target.

    Args:
        x: m, in the frame.
        y: m, in the frame.
        turn: Heading in degrees, in the frame.
        frame: Name of a frame of /tf.
    """
    target = MoveBaseGoal()
    target.target_pose.header.frame_id = frame
    target.target_pose.pose.position.x, target.target_pose.pose.position.y = x, y
    target.target_pose.pose.orientation.z = math.sin(math.radians(turn) / 2)
    target.target_pose.pose.orientation.w = math.cos(math.radians(turn) / 2)
    return target


def show(feedback: MoveBaseFeedback) -> None:
    """Print where the robot is, always on the same line."""
    where = feedback.base_position
    place = where.pose.position
    print(f"\rthe robot is at x {place.x:5.2f} m, y {place.y:5.2f} m in {where.header.frame_id}", end="", flush=True)


def main() -> int:
    """Walk there; the exit status tells whether the robot is there."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("x", type=float, help="m ahead")
    parser.add_argument("y", type=float, nargs="?", default=0.0, help="m to the left (0)")
    parser.add_argument("--turn", type=float, default=0.0, help="degrees to the left (0)")
    parser.add_argument("--frame", default="base_footprint", help="frame of it (base_footprint: the robot's own)")
    options = parser.parse_args(rospy.myargv()[1:])
    rospy.init_node("walk_to", anonymous=True)
    rospy.sleep(0.0)  # simulated time begins at zero and jumps with the first message of /clock
    client = SimpleActionClient("walk_target", MoveBaseAction)
    if not client.wait_for_server(LIMIT):
        print("there is no nao_path_follower: start it with roslaunch nao_library nao_sim.launch")
        return 1
    rospy.on_shutdown(lambda: client.get_state() == GoalStatus.ACTIVE and client.cancel_goal())
    client.send_goal(goal(options.x, options.y, options.turn, options.frame), feedback_cb=show)
    if not client.wait_for_result(WALK_LIMIT):
        client.cancel_goal()
        print(f"\nno result within {WALK_LIMIT.to_sec():g} s")
        return 1
    state = client.get_state()
    print(f"\n{GoalStatus.to_string(state).lower()} {client.get_goal_status_text()}".rstrip())
    return 0 if state == GoalStatus.SUCCEEDED else 1


if __name__ == "__main__":
    sys.exit(main())
