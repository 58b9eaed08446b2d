#!/usr/bin/env python3
"""Looks for a red ball, walks to it, and looks down at it: `find_ball.py --radius 0.05` in the world lab.

The robot turns its head, then itself, until it sees the ball; on the way it looks again, for steps slip.

Needs running servers, for example `roslaunch nao_library nao_sim.launch world:=lab`. Ctrl-C ends it on both feet.
"""

from __future__ import annotations

import argparse
import math
import sys
from typing import Any

import rospy
from actionlib import SimpleActionClient
from actionlib_msgs.msg import GoalStatus

from nao_library_actions.msg import NaoMotionAction, NaoMotionGoal, NaoVisionAction, NaoVisionGoal
from nao_library_msgs.msg import MotionFunction, SeenObject, VisionFunction

LIMIT = rospy.Duration(120)
NEAR = 0.30
"""m from the middle between the feet to the ball: there."""
STOP = 0.22
"""m from the ball where the robot means to stand: its feet reach 0.1 m ahead."""
SEEN_BELOW = 0.7
"""m: a ball that is nearer is in the picture of the lower camera."""
LONGEST = 0.8
"""m that it walks before it looks again."""
TURN = math.radians(120)
"""The head looks over 230 degrees: three turns of the robot show everything twice."""
MOST_WALKS = 10


def way_to(x: float, y: float) -> tuple[float, float, float]:
    """Way towards a place, up to `STOP` before it, with the robot looking there: x, y in m and a turn in rad."""
    distance, turn = math.hypot(x, y), math.atan2(y, x)
    length = min(max(distance - STOP, 0.0), LONGEST)
    return length * math.cos(turn), length * math.sin(turn), turn


class Finder:
    """A robot that goes to balls."""

    def __init__(self, radius: float) -> None:
        """Find the servers.

        Args:
            radius: Of the ball, m: how large it is seen tells how far away it is.
        """
        self._radius = radius
        self._vision = SimpleActionClient("NaoVision", NaoVisionAction)
        self._motion = SimpleActionClient("NaoMotion", NaoMotionAction)
        for name, client in (("NaoVision", self._vision), ("NaoMotion", self._motion)):
            if not client.wait_for_server(LIMIT):
                raise RuntimeError(f"there is no server {name}: start one with roslaunch nao_library nao_sim.launch")
        rospy.on_shutdown(self.stop)

    def stop(self) -> None:
        """End what the robot does."""
        for client in (self._vision, self._motion):
            if client.get_state() in (GoalStatus.PENDING, GoalStatus.ACTIVE):
                client.cancel_goal()

    def find(self) -> SeenObject | None:
        """The ball and where it is in the end; None if it is not found."""
        self._move(MotionFunction(function="goToPosture", str_param="Stand"))
        ball, turns = self._look(), 0
        for _ in range(MOST_WALKS):
            if ball is None:
                turns += 1
                if turns > 3:
                    return None
                print("no ball: the robot turns round")
                self._move(MotionFunction(function="moveTo", values=[0.0, 0.0, TURN]))
                ball = self._look()
                continue
            x, y = ball.position.x, ball.position.y
            turn = math.degrees(math.atan2(y, x))
            side = "left" if turn >= 0.0 else "right"
            print(f"the ball is {math.hypot(x, y):.2f} m away, {abs(turn):.0f} degrees to the {side}")
            if math.hypot(x, y) <= NEAR and ball.camera == "bottom":
                return ball
            if math.hypot(x, y) > NEAR:
                self._move(MotionFunction(function="moveTo", values=list(way_to(x, y))))
            # As far as steps are exact, this is where it is now.
            ball = self._look(near=math.hypot(x, y) - LONGEST < SEEN_BELOW)
        return None

    def _look(self, near: bool = False) -> SeenObject | None:
        """The ball, if one camera or the other sees it; that is tried first which sees what is near, or what is far."""
        for camera in ("bottom", "top") if near else ("top", "bottom"):
            look = VisionFunction(function="lookFor", str_param="ball", camera=camera, count=5, size=self._radius)
            result = self._play(self._vision, NaoVisionGoal([look]))
            if result.objects:
                return result.objects[0]
        return None

    def _move(self, function: MotionFunction) -> None:
        self._play(self._motion, NaoMotionGoal([function]))

    @staticmethod
    def _play(client: Any, goal: Any) -> Any:
        client.send_goal(goal)
        if not client.wait_for_result(LIMIT):
            client.cancel_goal()
            raise RuntimeError(f"not done within {LIMIT.to_sec():g} s")
        if client.get_state() != GoalStatus.SUCCEEDED:
            raise RuntimeError(client.get_goal_status_text())
        return client.get_result()


def main() -> int:
    """Find it; the exit status tells whether the robot stands before it."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--radius", type=float, default=0.03, help="of the ball, m (default: 0.03; in the lab 0.05)")
    options = parser.parse_args(rospy.myargv()[1:])
    rospy.init_node("find_ball", anonymous=True)
    rospy.sleep(0.0)  # simulated time begins at zero and jumps with the first message of /clock
    try:
        ball = Finder(options.radius).find()
    except RuntimeError as error:
        print(error)
        return 1
    if ball is None:
        print("there is no ball to be found")
        return 1
    print(f"the ball is in front of the robot, in the picture of the {ball.camera} camera")
    return 0


if __name__ == "__main__":
    sys.exit(main())
