"""Footsteps that the robot can make: a step that is too long is shortened, one that treads on a foot turned back.

Source: limits and boxes of the feet that ALMotion itself uses for its footsteps, as the robot's documentation of the
walk prints them.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from almath import Pose2D, Position2D, avoidFootCollision, clipFootWithEllipse
from naoqi.errors import NaoError

from ...base.errors import BadGoal
from ...base.places import Place
from .walk_commands import LEFT, RIGHT

MIN_X, MAX_X = -0.04, 0.08
MIN_Y, MAX_Y = 0.088, 0.16
"""m: from the middle of the standing foot to that of the other one, to its own side."""
MAX_TURN = 0.5
"""rad."""
LEFT_BOX = [Position2D(*corner) for corner in ((0.11, 0.05), (0.11, -0.038), (-0.047, -0.038), (-0.047, 0.05))]
RIGHT_BOX = [Position2D(corner.x, -corner.y) for corner in reversed(LEFT_BOX)]


def clip(step: Place, leg: str) -> Place:
    """The nearest step of its kind that the robot can make: place of the moving foot `leg` in the frame of the other.

    Raises:
        NaoError: If a number of the step is none, or the leg is unknown.
    """
    if leg not in (LEFT, RIGHT):
        raise NaoError(f"no leg {leg!r}: {LEFT} or {RIGHT}")
    for name, value in zip(("x", "y", "theta"), step):
        if not math.isfinite(value):
            raise BadGoal(f"pose.{name}", value, "a finite number")
    outwards = 1.0 if leg == LEFT else -1.0
    x = min(max(step.x, MIN_X), MAX_X)
    aside = min(max(step.y * outwards, MIN_Y), MAX_Y)
    turn = min(max(step.yaw, -MAX_TURN), MAX_TURN)
    # Of the ellipse, the middle is the place beside the standing foot: far ahead and far aside at once is too far.
    clipped = Pose2D(x, aside - MIN_Y, turn)
    clipFootWithEllipse(MAX_X if x >= 0.0 else MIN_X, MAX_Y - MIN_Y, clipped)
    clipped.y = (clipped.y + MIN_Y) * outwards
    avoidFootCollision(LEFT_BOX, RIGHT_BOX, leg == RIGHT, clipped)
    return Place(clipped.x, clipped.y, clipped.theta)


def check_legs(legs: Sequence[str]) -> None:
    """Check that each step is made by the other foot than the one before.

    Raises:
        BadGoal
    """
    for index, (before, leg) in enumerate(zip(legs, legs[1:]), start=1):
        if leg == before:
            raise BadGoal(f"footsteps[{index}].leg", leg, f"left and right in turn, and {before} made the step before")
