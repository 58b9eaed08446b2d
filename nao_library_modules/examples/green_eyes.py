#!/usr/bin/env python3
"""The shortest client: green eyes for two seconds, then as before; then prints how full the battery is."""

import sys

import actionlib
import rospy

from nao_library_actions.msg import NaoLedAction, NaoLedGoal
from nao_library_msgs.msg import LedFunction

rospy.init_node("green_eyes")
rospy.sleep(0.0)  # simulated time begins at zero and jumps with the first message of /clock
lights = actionlib.SimpleActionClient("NaoLights", NaoLedAction)
if not lights.wait_for_server(rospy.Duration(30)):
    sys.exit("there is no server NaoLights: `nao list` tells which there are")
eyes = ["LeftFaceLeds", "RightFaceLeds"]
green = LedFunction(function="setColor", lights=eyes, i_values=[0, 1, 0], time=rospy.Duration(2), revert=True)
battery = LedFunction(function="getData", str_param="Device/SubDeviceList/Battery/Charge/Sensor/Value")
lights.send_goal(NaoLedGoal([green, battery]))
if not lights.wait_for_result(rospy.Duration(30)):
    sys.exit("no result within 30 s")
print(lights.get_goal_status_text() or lights.get_result().memList)
