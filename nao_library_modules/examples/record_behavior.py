#!/usr/bin/env python3
"""Records what other programs have the robot do, and has it do that again: `record_behavior.py mine --seconds 10`.

While it records, send goals to the servers from anywhere: with other examples, with `nao`, with your own programs.
Afterwards the behaviour is a file in the folder of the server (`~behavior_dir`) that you can look at and change.

Needs a running server, for example `roslaunch nao_library nao_sim.launch`.
"""

from __future__ import annotations

import argparse
import sys

import rospy
from actionlib import SimpleActionClient
from actionlib_msgs.msg import GoalStatus

from nao_library_actions.msg import NaoBehaviorAction, NaoBehaviorGoal
from nao_library_msgs.msg import BehaviorFunction

SERVER_LIMIT = rospy.Duration(20)
EXTRA_TIME = 60.0
"""s for what is done again to take longer than it was recorded for."""


def chain(name: str, seconds: float, overwrite: bool) -> list[BehaviorFunction]:
    """Record, show what came, do it again."""
    return [
        BehaviorFunction(function="recordBehavior", str_param=name, duration=seconds, overwrite=overwrite),
        BehaviorFunction(function="describeBehavior", str_param=name),
        BehaviorFunction(function="runBehavior", str_param=name),
    ]


def main() -> int:
    """Record and replay; the exit status tells whether it worked."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("name", help="of the behaviour")
    parser.add_argument("--overwrite", action="store_true", help="replace a behaviour of that name")
    parser.add_argument("--seconds", type=float, default=10.0, help="how long to record (default: 10)")
    options = parser.parse_args(rospy.myargv()[1:])
    rospy.init_node("record_behavior", anonymous=True)
    rospy.sleep(0.0)  # simulated time begins at zero and jumps with the first message of /clock
    behaviors = SimpleActionClient("NaoBehavior", NaoBehaviorAction)
    if not behaviors.wait_for_server(SERVER_LIMIT):
        print("there is no server NaoBehavior: start one with roslaunch nao_library nao_sim.launch")
        return 1
    print(f"recording for {options.seconds:g} s", flush=True)
    behaviors.send_goal(NaoBehaviorGoal(chain(options.name, options.seconds, options.overwrite)))
    limit = rospy.Duration.from_sec(2.0 * options.seconds + EXTRA_TIME)
    if not behaviors.wait_for_result(limit):
        behaviors.cancel_goal()
        print(f"{options.name}: no result within {limit.to_sec():g} s")
        return 1
    answers = {each.function: each.values for each in behaviors.get_result().results}
    print("\n".join(answers.get("describeBehavior", [])))
    state = behaviors.get_state()
    print(f"{options.name}: {GoalStatus.to_string(state).lower()} {behaviors.get_goal_status_text()}".rstrip())
    return 0 if state == GoalStatus.SUCCEEDED else 1


if __name__ == "__main__":
    sys.exit(main())
