#!/usr/bin/env python3
"""Section III.C: the angles of the right arm are read, and a new pose is made of them."""

import sys

import actionlib
import rospy
from rospy import Duration

import nao_library_actions.msg
from nao_library_modules.new_functions import JointTrajectoryPoint, newMotionFunction

rospy.init_node("animation_of_the_paper")
rospy.sleep(0.0)  # simulated time begins at zero and jumps with the first message of /clock
motion_client = actionlib.SimpleActionClient("NaoMotion", nao_library_actions.msg.NaoMotionAction)
motion_client.wait_for_server()
LIMIT = Duration(60)  # the paper waits as long as it takes

time_from_start = Duration(1.0)
getAngles = newMotionFunction("getAngles", ["RArm"])
motion_client.send_goal(nao_library_actions.msg.NaoMotionGoal([getAngles]))
# The result is there when the goal is over; the paper leaves this line out.
motion_client.wait_for_result(LIMIT) or sys.exit("getAngles: no result within 60 s")
result = motion_client.get_result()
new_pose = []
for name, angle in zip(result.name, result.position):
    if name == "RShoulderRoll":
        new_pose.append(angle)
    else:
        new_pose.append(min(angle + 0.5, 1))
point_1 = JointTrajectoryPoint(time_from_start, new_pose)

# "Now the point can be called again in a setPose() function to return to the pose"
setPose = newMotionFunction("setPose", ["RArm"], point_1, stiffness=1.0)
motion_client.send_goal(nao_library_actions.msg.NaoMotionGoal([setPose]))
motion_client.wait_for_result(LIMIT) or sys.exit("setPose: no result within 60 s")
print("setPose:", motion_client.get_goal_status_text() or "done")
for name, wanted, angle in zip(result.name, new_pose, motion_client.get_result().position):
    print(f"    {name:<14}  to {wanted:6.2f}  is at {angle:6.2f}")
