#!/usr/bin/env python3
"""Pushes the simulated robot over and has it get up again.

Needs a running simulator with servers: `roslaunch nao_library nao_sim.launch`.
"""

from __future__ import annotations

import sys

import rospy
from actionlib import SimpleActionClient
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import Vector3

from nao_library_actions.msg import NaoMotionAction, NaoMotionGoal
from nao_library_msgs.msg import MotionFunction
from nao_library_msgs.srv import PushRobot

SERVER_LIMIT = 20.0
GOAL_LIMIT = rospy.Duration(120)
# Backwards, N: more than the robot can balance.
FORCE = Vector3(-60.0, 0.0, 0.0)
PUSH_TIME, FALL_TIME = rospy.Duration.from_sec(0.15), rospy.Duration(3)


def play(motion: SimpleActionClient, *functions: MotionFunction) -> list[str]:
    """Play a chain; its answers.

    Raises:
        RuntimeError: If it did not succeed.
    """
    motion.send_goal(NaoMotionGoal(list(functions)))
    if not motion.wait_for_result(GOAL_LIMIT):
        motion.cancel_goal()
        raise RuntimeError(f"no result within {GOAL_LIMIT.to_sec():g} s")
    state = motion.get_state()
    if state != GoalStatus.SUCCEEDED:
        raise RuntimeError(f"{GoalStatus.to_string(state).lower()}: {motion.get_goal_status_text()}")
    return motion.get_result().memList


def main() -> int:
    """Push, wait for the fall, get up; the exit status tells whether the robot stands."""
    rospy.init_node("get_up", anonymous=True)
    rospy.sleep(0.0)  # simulated time begins at zero and jumps with the first message of /clock
    motion = SimpleActionClient("NaoMotion", NaoMotionAction)
    push = rospy.ServiceProxy("nao_sim/push", PushRobot)
    try:
        push.wait_for_service(SERVER_LIMIT)
        if not motion.wait_for_server(rospy.Duration.from_sec(SERVER_LIMIT)):
            raise RuntimeError("there is no server NaoMotion")
        play(motion, MotionFunction(function="wakeUp"))
        push("torso", FORCE, PUSH_TIME)
        # The wait after a function leaves the robot its time to fall.
        play(motion, MotionFunction(function="getPosture", time=FALL_TIME))
        print(f"fallen: {play(motion, MotionFunction(function='getPostureFamily'))[0]}")
        stand = MotionFunction(function="goToPosture", str_param="Stand")
        print(f"got up: {play(motion, stand, MotionFunction(function='getPosture'))[-1]}")
    except (rospy.ROSException, RuntimeError) as error:
        print(f"{error}; start the simulator with roslaunch nao_library nao_sim.launch")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
