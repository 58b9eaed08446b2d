#!/usr/bin/env python3
"""Section III.B: nod, stand and wave, as three goals that are waited for, then as one goal."""

import sys

import actionlib
import rospy

import nao_library_actions.msg
from nao_library_modules.new_functions import newMotionFunction

rospy.init_node("linked_functions_of_the_paper")
rospy.sleep(0.0)  # simulated time begins at zero and jumps with the first message of /clock
motion_client = actionlib.SimpleActionClient("NaoMotion", nao_library_actions.msg.NaoMotionAction)
motion_client.wait_for_server()
LIMIT = rospy.Duration(60)  # the paper waits as long as it takes

# "assuming each animation is a defined MotionFunction"
head, arm = ["HeadPitch"], ["RShoulderPitch", "RElbowRoll"]
nod_function = newMotionFunction("angleInterpolation", head, [0.3, 0.0], [0.5, 1.0], stiffness=1.0)
stand_function = newMotionFunction("goToPosture", "StandInit")
wave_function = newMotionFunction("angleInterpolation", arm, [-0.8, 0.8, 1.2, 0.4], [1.0, 2.0])
nod, stand, wave = (
    nao_library_actions.msg.NaoMotionGoal([function]) for function in (nod_function, stand_function, wave_function)
)

motion_client.send_goal(nod)
motion_client.wait_for_result(LIMIT) or sys.exit("nod: no result within 60 s")
motion_client.send_goal(stand)
motion_client.wait_for_result(LIMIT) or sys.exit("stand: no result within 60 s")
motion_client.send_goal(wave)
motion_client.wait_for_result(LIMIT) or sys.exit("wave: no result within 60 s")
print("three goals:", motion_client.get_goal_status_text() or "done")

nod, stand, wave = nod_function, stand_function, wave_function
motion_goal = nao_library_actions.msg.NaoMotionGoal([nod, stand, wave])
motion_client.send_goal(motion_goal)
motion_client.wait_for_result(LIMIT) or sys.exit("one goal: no result within 60 s")
print("one goal:", motion_client.get_goal_status_text() or "done")
