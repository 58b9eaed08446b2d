#!/usr/bin/env python3
"""Has the robot run a behaviour when it is touched: `react_to_touch.py --sensor head --behavior hello text=Hi`.

Prints what became of the touches until Ctrl-C, or until the behaviour has run `--times` times. Then touching starts it
no more.

Needs a running server, for example `roslaunch nao_library nao_sim.launch`. A simulated robot is touched with
`rosservice call /nao_sim/press "[Head/Touch/Front]"`, and let go with `rosservice call /nao_sim/press "[]"`.
"""

from __future__ import annotations

import argparse
import sys

import rospy
from actionlib import SimpleActionClient
from actionlib_msgs.msg import GoalStatus

from nao_library_actions.msg import NaoTactileAction, NaoTactileGoal, NaoTactileResult
from nao_library_msgs.msg import TactileFunction

LIMIT = rospy.Duration(30)
LINK = "react_to_touch"
PERIOD = 0.5
"""s between two looks at what became of the touches."""


class Refused(Exception):
    """The server did not do what it was asked for; the text says why."""


def feel(client: SimpleActionClient, **fields: object) -> NaoTactileResult:
    """Have the server carry out one function.

    Raises:
        Refused: It did not.
    """
    client.send_goal(NaoTactileGoal([TactileFunction(**fields)]))
    if not client.wait_for_result(LIMIT):
        client.cancel_goal()
        raise Refused(f"no answer within {LIMIT.to_sec():g} s")
    if client.get_state() != GoalStatus.SUCCEEDED:
        raise Refused(client.get_goal_status_text())
    return client.get_result()


def follow(client: SimpleActionClient, times: int) -> bool:
    """Print each start and end; returns whether the last one ended well, after so many (0: never)."""
    told = (0, False)
    while True:
        (link,) = (each for each in feel(client, function="listOnTouch").bindings if each.name == LINK)
        now = (link.runs, link.running)
        if now != told:
            print(
                f"{link.behavior} begins" if link.running else f"{link.behavior}: {link.last} {link.text}", flush=True
            )
        told = now
        if times and link.runs >= times and not link.running:
            return link.last == "succeeded"
        rospy.sleep(PERIOD)


def main() -> int:
    """Link touch and behaviour; the exit status tells whether that could be done and it ended well."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sensor", default="head", help="what is touched: head, 'left hand', bumpers, chest, ...")
    parser.add_argument("--touch", choices=("press", "release", "hold", "count"), default="press", help="in which way")
    parser.add_argument("--behavior", default="hello", help="the behaviour to run (default: hello)")
    parser.add_argument("--times", type=int, default=0, help="end after so many (default: with Ctrl-C)")
    parser.add_argument("parameters", nargs="*", metavar="name=value", help="parameters of the behaviour")
    options = parser.parse_args(rospy.myargv()[1:])
    # Ctrl-C ends the program, and not the node before it: the link is to be removed.
    rospy.init_node("react_to_touch", anonymous=True, disable_signals=True)
    rospy.sleep(0.0)  # simulated time begins at zero and jumps with the first message of /clock
    client = SimpleActionClient("NaoTactile", NaoTactileAction)
    if not client.wait_for_server(LIMIT):
        print("there is no server NaoTactile: start one with roslaunch nao_library nao_sim.launch")
        return 1
    try:
        feel(
            client,
            function="onTouch",
            str_param=LINK,
            sensors=[options.sensor],
            touch=options.touch,
            behavior=options.behavior,
            parameters=options.parameters,
        )
        print(f"waiting for a touch: {options.sensor}", flush=True)
        try:
            good = follow(client, options.times)
        finally:
            feel(client, function="removeOnTouch", str_param=LINK)
    except Refused as error:
        print(error)
        return 1
    except KeyboardInterrupt:
        return 0
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
