#!/usr/bin/env python3
"""Records what the robot hears: `record_sound.py hello.wav --seconds 3`, or `--all` for all four microphones.

The file is on the robot, which replaces one of that name; that of a simulated one is in its record_dir, and
replaced with --overwrite only. Ctrl-C ends the recording, and the file is good.

Needs a running server, for example `roslaunch nao_library nao_sim.launch`.
"""

from __future__ import annotations

import argparse
import sys

import rospy
from actionlib import SimpleActionClient
from actionlib_msgs.msg import GoalStatus

from nao_library_actions.msg import NaoAudioInAction, NaoAudioInGoal
from nao_library_msgs.msg import AudioInFunction, RecordedFile

LIMIT = rospy.Duration(20)


def chain(name: str, seconds: float, everything: bool, overwrite: bool) -> list[AudioInFunction]:
    """How loud it is before, then the recording."""
    return [
        AudioInFunction(function="getEnergy"),
        AudioInFunction(
            function="record",
            str_param=name,
            duration=seconds,
            rate=48000 if everything else 16000,
            overwrite=overwrite,
        ),
    ]


def where(file: RecordedFile) -> str:
    """The whole path of a recording."""
    return file.file or f"{file.path}, on the robot"


def main() -> int:
    """Record; the exit status tells whether all of it was recorded."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("name", help="the file, .wav or .ogg")
    parser.add_argument("--seconds", type=float, default=5.0, help="how long (default: 5)")
    parser.add_argument("--all", action="store_true", help="all four microphones, not the front ones only")
    parser.add_argument("--overwrite", action="store_true", help="replace a file of that name")
    options = parser.parse_args(rospy.myargv()[1:])
    rospy.init_node("record_sound", anonymous=True, disable_signals=True)  # Ctrl-C leaves time to end the recording
    rospy.sleep(0.0)  # simulated time begins at zero and jumps with the first message of /clock
    ears = SimpleActionClient("nao_audio_in", NaoAudioInAction)
    if not ears.wait_for_server(LIMIT):
        print("there is no server nao_audio_in: start one with roslaunch nao_library nao_sim.launch")
        return 1
    ears.send_goal(NaoAudioInGoal(chain(options.name, options.seconds, options.all, options.overwrite)))
    try:
        ended = ears.wait_for_result(rospy.Duration.from_sec(options.seconds) + LIMIT)
    except KeyboardInterrupt:
        ended = False
    if not ended:
        # Whatever this side knows of the goal: the robot may record already. The result comes when the file is closed.
        ears.cancel_goal()
        ears.wait_for_result(LIMIT)
    state = ears.get_state()
    print(f"{options.name}: {GoalStatus.to_string(state).lower()} {ears.get_goal_status_text()}".rstrip())
    result = ears.get_result()
    for name, energy in zip(result.microphones, result.energies) if result else ():
        print(f"    {name:<5} {energy:8.1f} before")
    for file in result.files if result else ():
        print(f"    {where(file)}: {file.duration:.1f} s, {file.rate} Hz, {', '.join(file.channels)}")
    return 0 if state == GoalStatus.SUCCEEDED else 1


if __name__ == "__main__":
    sys.exit(main())
