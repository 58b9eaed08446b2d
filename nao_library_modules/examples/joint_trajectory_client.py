#!/usr/bin/env python3
"""Moves joints along timed angles: the motors on, the head from side to side, then both arms at the same time.

Needs a running driver, for example `roslaunch nao_library nao_sim.launch`.
"""

from __future__ import annotations

import sys

import rospy
from actionlib import SimpleActionClient
from actionlib_msgs.msg import GoalStatus
from std_srvs.srv import Empty
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from nao_library_actions.msg import JointTrajectoryAction, JointTrajectoryGoal
from nao_library_modules.ros.driver_types import spoken

LIMIT = rospy.Duration(20)
ARMS = ["LShoulderPitch", "LShoulderRoll", "RShoulderPitch", "RShoulderRoll"]


def goal(joints: list[str], points: dict[float, list[float]]) -> JointTrajectoryGoal:
    """A goal of nao_controller.

    Args:
        joints: Names of joints, or of chains such as "Head".
        points: Time from the start in s -> angles in rad, one for each joint.
    """
    trajectory = JointTrajectory(joint_names=joints)
    for time, angles in points.items():
        trajectory.points.append(JointTrajectoryPoint(time_from_start=rospy.Duration(time), positions=angles))
    return JointTrajectoryGoal(trajectory=trajectory)


def goals() -> list[tuple[str, JointTrajectoryGoal]]:
    """Goals to play, each with a title."""
    return [
        ("look left, right and ahead", goal(["HeadYaw"], {1.0: [0.8], 2.5: [-0.8], 3.5: [0.0]})),
        ("nod", goal(["Head"], {0.5: [0.0, 0.3], 1.0: [0.0, -0.2], 1.5: [0.0, 0.0]})),
        ("arms up and down", goal(ARMS, {1.5: [0.2, 0.3, 0.2, -0.3], 3.0: [1.4, 0.2, 1.4, -0.2]})),
    ]


def main() -> int:
    """Play the goals one after the other; the exit status tells whether all succeeded."""
    rospy.init_node("joint_trajectory_client", anonymous=True)
    rospy.sleep(0.0)  # simulated time begins at zero and jumps with the first message of /clock
    client = SimpleActionClient("joint_trajectory", spoken(JointTrajectoryAction))
    if not client.wait_for_server(LIMIT):
        print("there is no server joint_trajectory: start one with roslaunch nao_library nao_sim.launch")
        return 1
    rospy.ServiceProxy("body_stiffness/enable", Empty)()
    failures = 0
    for title, each in goals():
        client.send_goal(each)
        if not client.wait_for_result(LIMIT):
            client.cancel_goal()
            print(f"{title}: no result within {LIMIT.to_sec():g} s")
            failures += 1
            continue
        state = client.get_state()
        print(f"{title}: {GoalStatus.to_string(state).lower()} {client.get_goal_status_text()}".rstrip())
        if state == GoalStatus.SUCCEEDED:
            print("    " + " ".join(f"{angle:.2f}" for angle in client.get_result().goal_position.position))
        failures += state != GoalStatus.SUCCEEDED
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
