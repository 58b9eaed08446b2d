#!/usr/bin/env python3
"""Takes a picture with a camera of the robot: `take_picture.py me.png --camera bottom`.

The file is in the folder of the server, on the computer that it runs on; without a name it is called after the time.

Needs a running server, for example `roslaunch nao_library nao_sim.launch`.
"""

from __future__ import annotations

import argparse
import sys

import rospy
from actionlib import SimpleActionClient
from actionlib_msgs.msg import GoalStatus

from nao_library_actions.msg import NaoVisionAction, NaoVisionGoal
from nao_library_msgs.msg import VisionFunction

LIMIT = rospy.Duration(30)


def main() -> int:
    """Take it; the exit status tells whether there is one."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("name", nargs="?", default="", help="the file, .png or .jpg")
    parser.add_argument("--camera", choices=("top", "bottom"), default="top", help="which camera (default: top)")
    parser.add_argument("--overwrite", action="store_true", help="replace a file of this name")
    options = parser.parse_args(rospy.myargv()[1:])
    rospy.init_node("take_picture", anonymous=True)
    rospy.sleep(0.0)  # simulated time begins at zero and jumps with the first message of /clock
    vision = SimpleActionClient("NaoVision", NaoVisionAction)
    if not vision.wait_for_server(LIMIT):
        print("there is no server NaoVision: start one with roslaunch nao_library nao_sim.launch")
        return 1
    take = VisionFunction(
        function="takePicture", str_param=options.name, camera=options.camera, overwrite=options.overwrite
    )
    vision.send_goal(NaoVisionGoal([take]))
    if not vision.wait_for_result(LIMIT):
        vision.cancel_goal()
        print(f"no picture within {LIMIT.to_sec():g} s")
        return 1
    if vision.get_state() != GoalStatus.SUCCEEDED:
        print(vision.get_goal_status_text())
        return 1
    for picture in vision.get_result().pictures:
        print(f"{picture.path}: {picture.width} x {picture.height} pixels of {picture.topic}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
