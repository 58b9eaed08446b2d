#!/usr/bin/env python3
"""The shortest client that speaks: says "Hello, world!", or the words that it is given, and ends when that is said."""

import argparse
import sys

import rospy
from actionlib import SimpleActionClient
from actionlib_msgs.msg import GoalStatus

from nao_library_actions.msg import NaoAudioOutAction, NaoAudioOutGoal
from nao_library_msgs.msg import AudioOutFunction

LIMIT = rospy.Duration(60)


def main() -> int:
    """Say it; the exit status tells whether it was said."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("words", nargs="*", default=["Hello,", "world!"], help="what to say")
    words = parser.parse_args(rospy.myargv()[1:]).words
    rospy.init_node("hello", anonymous=True)
    rospy.sleep(0.0)  # simulated time begins at zero and jumps with the first message of /clock
    audio = SimpleActionClient("nao_audio_out", NaoAudioOutAction)
    if not audio.wait_for_server(LIMIT):
        print("there is no server nao_audio_out: start one with roslaunch nao_library nao_sim.launch")
        return 1
    rospy.on_shutdown(lambda: audio.get_state() in (GoalStatus.PENDING, GoalStatus.ACTIVE) and audio.cancel_goal())
    hello = AudioOutFunction(function="say", str_param=" ".join(words))
    audio.send_goal(NaoAudioOutGoal([hello]))
    if not audio.wait_for_result(LIMIT):
        audio.cancel_goal()
        print(f"no result within {LIMIT.to_sec():g} s")
        return 1
    print(audio.get_goal_status_text() or "said")
    return 0 if audio.get_state() == GoalStatus.SUCCEEDED else 1


if __name__ == "__main__":
    sys.exit(main())
