#!/usr/bin/env python3
"""Sings to itself and talks over it: one goal, in which a file of its own making sounds in the background.

Prints each word as it is spoken. Needs a running server, for example `roslaunch nao_library nao_sim.launch`. Ctrl-C
silences the robot.
"""

from __future__ import annotations

import argparse
import sys

import rospy
from actionlib import SimpleActionClient
from actionlib_msgs.msg import GoalStatus

from nao_library_actions.msg import NaoAudioOutAction, NaoAudioOutFeedback, NaoAudioOutGoal
from nao_library_msgs.msg import AudioOutFunction

LIMIT = rospy.Duration(20)
GOAL_LIMIT = rospy.Duration(120)
FILE = "sing_and_talk_refrain.wav"
# Pitch in % of the voice's own, and the syllable: NAOqi's tag for pitch makes a tune of them.
TUNE = ((100, "la"), (112, "la"), (126, "la"), (100, "la"), (126, "lee"), (134, "lee"), (150, "loo"))
TEXT = "I sing while I work. Nobody else does. Now it is quiet."


def chain(text: str) -> list[AudioOutFunction]:
    """The functions: a refrain is written to a file and sounds quietly, again and again, while the robot talks."""
    song = " ".join(rf"\vct={pitch}\ {syllable}" for pitch, syllable in TUNE)
    return [
        # The file is the example's own: what it replaces is that of the run before.
        AudioOutFunction(function="sayToFile", str_param=song, file_name=FILE, overwrite=True, speed=80),
        AudioOutFunction(function="playFileInLoop", str_param=FILE, volume=0.25),
        AudioOutFunction(function="say", str_param=text, time=rospy.Duration(1)),
        AudioOutFunction(function="stopAll"),
    ]


def show(feedback: NaoAudioOutFeedback) -> None:
    """Print a word as it is spoken."""
    if feedback.word:
        print(feedback.word, end=" ", flush=True)


def main() -> int:
    """Sing and talk; the exit status tells whether all of it was done."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("text", nargs="?", default=TEXT, help="what to say meanwhile")
    text = parser.parse_args(rospy.myargv()[1:]).text
    rospy.init_node("sing_and_talk", anonymous=True)
    rospy.sleep(0.0)  # simulated time begins at zero and jumps with the first message of /clock
    audio = SimpleActionClient("nao_audio_out", NaoAudioOutAction)
    if not audio.wait_for_server(LIMIT):
        print("there is no server nao_audio_out: start one with roslaunch nao_library nao_sim.launch")
        return 1
    rospy.on_shutdown(lambda: audio.get_state() in (GoalStatus.PENDING, GoalStatus.ACTIVE) and audio.cancel_goal())
    audio.send_goal(NaoAudioOutGoal(chain(text)), feedback_cb=show)
    if not audio.wait_for_result(GOAL_LIMIT):
        audio.cancel_goal()
        print(f"\nno result within {GOAL_LIMIT.to_sec():g} s")
        return 1
    state, result = audio.get_state(), audio.get_result()
    print(f"\n{audio.get_goal_status_text()}".rstrip())
    for file, duration in zip(result.files, result.durations) if result else ():  # none when it was interrupted
        if duration:
            print(f"{file}: {duration:.1f} s")
    return 0 if state == GoalStatus.SUCCEEDED else 1


if __name__ == "__main__":
    sys.exit(main())
