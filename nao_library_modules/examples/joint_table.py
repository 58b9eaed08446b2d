#!/usr/bin/env python3
"""Prints one joint of a bag of joint states as CSV, s of ROS time and rad: `joint_table.py wave.bag RShoulderPitch`."""

import csv
import sys
from pathlib import Path

from sensor_msgs.msg import JointState

from nao_library_modules.ros.bag_types import read_bag


def main(place: str, joint: str) -> None:
    """Print the table. `place`: of the bag. `joint`: its name."""
    rows = csv.writer(sys.stdout)
    rows.writerow(["time", joint])
    for _, message in read_bag(Path(place), "/joint_states", JointState):
        rows.writerow([f"{message.header.stamp.to_sec():.3f}", message.position[message.name.index(joint)]])


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit("usage: joint_table.py BAG JOINT")
    main(*sys.argv[1:])
