#!/usr/bin/env python3
"""Greets who stands before the robot by name: `greet_face.py`; `greet_face.py --learn Anna` learns a new face first.

The robot turns its head until it sees a face. A face that it knows it greets by name; another one it learns if it is
told whose it is.

Needs running servers, for example `roslaunch nao_library nao_sim.launch`.
"""

from __future__ import annotations

import argparse
import sys
from typing import Any

import rospy
from actionlib import SimpleActionClient
from actionlib_msgs.msg import GoalStatus

from nao_library_actions.msg import NaoAudioOutAction, NaoAudioOutGoal, NaoVisionAction, NaoVisionGoal
from nao_library_msgs.msg import AudioOutFunction, SeenObject, VisionFunction

LIMIT = rospy.Duration(60)
LOOKS = 5
"""So many pictures tell who it is: one may be a bad one."""


class Host:
    """A robot that greets people."""

    def __init__(self) -> None:
        """Find the servers."""
        self._vision = SimpleActionClient("NaoVision", NaoVisionAction)
        self._voice = SimpleActionClient("nao_audio_out", NaoAudioOutAction)
        for name, client in (("NaoVision", self._vision), ("nao_audio_out", self._voice)):
            if not client.wait_for_server(LIMIT):
                raise RuntimeError(f"there is no server {name}: start one with roslaunch nao_library nao_sim.launch")

    def face(self, timeout: float) -> SeenObject | None:
        """Look for a face; None if there is none.

        Args:
            timeout: s.
        """
        objects = self._see(function="lookFor", str_param="face", count=LOOKS, timeout=timeout).objects
        return objects[0] if objects else None

    def learn(self, name: str) -> bool:
        """Learn the face that the robot looks at; tells whether it could."""
        return self._see(function="learnFace", str_param=name).memList == ["True"]

    def say(self, text: str) -> None:
        """Say something."""
        print(f"robot: {text}")
        self._play(self._voice, NaoAudioOutGoal([AudioOutFunction(function="say", str_param=text)]))

    def _see(self, **fields: Any) -> Any:
        return self._play(self._vision, NaoVisionGoal([VisionFunction(**fields)]))

    @staticmethod
    def _play(client: Any, goal: Any) -> Any:
        client.send_goal(goal)
        if not client.wait_for_result(LIMIT):
            client.cancel_goal()
            raise RuntimeError(f"not done within {LIMIT.to_sec():g} s")
        if client.get_state() != GoalStatus.SUCCEEDED:
            raise RuntimeError(client.get_goal_status_text())
        return client.get_result()


def greet(host: Host, name: str, timeout: float) -> bool:
    """Greet whoever is there; tells whether somebody was, and has a name now.

    Args:
        host: The robot.
        name: Whose face it is, if it is a new one; empty: that is not told.
        timeout: How long to look for a face, s.
    """
    face = host.face(timeout)
    if face is None:
        host.say("Is anybody there?")
        return False
    if face.name:
        host.say(f"Hello, {face.name}!")
        return True
    if not name:
        host.say("Hello! I do not know you yet.")
        return False
    if not host.learn(name):
        host.say("I cannot see you well enough.")
        return False
    host.say(f"Nice to meet you, {name}!")
    return True


def main() -> int:
    """Greet; the exit status tells whether somebody was greeted by name."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--learn", metavar="NAME", default="", help="whose face it is, if the robot does not know it")
    parser.add_argument("--timeout", type=float, default=20.0, help="s to look for a face (default: 20)")
    options = parser.parse_args(rospy.myargv()[1:])
    rospy.init_node("greet_face", anonymous=True)
    rospy.sleep(0.0)  # simulated time begins at zero and jumps with the first message of /clock
    try:
        return 0 if greet(Host(), options.learn, options.timeout) else 1
    except RuntimeError as error:
        print(error)
        return 1


if __name__ == "__main__":
    sys.exit(main())
