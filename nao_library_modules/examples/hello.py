#!/usr/bin/env python3
"""The shortest client that speaks: says "Hello, world!", or the words that it is given, and ends when that is said."""

import argparse
import sys

import rospy
from actionlib_msgs.msg import GoalStatus

from nao_library_actions.msg import NaoAudioOutAction, NaoAudioOutGoal
from nao_library_modules.simple_action_client import SimpleActionClient
from nao_library_msgs.msg import AudioOutFunction


def main() -> int:
    """Say it; the exit status tells whether it was said."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("words", nargs="*", default=["Hello,", "world!"], help="what to say")
    words = parser.parse_args(rospy.myargv()[1:]).words
    rospy.init_node("hello", anonymous=True)
    audio = SimpleActionClient("nao_audio_out", NaoAudioOutAction)
    audio.wait_for_server()
    rospy.on_shutdown(lambda: audio.get_state() in (GoalStatus.PENDING, GoalStatus.ACTIVE) and audio.cancel_goal())
    hello = AudioOutFunction(function="say", str_param=" ".join(words))
    state = audio.send_goal_and_wait(NaoAudioOutGoal([hello]))
    print(audio.get_goal_status_text() or "said")
    return 0 if state == GoalStatus.SUCCEEDED else 1


if __name__ == "__main__":
    sys.exit(main())
