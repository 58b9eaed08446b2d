#!/usr/bin/env python3
"""Prints one joint of a bag of joint states as CSV, s of ROS time and rad: `joint_table.py wave.bag RShoulderPitch`."""

import csv
import sys

import rosbag


def main(place: str, joint: str) -> None:
    """Print the table. `place`: of the bag. `joint`: its name."""
    rows = csv.writer(sys.stdout)
    rows.writerow(["time", joint])
    with rosbag.Bag(place) as bag:
        for _topic, message, _time in bag.read_messages("/joint_states"):
            rows.writerow([f"{message.header.stamp.to_sec():.3f}", message.position[message.name.index(joint)]])


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit("usage: joint_table.py BAG JOINT")
    main(*sys.argv[1:])
