#!/usr/bin/env python3
"""Records what both cameras see while the robot walks: `record_while_walking.py --distance 0.5 --name walk`.

The videos are in the folder of the server NaoVision, on the computer that it runs on. Ctrl-C ends the walk, and the
videos are good.

Needs running servers, for example `roslaunch nao_library nao_sim.launch`.
"""

from __future__ import annotations

import argparse
import sys
from typing import Any

import rospy
from actionlib import SimpleActionClient
from actionlib_msgs.msg import GoalStatus

from nao_library_actions.msg import NaoMotionAction, NaoMotionGoal, NaoVisionAction, NaoVisionGoal
from nao_library_msgs.msg import MotionFunction, VisionFunction

LIMIT = rospy.Duration(30)
WALK_LIMIT = rospy.Duration(180)
CAMERAS = ("top", "bottom")


def recording(camera: str) -> str:
    """Id of a camera's recording: two of these programs must not end each other's."""
    return f"walk_{camera}_{rospy.get_name().strip('/')}"


def start(name: str, overwrite: bool) -> NaoVisionGoal:
    """Begin to record both cameras; without a name the files are called after the time."""
    return NaoVisionGoal(
        [
            VisionFunction(
                function="startRecording",
                id=recording(camera),
                camera=camera,
                str_param=f"{name}_{camera}.mp4" if name else "",
                overwrite=overwrite,
            )
            for camera in CAMERAS
        ]
    )


def stop() -> NaoVisionGoal:
    """Complete both videos."""
    return NaoVisionGoal([VisionFunction(function="deleteThread", id=recording(camera)) for camera in CAMERAS])


def walk(distance: float) -> NaoMotionGoal:
    """Stand up and walk ahead, m."""
    stand = MotionFunction(function="goToPosture", str_param="Stand")
    return NaoMotionGoal([stand, MotionFunction(function="moveTo", values=[distance, 0.0, 0.0])])


def play(client: Any, goal: Any, limit: rospy.Duration) -> bool:
    """Play a goal to its end; tells whether all of it was done, and prints what was not."""
    client.send_goal(goal)
    try:
        ended = client.wait_for_result(limit)
    except KeyboardInterrupt:
        print("interrupted")
        ended = False
    if not ended:
        client.cancel_goal()
        client.wait_for_result(LIMIT)
    if client.get_state() != GoalStatus.SUCCEEDED:
        print(client.get_goal_status_text() or f"not done within {limit.to_sec():g} s")
        return False
    return True


def main() -> int:
    """Walk and record; the exit status tells whether all of it was done."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--distance", type=float, default=0.4, help="how far to walk, m (default: 0.4)")
    parser.add_argument("--name", default="", help="what the names of the files begin with (default: the time)")
    parser.add_argument("--overwrite", action="store_true", help="replace files of these names")
    options = parser.parse_args(rospy.myargv()[1:])
    # Ctrl-C leaves time to complete the videos.
    rospy.init_node("record_while_walking", anonymous=True, disable_signals=True)
    rospy.sleep(0.0)  # simulated time begins at zero and jumps with the first message of /clock
    vision = SimpleActionClient("NaoVision", NaoVisionAction)
    motion = SimpleActionClient("NaoMotion", NaoMotionAction)
    for name, client in (("NaoVision", vision), ("NaoMotion", motion)):
        if not client.wait_for_server(LIMIT):
            print(f"there is no server {name}: start one with roslaunch nao_library nao_sim.launch")
            return 1
    done = play(vision, start(options.name, options.overwrite), LIMIT)
    if done:
        done = play(motion, walk(options.distance), WALK_LIMIT)
        done = play(vision, stop(), LIMIT) and done
        for video in vision.get_result().recordings:
            size = f"{video.width} x {video.height}"
            print(
                f"{video.path}: {video.duration:.1f} s, {video.frames} frames of {size} pixels {video.error}".rstrip()
            )
    return 0 if done else 1


if __name__ == "__main__":
    sys.exit(main())
