#!/usr/bin/env python3
"""Asks a question, listens, answers, and nods or shakes its head: `dialogue.py --question "Shall we play?"`.

Without an answer, or with one that it is not sure of, it asks again.

Needs running servers, for example `roslaunch nao_library nao_sim.launch`.
"""

from __future__ import annotations

import argparse
import sys
from typing import Any

import actionlib
import rospy
from actionlib_msgs.msg import GoalStatus

import nao_library_actions.msg as actions
from nao_library_msgs.msg import AudioInFunction, AudioOutFunction, MotionFunction

LIMIT = rospy.Duration(60)
ANSWERS = {
    "yes": ("Great!", "HeadPitch", 0.3),
    "no": ("What a pity.", "HeadYaw", 0.4),
}
"""What is understood -> what the robot says to it, and how its head moves: joint, rad."""


class Servers:
    """The servers that the dialogue needs."""

    def __init__(self) -> None:
        """Find them."""
        self._clients = {
            name: actionlib.SimpleActionClient(name, getattr(actions, f"{action}Action"))
            for name, action in (("nao_audio_out", "NaoAudioOut"), ("nao_audio_in", "NaoAudioIn"), ("NaoMotion",) * 2)
        }
        for name, client in self._clients.items():
            if not client.wait_for_server(LIMIT):
                raise RuntimeError(f"there is no server {name}: start one with roslaunch nao_library nao_sim.launch")

    def play(self, name: str, goal: Any) -> Any:
        """Play a goal to its end; its result."""
        client = self._clients[name]
        if client.send_goal_and_wait(goal, LIMIT) != GoalStatus.SUCCEEDED:
            raise RuntimeError(client.get_goal_status_text() or f"no result of {name}")
        return client.get_result()


def say(text: str) -> actions.NaoAudioOutGoal:
    """Say something."""
    print(f"robot: {text}")
    return actions.NaoAudioOutGoal([AudioOutFunction(function="say", str_param=text)])


def listen(timeout: float) -> actions.NaoAudioInGoal:
    """Wait for an answer."""
    function = AudioInFunction(function="listen", vocabulary=list(ANSWERS), confidence=0.3, timeout=timeout)
    return actions.NaoAudioInGoal([function])


def move_head(joint: str, angle: float) -> actions.NaoMotionGoal:
    """Nod, or shake the head."""
    turn = MotionFunction(function="angleInterpolation", names=[joint], stiffness=1.0)
    turn.angles, turn.times = [angle, -angle, angle, 0.0], [0.4, 0.8, 1.2, 1.6]
    return actions.NaoMotionGoal([turn])


def main() -> int:
    """Have the dialogue; the exit status tells whether there was an answer."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--question", default="Shall we play?", help="a question to be answered with yes or no")
    parser.add_argument("--timeout", type=float, default=8.0, help="s to wait for an answer (default: 8)")
    parser.add_argument("--times", type=int, default=3, help="how often to ask (default: 3)")
    options = parser.parse_args(rospy.myargv()[1:])
    rospy.init_node("dialogue", anonymous=True)
    rospy.sleep(0.0)  # simulated time begins at zero and jumps with the first message of /clock
    try:
        servers = Servers()
        for _ in range(options.times):
            servers.play("nao_audio_out", say(options.question))
            heard = servers.play("nao_audio_in", listen(options.timeout))
            if heard.words:
                break
        else:
            servers.play("nao_audio_out", say("I did not hear you."))
            return 1
        print(f"heard: {heard.words[0]} ({heard.confidences[0]:.2f})")
        answer, joint, angle = ANSWERS[heard.words[0]]
        servers.play("nao_audio_out", say(answer))
        servers.play("NaoMotion", move_head(joint, angle))
    except RuntimeError as error:
        print(error)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
