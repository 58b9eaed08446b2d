#!/usr/bin/env python3
"""The robot is late, dies in the middle of what it does, and comes back: the cases are in lost_robot_cases.py."""

import sys
from pathlib import Path

import rospy
import rostest

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))  # not beside its relay
from mortal_simulator import MortalSimulator  # noqa: E402

if __name__ == "__main__":
    rospy.init_node("lost_robot_test")
    try:
        rostest.rosrun("nao_library_tests", "lost_robot", "lost_robot_cases.suite")
    finally:
        MortalSimulator.kill()
