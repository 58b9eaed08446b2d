#!/usr/bin/env python3
"""Teaches the robot a motion by hand: `teach_by_hand.py hello --joints LArm --seconds 8`.

The joints go limp, whatever you do with them is recorded; then the robot repeats it, and once more with left and
right exchanged. The motion stays in the folder of the server (`~motion_dir`). On a simulated robot there is nobody to
move the arm: it sinks, and the robot repeats that.

Needs a running server, for example `roslaunch nao_library nao.launch`.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence

import rospy
from actionlib import SimpleActionClient
from actionlib_msgs.msg import GoalStatus

from nao_library_actions.msg import NaoMotionAction, NaoMotionGoal
from nao_library_msgs.msg import MotionFunction

SERVER_LIMIT = rospy.Duration(20)
# Waking up, the ways to the first poses, and some air.
EXTRA_TIME = 60.0


def chain(name: str, joints: Sequence[str], seconds: float, overwrite: bool) -> list[MotionFunction]:
    """Wake up, record, replay, replay in the mirror."""
    return [
        MotionFunction(function="wakeUp"),
        MotionFunction(
            function="recordMotion", str_param=name, names=joints, duration=seconds, limp=True, overwrite=overwrite
        ),
        MotionFunction(function="playMotion", str_param=name, time=rospy.Duration(0.5)),
        MotionFunction(function="playMotion", str_param=name, mirror=True),
    ]


def main() -> int:
    """Record and replay; the exit status tells whether it worked."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("name", help="under which the motion is kept")
    parser.add_argument("--overwrite", action="store_true", help="replace a motion of that name")
    parser.add_argument("--joints", nargs="+", default=["LArm"], help="joints and chains to teach (default: LArm)")
    parser.add_argument("--seconds", type=float, default=5.0, help="how long to record (default: 5)")
    options = parser.parse_args(rospy.myargv()[1:])
    rospy.init_node("teach_by_hand", anonymous=True)
    rospy.sleep(0.0)  # simulated time begins at zero and jumps with the first message of /clock
    motion = SimpleActionClient("NaoMotion", NaoMotionAction)
    if not motion.wait_for_server(SERVER_LIMIT):
        print("there is no server NaoMotion: start one with roslaunch nao_library nao_sim.launch")
        return 1
    goal = NaoMotionGoal(chain(options.name, options.joints, options.seconds, options.overwrite))
    print(f"recording {', '.join(options.joints)} for {options.seconds:g} s as soon as the robot is awake")
    motion.send_goal(goal)
    limit = rospy.Duration.from_sec(3.0 * options.seconds + EXTRA_TIME)
    if not motion.wait_for_result(limit):
        motion.cancel_goal()
        print(f"{options.name}: no result within {limit.to_sec():g} s")
        return 1
    state = motion.get_state()
    print(f"{options.name}: {GoalStatus.to_string(state).lower()} {motion.get_goal_status_text()}".rstrip())
    return 0 if state == GoalStatus.SUCCEEDED else 1


if __name__ == "__main__":
    sys.exit(main())
