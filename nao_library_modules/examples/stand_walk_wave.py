#!/usr/bin/env python3
"""Stands up, walks 0.3 m ahead and waves: one goal.

Needs a running server, for example `roslaunch nao_library nao_sim.launch`. Ctrl-C ends the walk on both feet.
"""

from __future__ import annotations

import sys

import rospy
from actionlib import SimpleActionClient
from actionlib_msgs.msg import GoalStatus

from nao_library_actions.msg import NaoMotionAction, NaoMotionGoal
from nao_library_msgs.msg import MotionFunction

LIMIT = rospy.Duration(90)


def chain(distance: float = 0.3) -> list[MotionFunction]:
    """The motions. Lengths in m, angles in rad."""
    stand = MotionFunction(function="goToPosture", str_param="Stand")
    walk = MotionFunction(function="moveTo", values=[distance, 0.0, 0.0], gait=["MaxStepX"], gait_values=[0.05])
    raise_arm = MotionFunction(
        function="setPose", names=["RArm"], angles=[-1.0, -0.3, 1.2, 0.8, 0.0, 1.0], duration=1.5
    )
    wave = MotionFunction(
        function="angleInterpolation", names=["RElbowRoll"], angles=[0.4, 1.2, 0.4, 1.2], times=[0.5, 1.0, 1.5, 2.0]
    )
    lower_arm = MotionFunction(function="goToPosture", str_param="Stand", speed=0.5)
    where = MotionFunction(function="getRobotPosition")
    return [stand, walk, raise_arm, wave, lower_arm, where]


def main() -> int:
    """Play the chain; the exit status tells whether all of it was done."""
    rospy.init_node("stand_walk_wave", anonymous=True)
    rospy.sleep(0.0)  # simulated time begins at zero and jumps with the first message of /clock
    motion = SimpleActionClient("NaoMotion", NaoMotionAction)
    if not motion.wait_for_server(LIMIT):
        print("there is no server NaoMotion: start one with roslaunch nao_library nao_sim.launch")
        return 1
    rospy.on_shutdown(motion.cancel_goal)
    motion.send_goal(NaoMotionGoal(chain()))
    if not motion.wait_for_result(LIMIT):
        motion.cancel_goal()
        print(f"no result within {LIMIT.to_sec():g} s")
        return 1
    state = motion.get_state()
    if state != GoalStatus.SUCCEEDED:
        print(f"{GoalStatus.to_string(state).lower()} {motion.get_goal_status_text()}".rstrip())
        return 1
    results = {result.function: [float(value) for value in result.values] for result in motion.get_result().results}
    print("walked {:.2f} m ahead, {:.2f} m to the left".format(*results["moveTo"]))
    print("stands at x {:.2f} m, y {:.2f} m of the world".format(*results["getRobotPosition"]))
    return 0


if __name__ == "__main__":
    sys.exit(main())
