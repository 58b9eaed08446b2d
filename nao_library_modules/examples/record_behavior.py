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
from actionlib_msgs.msg import GoalStatus

from nao_library_actions.msg import NaoBehaviorAction, NaoBehaviorGoal
from nao_library_modules.simple_action_client import SimpleActionClient
from nao_library_msgs.msg import BehaviorFunction

SERVER_LIMIT = rospy.Duration(20)


def chain(name: str, seconds: float) -> list[BehaviorFunction]:
    """Record, show what came, do it again."""
    return [
        BehaviorFunction(function="recordBehavior", str_param=name, duration=seconds, overwrite=True),
        BehaviorFunction(function="describeBehavior", str_param=name),
        BehaviorFunction(function="runBehavior", str_param=name),
    ]


def main() -> int:
    """Record and replay; the exit status tells whether it worked."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("name", help="of the behaviour; one of that name is replaced")
    parser.add_argument("--seconds", type=float, default=10.0, help="how long to record (default: 10)")
    options = parser.parse_args(rospy.myargv()[1:])
    rospy.init_node("record_behavior", anonymous=True)
    rospy.sleep(0.0)  # simulated time begins at zero and jumps with the first message of /clock
    behaviors = SimpleActionClient("NaoBehavior", NaoBehaviorAction)
    if not behaviors.wait_for_server(SERVER_LIMIT):
        print("there is no server NaoBehavior: start one with roslaunch nao_library nao_sim.launch")
        return 1
    print(f"recording for {options.seconds:g} s", flush=True)
    behaviors.send_goal_and_wait(NaoBehaviorGoal(chain(options.name, options.seconds)))
    answers = {each.function: each.values for each in behaviors.get_result().results}
    print("\n".join(answers.get("describeBehavior", [])))
    state = behaviors.get_state()
    print(f"{options.name}: {GoalStatus.to_string(state).lower()} {behaviors.get_goal_status_text()}".rstrip())
    return 0 if state == GoalStatus.SUCCEEDED else 1


if __name__ == "__main__":
    sys.exit(main())
