#!/usr/bin/env python3
"""Takes a pose by its name: `take_pose.py crouch`, or a posture of the robot: `take_pose.py --speed 0.5 StandInit`.

Needs a running driver, for example `roslaunch nao_library nao_sim.launch`. The motors have to be on.
"""

from __future__ import annotations

import argparse
import sys

import rospy
from actionlib import SimpleActionClient
from actionlib_msgs.msg import GoalStatus

from nao_library_actions.msg import (
    BodyPoseAction,
    BodyPoseGoal,
    BodyPoseWithSpeedAction,
    BodyPoseWithSpeedGoal,
)
from nao_library_modules.ros.driver_types import spoken

LIMIT = rospy.Duration(20)


def main() -> int:
    """Take the pose; the exit status tells whether the robot is there."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("name", help="name of a pose: init, zero, crouch, or one of your own")
    parser.add_argument("--speed", type=float, help="take a posture that the robot knows, with this share of its speed")
    options = parser.parse_args(rospy.myargv()[1:])
    rospy.init_node("take_pose", anonymous=True)
    rospy.sleep(0.0)  # simulated time begins at zero and jumps with the first message of /clock
    if options.speed is None:
        client = SimpleActionClient("body_pose", spoken(BodyPoseAction))
        goal = BodyPoseGoal(options.name)
    else:
        client = SimpleActionClient("body_pose_naoqi", spoken(BodyPoseWithSpeedAction))
        goal = BodyPoseWithSpeedGoal(options.name, options.speed)
    if not client.wait_for_server(LIMIT):
        print("there is no pose_manager: start it with roslaunch nao_library nao_sim.launch")
        return 1
    client.send_goal(goal)
    if not client.wait_for_result(LIMIT):
        client.cancel_goal()
        print(f"{options.name}: no result within {LIMIT.to_sec():g} s")
        return 1
    state = client.get_state()
    print(f"{options.name}: {GoalStatus.to_string(state).lower()} {client.get_goal_status_text()}".rstrip())
    return 0 if state == GoalStatus.SUCCEEDED else 1


if __name__ == "__main__":
    sys.exit(main())
