#!/usr/bin/env python3
"""Section III.D: clients of three servers, whose goals run side by side."""

import sys

import actionlib
import rospy

import nao_library_actions.msg
from nao_library_modules.new_functions import newAudioOutFunction, newLedFunction, newMotionFunction

rospy.init_node("several_servers_of_the_paper")
rospy.sleep(0.0)  # simulated time begins at zero and jumps with the first message of /clock
motion = actionlib.SimpleActionClient("NaoMotion", nao_library_actions.msg.NaoMotionAction)
audio_out = actionlib.SimpleActionClient("nao_audio_out", nao_library_actions.msg.NaoAudioOutAction)
lights = actionlib.SimpleActionClient("NaoLights", nao_library_actions.msg.NaoLedAction)
rospy.loginfo("Waiting for servers...")
lights.wait_for_server()
audio_out.wait_for_server()
motion.wait_for_server()
rospy.loginfo("Done")

motion.send_goal(
    nao_library_actions.msg.MotionGoal([newMotionFunction("setAngles", ["HeadYaw"], [0.3], stiffness=1.0)])
)
audio_out.send_goal(nao_library_actions.msg.AudioOutGoal([newAudioOutFunction("say", "Hello")]))
lights.send_goal(nao_library_actions.msg.LedGoal([newLedFunction("fadeRGB", "red", ["FaceLeds"], duration=1.0)]))
for name, client in (("motion", motion), ("audio_out", audio_out), ("lights", lights)):
    client.wait_for_result(rospy.Duration(60)) or sys.exit(f"{name}: no result within 60 s")
    print(f"{name}:", client.get_goal_status_text() or "done")
