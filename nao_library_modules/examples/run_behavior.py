#!/usr/bin/env python3
"""Runs a stored behaviour and tells how it goes: `run_behavior.py hello text="Good morning"`.

Without a name it lists the behaviours. Ctrl-C ends the behaviour, and with it whatever the robot does.

Needs a running server, for example `roslaunch nao_library nao_sim.launch`.
"""

from __future__ import annotations

import argparse
import sys

import rospy
from actionlib import SimpleActionClient
from actionlib_msgs.msg import GoalStatus

from nao_library_actions.msg import NaoBehaviorAction, NaoBehaviorFeedback, NaoBehaviorGoal
from nao_library_msgs.msg import BehaviorFunction

SERVER_LIMIT = rospy.Duration(20)
DEFAULT_LIMIT = 600.0
END_LIMIT = rospy.Duration(10)


def print_step(feedback: NaoBehaviorFeedback) -> None:
    """What happens to a step, in a line."""
    if feedback.behavior:
        print(f"{feedback.time:7.2f} s  {feedback.path:8} {feedback.what:32} {feedback.state} {feedback.text}".rstrip())


def main() -> int:
    """Run it; the exit status tells whether it worked."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("name", nargs="?", help="of the behaviour")
    parser.add_argument("parameters", nargs="*", metavar="NAME=VALUE", help="values of its parameters")
    parser.add_argument("--limit", type=float, default=DEFAULT_LIMIT, help="s that it may take (default: %(default)g)")
    options = parser.parse_args(rospy.myargv()[1:])
    rospy.init_node("run_behavior", anonymous=True)
    rospy.sleep(0.0)  # simulated time begins at zero and jumps with the first message of /clock
    behaviors = SimpleActionClient("NaoBehavior", NaoBehaviorAction)
    if not behaviors.wait_for_server(SERVER_LIMIT):
        print("there is no server NaoBehavior: start one with roslaunch nao_library nao_sim.launch")
        return 1
    function = BehaviorFunction(function="listBehaviors")
    if options.name:
        function = BehaviorFunction(function="runBehavior", str_param=options.name, parameters=options.parameters)
    # What ends this program ends the behaviour as well.
    rospy.on_shutdown(lambda: (behaviors.cancel_goal(), behaviors.wait_for_result(END_LIMIT)))
    behaviors.send_goal(NaoBehaviorGoal([function]), feedback_cb=print_step)
    if not behaviors.wait_for_result(rospy.Duration.from_sec(options.limit)):
        print(f"no result within {options.limit:g} s: it is ended")
        return 1
    for info in behaviors.get_result().behaviors:
        print(f"{info.name:20} {info.problem or info.help}")
    state = behaviors.get_state()
    if options.name:
        print(f"{options.name}: {GoalStatus.to_string(state).lower()} {behaviors.get_goal_status_text()}".rstrip())
    return 0 if state == GoalStatus.SUCCEEDED else 1


if __name__ == "__main__":
    sys.exit(main())
