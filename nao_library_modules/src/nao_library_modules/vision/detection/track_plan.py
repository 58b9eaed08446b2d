"""Head angles and speeds to follow a detection, and to search for one. Pure."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import cycle
from typing import Tuple

from ...motion.facts import JointLimits
from ...nao.camera_facts import CAMERA_NAMES
from ...nao.gaze import load_head, look_at
from .events import BALL, FACE
from .space import LocalizedDetection

Angles = Tuple[float, float]
"""HeadYaw and HeadPitch, rad."""

YAWS = (0.0, 0.8, 1.6, 2.0, -0.8, -1.6, -2.0)
"""rad: a camera sees 0.98 rad, so that pictures overlap."""
PITCHES = {BALL: (0.2, 0.45), FACE: (0.0, -0.35, -0.65)}
"""rad, positive downwards: a ball lies on the floor, and people who come near are high above the robot."""
USUAL_PITCHES = (0.0, -0.4, 0.3)
REACTION = 0.2
"""s in which the head is to reach its target: less is quicker, more is smoother."""
LEAST_FRACTION = 0.01
STILL = math.radians(0.7)
"""rad off the middle of the picture for which the head does not turn: pictures are not more exact."""
MIDDLE = math.radians(3.0)
"""rad off the middle of the picture that count as the middle."""


def aim(detection: LocalizedDetection) -> Angles:
    """Head angles that bring a detection into the middle of the picture, also beyond the head's limits.

    Raises ValueError if it is in the head.
    """
    head = load_head()
    return look_at(head, head.cameras[CAMERA_NAMES[detection.camera]], detection.in_torso)


def off_axis(detection: LocalizedDetection) -> float:
    """Angle of a detection off the camera's axis, rad."""
    x, y, z = detection.in_camera
    return math.atan2(math.hypot(y, z), x)


def fraction(angle: float, ranges: Sequence[JointLimits], most: float) -> float:
    """Fraction of the head's top speed for a turn: the smaller the angle (rad), the slower; at most `most`."""
    top = min(joint.max_speed for joint in ranges)
    return min(max(angle / REACTION / top, LEAST_FRACTION), most)


def travel_time(start: Angles, end: Angles, ranges: Sequence[JointLimits], speed: float) -> float:
    """Duration of a turn of the head at a fraction (0..1) of the top speeds, s."""
    return max(abs(b - a) / (joint.max_speed * speed) for a, b, joint in zip(start, end, ranges))


def search_angles(kind: str, ranges: Sequence[JointLimits]) -> Iterator[Angles]:
    """Head angles of a search for a kind of thing, without end: ahead first, then to the left, then to the right."""
    rows = PITCHES.get(kind, USUAL_PITCHES)
    places = []
    for column, yaw in enumerate(YAWS):
        # Down one column and up the next: shorter ways for the head.
        for pitch in rows if column % 2 == 0 else rows[::-1]:
            places.append((ranges[0].within(yaw), ranges[1].within(pitch)))
    return cycle(places)


def the_one(detections: Sequence[LocalizedDetection], last: LocalizedDetection | None) -> LocalizedDetection:
    """The detection to follow: of the same thing as the last one, else the nearest to it; at first the largest."""
    if last is None:
        return max(detections, key=lambda s: s.region.width * s.region.height)
    same = [s for s in detections if s.detection.key == last.detection.key]
    if len(same) == 1:
        return same[0]
    return min(detections, key=lambda s: math.dist(s.in_robot, last.in_robot))
