#!/usr/bin/env python3
"""Turns the head to where a sound comes from, again and again: `turn_to_sound.py --times 3`.

Needs running servers, for example `roslaunch nao_library nao_sim.launch`.
"""

from __future__ import annotations

import argparse
import math
import sys

import rospy
from actionlib import SimpleActionClient
from actionlib_msgs.msg import GoalStatus

from nao_library_actions.msg import NaoAudioInAction, NaoAudioInGoal, NaoMotionAction, NaoMotionGoal
from nao_library_msgs.msg import AudioInFunction, HeardSound, MotionFunction

LIMIT = rospy.Duration(20)
DISTANCE = 2.0
"""m: how far the sound is nobody can tell from one place, so the robot looks at a point so far away."""
FRAME_ROBOT = 2


def look_there(sound: HeardSound) -> MotionFunction:
    """The motion that turns the camera to a sound."""
    flat = DISTANCE * math.cos(sound.base_elevation)
    point = [
        sound.head.x + flat * math.cos(sound.base_azimuth),
        sound.head.y + flat * math.sin(sound.base_azimuth),
        sound.head.z + DISTANCE * math.sin(sound.base_elevation),
    ]
    return MotionFunction(function="lookAt", values=point, frame=FRAME_ROBOT, stiffness=1.0)


def main() -> int:
    """Listen and look; the exit status tells whether there was a sound each time."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--times", type=int, default=1, help="how many sounds to turn to (default: 1)")
    parser.add_argument("--timeout", type=float, default=10.0, help="s to wait for each (default: 10)")
    parser.add_argument("--confidence", type=float, default=0.3, help="least confidence that counts (default: 0.3)")
    options = parser.parse_args(rospy.myargv()[1:])
    rospy.init_node("turn_to_sound", anonymous=True)
    rospy.sleep(0.0)  # simulated time begins at zero and jumps with the first message of /clock
    ears = SimpleActionClient("nao_audio_in", NaoAudioInAction)
    motion = SimpleActionClient("NaoMotion", NaoMotionAction)
    for name, client in (("nao_audio_in", ears), ("NaoMotion", motion)):
        if not client.wait_for_server(LIMIT):
            print(f"there is no server {name}: start one with roslaunch nao_library nao_sim.launch")
            return 1
    localize = AudioInFunction(function="localizeSound", timeout=options.timeout, confidence=options.confidence)
    for _ in range(options.times):
        ears.send_goal(NaoAudioInGoal([localize]))
        if not ears.wait_for_result(rospy.Duration.from_sec(options.timeout) + LIMIT):
            ears.cancel_goal()
            print(f"no result of nao_audio_in within {options.timeout + LIMIT.to_sec():g} s")
            return 1
        result = ears.get_result()
        if ears.get_state() != GoalStatus.SUCCEEDED or not result.sounds:
            print(ears.get_goal_status_text() or f"no sound within {options.timeout:g} s")
            return 1
        sound = result.sounds[0]
        print(f"a sound at {math.degrees(sound.base_azimuth):.0f} degrees, confidence {sound.confidence:.2f}")
        motion.send_goal(NaoMotionGoal([look_there(sound)]))
        if not motion.wait_for_result(LIMIT):
            motion.cancel_goal()
            print(f"no result of NaoMotion within {LIMIT.to_sec():g} s")
            return 1
        if motion.get_state() != GoalStatus.SUCCEEDED:
            print(motion.get_goal_status_text())
            return 1
        *_, missing = map(float, motion.get_result().memList)
        if missing > 0.2:
            print(f"    the head does not turn so far: {math.degrees(missing):.0f} degrees are missing")
    return 0


if __name__ == "__main__":
    sys.exit(main())
