#!/usr/bin/env python3
"""Nods, stands up and waves: three motions, one goal, no waiting in between.

Needs a running server, for example `roslaunch nao_library nao_sim.launch`.
"""

from __future__ import annotations

import sys

import rospy
from actionlib import SimpleActionClient
from actionlib_msgs.msg import GoalStatus

from nao_library_actions.msg import NaoMotionAction, NaoMotionFeedback, NaoMotionGoal
from nao_library_msgs.msg import MotionFunction

LIMIT = rospy.Duration(60)


def chain() -> list[MotionFunction]:
    """The motions. Angles in rad; of several joints the key angles follow joint by joint."""
    nod = MotionFunction(
        function="angleInterpolation",
        names=["HeadPitch"],
        angles=[0.3, -0.2, 0.3, 0.0],
        times=[0.5, 1.0, 1.5, 2.0],
        stiffness=1.0,
        time=rospy.Duration(0.2),
    )
    stand = MotionFunction(function="goToPosture", str_param="Stand")
    raise_arm = MotionFunction(
        function="setPose", names=["RArm"], angles=[-1.0, -0.3, 1.2, 0.8, 0.0, 1.0], duration=1.5
    )
    wave = MotionFunction(
        function="angleInterpolation",
        names=["RElbowRoll", "RWristYaw"],
        angles=[0.4, 1.2, 0.4, 1.2, -0.3, 0.3, -0.3, 0.0],
        times=[0.5, 1.0, 1.5, 2.0],
    )
    stand_again = MotionFunction(function="goToPosture", str_param="Stand", speed=0.5)
    return [nod, stand, raise_arm, wave, stand_again]


def tell(feedback: NaoMotionFeedback) -> None:
    """Print which motion begins."""
    print(f"{feedback.index + 1} of {feedback.count}: {feedback.function}")


def main() -> int:
    """Play the chain; the exit status tells whether all of it was done."""
    rospy.init_node("nod_stand_wave", anonymous=True)
    rospy.sleep(0.0)  # simulated time begins at zero and jumps with the first message of /clock
    motion = SimpleActionClient("NaoMotion", NaoMotionAction)
    if not motion.wait_for_server(LIMIT):
        print("there is no server NaoMotion: start one with roslaunch nao_library nao_sim.launch")
        return 1
    motion.send_goal(NaoMotionGoal(chain()), feedback_cb=tell)
    if not motion.wait_for_result(LIMIT):
        motion.cancel_goal()
        print(f"no result within {LIMIT.to_sec():g} s")
        return 1
    state = motion.get_state()
    print(f"{GoalStatus.to_string(state).lower()} {motion.get_goal_status_text()}".rstrip())
    return 0 if state == GoalStatus.SUCCEEDED else 1


if __name__ == "__main__":
    sys.exit(main())
