#!/usr/bin/env python3
"""Talks to the light server: half intensity on the head, green eyes, green eyes that go back by themselves.

Needs a running server, for example `roslaunch nao_library nao_sim.launch`.
"""

from __future__ import annotations

import sys

import rospy
from actionlib import SimpleActionClient
from actionlib_msgs.msg import GoalStatus

from nao_library_actions.msg import NaoLedAction, NaoLedGoal
from nao_library_msgs.msg import LedFunction

EYES = ["LeftFaceLeds", "RightFaceLeds"]
SERVER_LIMIT = rospy.Duration(10)
GOAL_LIMIT = rospy.Duration(20)


def goals() -> list[tuple[str, NaoLedGoal]]:
    """Goals to play, each with a title. A goal is a chain: it may hold any number of functions."""
    brain_half = LedFunction(function="setIntensity", lights=["Brain0"], i_values=[0.5])
    green_eyes = LedFunction(function="setColor", lights=EYES, i_values=[0, 1, 0])
    green_for_two_seconds = LedFunction(
        function="setColor", lights=EYES, i_values=[0, 1, 0], time=rospy.Duration(2), revert=True
    )
    eyes_off = LedFunction(function="off", lights=EYES)
    return [
        ("one light at half intensity", NaoLedGoal([brain_half])),
        ("both eyes green", NaoLedGoal([green_eyes])),
        ("eyes off, green for two seconds, off again", NaoLedGoal([eyes_off, green_for_two_seconds])),
    ]


def table(result: object) -> str:
    """The lights of a result and their intensities, one a line."""
    width = max((len(light) for light in result.lights), default=0)
    rows = zip(result.lights, result.intensities)
    return "\n".join(f"    {light:<{width}}  {intensity:.2f}" for light, intensity in rows)


def main() -> int:
    """Play the goals one after the other; the exit status tells whether all succeeded."""
    rospy.init_node("lights_client", anonymous=True)
    # Simulated time begins at zero and jumps with the first message of /clock; limits would be over at once.
    rospy.sleep(0.0)
    client = SimpleActionClient("NaoLights", NaoLedAction)
    if not client.wait_for_server(SERVER_LIMIT):
        print("there is no server NaoLights: start one with roslaunch nao_library nao_sim.launch")
        return 1
    failures = 0
    for title, goal in goals():
        client.send_goal(goal)
        if not client.wait_for_result(GOAL_LIMIT):
            client.cancel_goal()
            print(f"{title}: no result within {GOAL_LIMIT.to_sec():g} s")
            failures += 1
            continue
        state = client.get_state()
        print(f"{title}: {GoalStatus.to_string(state).lower()} {client.get_goal_status_text()}".rstrip())
        print(table(client.get_result()))
        failures += state != GoalStatus.SUCCEEDED
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
