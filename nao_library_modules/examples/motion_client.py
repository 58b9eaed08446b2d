#!/usr/bin/env python3
"""Reads the angles of the right arm, works out a new pose from them, and sends it back.

Needs a running server, for example `roslaunch nao_library nao_sim.launch`. The robot wakes up first.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

import rospy
from actionlib import SimpleActionClient
from actionlib_msgs.msg import GoalStatus
from rospy import Duration
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from nao_library_actions.msg import NaoMotionAction, NaoMotionGoal
from nao_library_msgs.msg import MotionFunction

LIMIT = Duration(30)


def further(names: Sequence[str], angles: Sequence[float]) -> list[float]:
    """Every joint by half a radian more, up to 1; the shoulder's roll as it is."""
    new_pose = []
    for name, angle in zip(names, angles):
        if name == "RShoulderRoll":
            new_pose.append(angle)
        else:
            new_pose.append(min(angle + 0.5, 1))
    return new_pose


def main() -> int:
    """Play the goals; the exit status tells whether the arm is where it should be."""
    rospy.init_node("motion_client", anonymous=True)
    rospy.sleep(0.0)  # simulated time begins at zero and jumps with the first message of /clock
    motion_client = SimpleActionClient("NaoMotion", NaoMotionAction)
    if not motion_client.wait_for_server(LIMIT):
        print("there is no server NaoMotion: start one with roslaunch nao_library nao_sim.launch")
        return 1
    wake_up = MotionFunction(function="wakeUp")
    get_angles = MotionFunction(function="getAngles", names=["RArm"])
    motion_client.send_goal(NaoMotionGoal([wake_up, get_angles]))
    if not motion_client.wait_for_result(LIMIT):
        motion_client.cancel_goal()
        print(f"getAngles: no result within {LIMIT.to_sec():g} s")
        return 1
    if motion_client.get_state() != GoalStatus.SUCCEEDED:
        print(motion_client.get_goal_status_text())
        return 1
    # The result has every joint of the chain; waking up moved them all.
    now = dict(zip(motion_client.get_result().name, motion_client.get_result().position))
    names = [name for name in now if name.startswith(("RShoulder", "RElbow", "RWrist", "RHand"))]
    new_pose = further(names, [now[name] for name in names])

    point_1 = JointTrajectoryPoint(positions=new_pose, time_from_start=Duration(1.0))
    set_pose = MotionFunction(
        function="setPose", trajectory=JointTrajectory(joint_names=names, points=[point_1]), time=Duration(0.5)
    )
    motion_client.send_goal(NaoMotionGoal([set_pose]))
    if not motion_client.wait_for_result(LIMIT):
        motion_client.cancel_goal()
        print(f"setPose: no result within {LIMIT.to_sec():g} s")
        return 1
    state = motion_client.get_state()
    print(f"setPose: {GoalStatus.to_string(state).lower()} {motion_client.get_goal_status_text()}".rstrip())
    result = motion_client.get_result()
    for name, wanted, angle in zip(names, new_pose, result.position if result else []):
        print(f"    {name:<14}  from {now[name]:6.2f}  to {wanted:6.2f}  is at {angle:6.2f}")
    return 0 if state == GoalStatus.SUCCEEDED else 1


if __name__ == "__main__":
    sys.exit(main())
