#!/usr/bin/env python3
"""Walks a bow and turns round, as a program for the robot maker's SDK does: no ROS, only ALProxy.

Needs a robot or a simulator at `--ip` and `--port`, for example `python3 -m nao_sim_bridge`. Ctrl-C stops the robot.
"""

from __future__ import annotations

import argparse
import math
import sys

from naoqi import ALProxy
from naoqi.errors import NaoError

SLOWLY = [["MaxStepX", 0.03], ["StepHeight", 0.025]]


def bow(body: ALProxy, length: float) -> bool:
    """Walk a bow to the left and turn round, telling where the robot is on the way.

    Args:
        body: ALMotion of a robot that stands.
        length: Of the bow, m.

    Returns:
        Whether the robot got there.
    """
    start = body.getRobotPosition(True)
    walk = body.post.moveTo(length, length / 2.0, math.pi / 4.0, SLOWLY)
    while body.wait(walk, 1000):  # true as long as it still walks after this many ms
        x, y, turn = body.getRobotPosition(True)
        vx, vy, _ = body.getRobotVelocity()
        print(f"x {x:5.2f} m, y {y:5.2f} m, {turn:5.2f} rad, {math.hypot(vx, vy):.2f} m/s", flush=True)
    reached = body.moveTo(0.0, 0.0, math.pi)
    there = body.getRobotPosition(True)
    print(f"walked {math.dist(start[:2], there[:2]):.2f} m, ends at x {there[0]:.2f} m, y {there[1]:.2f} m")
    return reached


def main() -> int:
    """Stand up, walk and rest; the exit status tells whether it went as planned."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--ip", default="127.0.0.1", help="address of the robot (127.0.0.1)")
    parser.add_argument("--port", type=int, default=9559, help="port of its NAOqi (9559)")
    parser.add_argument("--length", type=float, default=0.4, help="of the bow, m (0.4)")
    options = parser.parse_args()
    try:
        body = ALProxy("ALMotion", options.ip, options.port)
        body.wakeUp()
        body.moveInit()
        try:
            reached = bow(body, options.length)
        finally:
            body.stopMove()
            body.rest()
    except NaoError as error:
        print(error)
        return 1
    except KeyboardInterrupt:
        return 130
    return 0 if reached else 1


if __name__ == "__main__":
    sys.exit(main())
