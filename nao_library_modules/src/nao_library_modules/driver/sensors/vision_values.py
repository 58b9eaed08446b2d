"""Detections of NAOqi's vision modules, as the driver's messages have them, from the values of their events. No ROS."""

from __future__ import annotations

import logging
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Tuple

from ...nao.camera_facts import TOP, camera_number
from ...vision.detection.events import (
    Detection,
    DetectionArray,
    face_detections,
    landmark_detections,
    movement_detections,
)

log = logging.getLogger(__name__)

Pair = Tuple[float, float]

EYE = (
    "eyeCenter",
    "noseSideLimit",
    "earSideLimit",
    "topLimit",
    "bottomLimit",
    "midTopEarLimit",
    "midTopNoseLimit",
)
EYEBROW = ("noseSideLimit", "center", "earSideLimit")
NOSE = ("bottomCenterLimit", "bottomLeftLimit", "bottomRightLimit")
MOUTH = (
    "leftLimit",
    "rightLimit",
    "topLimit",
    "bottomLimit",
    "midTopLeftLimit",
    "midTopRightLimit",
    "midBottomRightLimit",
    "midBottomLeftLimit",
)
PARTS = (
    ("left_eye", EYE),
    ("right_eye", EYE),
    ("left_eyebrow", EYEBROW),
    ("right_eyebrow", EYEBROW),
    ("nose", NOSE),
    ("mouth", MOUTH),
)
"""Parts of a face and their points, in the order of the event; message fields are named after them."""
LONGEST_STEP = 0.5
"""s between two events above which velocities are unknown."""
NO_POSE = (0.0,) * 6
"""Stands for a pose of the camera that an event does not tell."""


@dataclass(frozen=True)
class Face:
    """A face."""

    shape: Detection
    number: int
    score: float  # of the recognition, 0 to 1
    label: str  # name of the person; empty if not known
    points: dict[str, Pair]  # "left_eye_eyeCenter" and so on -> alpha, beta in rad; without those not reported


@dataclass(frozen=True)
class Movement:
    """Movement in a picture; positions are alpha, beta in rad, velocities in rad/s."""

    view: DetectionArray | None  # None if the robot does not report it
    centre: Pair  # mean
    velocity: Pair  # mean
    points: tuple[Pair, ...]  # of each part that moved
    velocities: tuple[Pair, ...]  # of the same parts


def _seen(read: Callable[[Any], DetectionArray], value: Any) -> DetectionArray | None:
    """What an event tells, which may lack time, poses or camera; None if it tells of nothing, or is no such event."""
    if not _is_list(value, 2):
        return None
    stamp = value[0] if _is_list(value[0], 2) else (0, 0)
    in_torso, in_robot = (value[i] if len(value) > i and _is_list(value[i], 6) else NO_POSE for i in (2, 3))
    camera = value[4] if len(value) > 4 and camera_number(value[4]) is not None else TOP
    try:
        seen = read([stamp, value[1], in_torso, in_robot, camera])
    except ValueError as error:
        log.debug("%s", error)
        return None
    return seen if seen.detections else None


def read_faces(value: Any) -> tuple[DetectionArray, list[Face]] | None:
    """Faces of an event, as `face_detections` describes it; None if there are none."""
    seen = _seen(face_detections, value)
    if seen is None:
        return None
    # Behind the faces comes what the recognition has to say over time: that has no shape.
    extras = [each[1] for each in value[1] if len(each) == 2 and _is_list(each[0], 0)]
    return seen, [_face(shape, extra) for shape, extra in zip(seen.detections, extras)]


def read_landmarks(value: Any) -> DetectionArray | None:
    """Landmarks of an event, as `landmark_detections` describes it; None if there are none."""
    return _seen(landmark_detections, value)


class MovementReader:
    """Reads movements, and computes velocities from one to the next. For one thread."""

    def __init__(self) -> None:
        self._last: tuple[float, tuple[Pair, ...], Pair] | None = None

    def read(self, value: Any) -> Movement | None:
        """Movement from the value in the robot's memory, as `movement_detections` describes it; None if there is none.

        NAOqi before 2.0 has [[centre, velocity, [point, ...], [velocity, ...]]] instead; that is read, too.
        """
        if _is_list(value, 1) and _is_list(value[0], 4):
            return _former_movement(value[0])
        view = _seen(movement_detections, value)
        if view is None:
            return None
        points = tuple((each.alpha, each.beta) for each in view.detections)
        centre = _centre(points, [_extent(each) for each in value[1]])
        velocity, velocities = self._velocities(view.time, points, centre)
        self._last = (view.time, points, centre)
        return Movement(view, centre, velocity, points, velocities)

    def _velocities(self, time: float, points: tuple[Pair, ...], centre: Pair) -> tuple[Pair, tuple[Pair, ...]]:
        """Mean velocity and those of the points, rad/s: 0 where there was nothing shortly before."""
        still = (0.0, 0.0)
        step = time - self._last[0] if self._last is not None else 0.0
        if self._last is None or not 0.0 < step <= LONGEST_STEP:
            return still, (still,) * len(points)
        _, former, former_centre = self._last
        nearest = (min(former, key=lambda each, point=point: math.dist(each, point)) for point in points)
        velocities = tuple(_velocity(begin, end, step) for begin, end in zip(nearest, points))
        return _velocity(former_centre, centre, step), velocities


def _velocity(begin: Pair, end: Pair, step: float) -> Pair:
    return (end[0] - begin[0]) / step, (end[1] - begin[1]) / step


def _extent(cluster: Sequence[Any]) -> float:
    """Size of a cluster in the picture, in any unit."""
    region = cluster[1]
    share = 1.0 if _is_list(cluster[2], 0) else float(cluster[2])
    return abs(float(region[-2]) * float(region[-1])) * share


def _centre(points: Sequence[Pair], weights: Sequence[float]) -> Pair:
    total = sum(weights)
    if total <= 0.0:
        weights, total = [1.0] * len(points), float(len(points))
    return (
        sum(point[0] * weight for point, weight in zip(points, weights)) / total,
        sum(point[1] * weight for point, weight in zip(points, weights)) / total,
    )


def _former_movement(entry: Sequence[Any]) -> Movement:
    centre, velocity = _pair(entry[0]), _pair(entry[1])
    return Movement(None, centre, velocity, tuple(map(_pair, entry[2])), tuple(map(_pair, entry[3])))


def _face(shape: Detection, extra: Sequence[Any]) -> Face:
    number, score, label = extra[:3]
    points = {}
    for (part, names), values in zip(PARTS, extra[3:]):
        if _is_list(values, 2):
            pairs = zip(names, zip(values[::2], values[1::2]))
            points.update({f"{part}_{name}": (float(x), float(y)) for name, (x, y) in pairs})
    return Face(shape, int(number), float(score), str(label), points)


def _pair(value: Sequence[Any]) -> Pair:
    return float(value[0]), float(value[1])


def _is_list(value: Any, least: int) -> bool:
    return isinstance(value, (list, tuple)) and len(value) >= least
