#!/usr/bin/env python3
"""Section III.A: a light at half intensity, and green eyes, over NAOqi's proxy and as goals of NaoLights."""

import os
import sys
from statistics import mean

import actionlib
import rospy
from rospy import Duration

import nao_library_actions.msg
from nao_library_msgs.msg import LedFunction
from naoqi import ALProxy

SIDES, COLOURS = ("Left", "Right"), ("Red", "Green", "Blue")

rospy.init_node("green_eyes_of_the_paper")
rospy.sleep(0.0)  # simulated time begins at zero and jumps with the first message of /clock
address = os.environ.get("NAO_IP", "127.0.0.1"), int(os.environ.get("NAO_PORT", "9559"))
ledsProxy = ALProxy("ALLeds", *address)
led_client = actionlib.SimpleActionClient("NaoLights", nao_library_actions.msg.NaoLedAction)
led_client.wait_for_server()


def report(what: str) -> None:
    """Print the colour of both eyes, and make them white again for what comes next."""
    eyes = ([mean(ledsProxy.getIntensity(f"{side}FaceLeds{colour}")) for colour in COLOURS] for side in SIDES)
    print(f"{what}:", *eyes)
    ledsProxy.on("FaceLeds")


# One light on the head to half intensity: NAOqi, then NaoLights
ledsProxy.setIntensity("Brain0", 0.5)
print("Brain0 by NAOqi:", ledsProxy.getIntensity("Brain0"))
ledsProxy.off("Brain0")

brain_half = LedFunction(function="setIntensity", lights=["Brain0"], i_values=[0.5])
led_client.send_goal(nao_library_actions.msg.LedGoal([brain_half]))
led_client.wait_for_result(Duration(30)) or sys.exit("half: no result within 30 s")
print("Brain0 by NaoLights:", ledsProxy.getIntensity("Brain0"))

# Turn both eyes green: NAOqi
ledsProxy.setIntensity("LeftFaceLedsRed", 0)
ledsProxy.setIntensity("RightFaceLedsRed", 0)
ledsProxy.setIntensity("LeftFaceLedsGreen", 1)
ledsProxy.setIntensity("RightFaceLedsGreen", 1)
ledsProxy.setIntensity("LeftFaceLedsBlue", 0)
ledsProxy.setIntensity("RightFaceLedsBlue", 0)
report("green by NAOqi")

# Turn both eyes green: nao_library
green_eyes = LedFunction(function="setColor", lights=["LeftFaceLeds", "RightFaceLeds"], i_values=[0, 1, 0])
led_goal = nao_library_actions.msg.LedGoal([green_eyes])
led_client.send_goal(led_goal)
led_client.wait_for_result(Duration(30)) or sys.exit("green: no result within 30 s")
report("green by NaoLights")

# nao_library: Turn both eyes green, then back after two seconds
green_eyes = LedFunction(
    function="setColor",
    lights=["LeftFaceLeds", "RightFaceLeds"],
    i_values=[0, 1, 0],
    time=Duration(2),
    revert=True,
)
led_goal = nao_library_actions.msg.LedGoal([green_eyes])
led_client.send_goal(led_goal)
led_client.wait_for_result(Duration(30)) or sys.exit("back: no result within 30 s")
report("green and back")
