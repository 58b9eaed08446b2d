#!/usr/bin/env python3
"""The shortest client: green eyes for two seconds, then as before; then prints how full the battery is."""

import actionlib
import rospy

from nao_library_actions.msg import NaoLedAction, NaoLedGoal
from nao_library_msgs.msg import LedFunction

rospy.init_node("green_eyes")
lights = actionlib.SimpleActionClient("NaoLights", NaoLedAction)
lights.wait_for_server()
eyes = ["LeftFaceLeds", "RightFaceLeds"]
green = LedFunction(function="setColor", lights=eyes, i_values=[0, 1, 0], time=rospy.Duration(2), revert=True)
battery = LedFunction(function="getData", str_param="Device/SubDeviceList/Battery/Charge/Sensor/Value")
lights.send_goal_and_wait(NaoLedGoal([green, battery]))
print(lights.get_goal_status_text() or lights.get_result().memList)
