"""Detections of NAOqi's vision modules, from the values of their events. No ROS."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Tuple

from ...nao.camera_facts import TOP, camera_number

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


@dataclass(frozen=True)
class View:
    """Time and camera of a picture."""

    time: float  # s, the robot's clock
    camera: int  # NAOqi's number
    in_torso: tuple[float, ...]  # pose of the camera: x, y, z in m, roll, pitch, yaw in rad
    in_robot: tuple[float, ...]  # the same in FRAME_ROBOT, between the feet


@dataclass(frozen=True)
class Shape:
    """Where something is, seen from the camera, rad."""

    alpha: float  # of the centre, positive to the left
    beta: float  # of the centre, positive downwards
    width: float
    height: float


@dataclass(frozen=True)
class Face:
    """A face."""

    shape: Shape
    number: int
    score: float  # of the recognition, 0 to 1
    label: str  # name of the person; empty if not known
    points: dict[str, Pair]  # "left_eye_eyeCenter" and so on -> alpha, beta in rad; without those not reported


@dataclass(frozen=True)
class Landmark:
    """A mark and its number."""

    shape: Shape
    number: int


@dataclass(frozen=True)
class Movement:
    """Movement in a picture; positions are alpha, beta in rad, velocities in rad/s."""

    view: View | None  # None if the robot does not report it
    centre: Pair  # mean
    velocity: Pair  # mean
    points: tuple[Pair, ...]  # of each part that moved
    velocities: tuple[Pair, ...]  # of the same parts


def read_faces(value: Any) -> tuple[View, list[Face]] | None:
    """Faces from [[s, us], [face, ..., recognition], camera in torso, in robot, camera]; None if there are none."""
    if not _is_list(value, 2) or not _is_list(value[1], 1):
        return None
    # Behind the faces comes what the recognition has to say over time: that has no shape.
    faces = [_face(each) for each in value[1] if _is_list(each, 2) and _is_list(each[0], 5)]
    return (_view(value), faces) if faces else None


def read_landmarks(value: Any) -> tuple[View, list[Landmark]] | None:
    """Landmarks from an event; None if there are none.

    `value`: [[s, us], [[[1, alpha, beta, width, height, heading], [number]], ...], camera in torso, camera in robot,
    name of the camera], or [].
    """
    if not _is_list(value, 2) or not _is_list(value[1], 1):
        return None
    marks = []
    for shape, number in (each[:2] for each in value[1] if _is_list(each, 2) and _is_list(each[0], 5)):
        marks.append(Landmark(_shape(shape), int(number[0] if _is_list(number, 1) else number)))
    return (_view(value), marks) if marks else None


class MovementReader:
    """Reads movements, and computes velocities from one to the next. For one thread."""

    def __init__(self) -> None:
        self._last: tuple[float, tuple[Pair, ...], Pair] | None = None

    def read(self, value: Any) -> Movement | None:
        """Movement from the value in the robot's memory; None if there is none.

        `value`: [[s, us], [[[alpha, beta], [x, y, width, height], share], ...], camera in torso, camera in robot,
        camera]; of NAOqi before 2.0 [[centre, velocity, [point, ...], [velocity, ...]]].
        """
        if _is_list(value, 1) and _is_list(value[0], 4):
            return _former_movement(value[0])
        if not _is_list(value, 2) or not _is_list(value[1], 1):
            return None
        clusters = [each for each in value[1] if _is_list(each, 2) and _is_list(each[0], 2)]
        if not clusters:
            return None
        view = _view(value)
        points = tuple((float(each[0][0]), float(each[0][1])) for each in clusters)
        centre = _centre(points, [_extent(each) for each in clusters])
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
    area = abs(float(region[2]) * float(region[3])) if _is_list(region, 4) else 1.0
    share = float(cluster[2]) if len(cluster) > 2 and not _is_list(cluster[2], 0) else 1.0
    return area * share


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


def _face(entry: Sequence[Any]) -> Face:
    shape, extra = _shape(entry[0]), entry[1]
    number, score, label = (*extra[:3], *(0, 0.0, "")[len(extra) :])
    points = {}
    for (part, names), values in zip(PARTS, extra[3:]):
        if _is_list(values, 2):
            pairs = zip(names, zip(values[::2], values[1::2]))
            points.update({f"{part}_{name}": (float(x), float(y)) for name, (x, y) in pairs})
    return Face(shape, int(number), float(score), str(label), points)


def _shape(values: Sequence[Any]) -> Shape:
    return Shape(*(float(each) for each in values[1:5]))


def _view(value: Sequence[Any]) -> View:
    stamp = value[0] if _is_list(value[0], 2) else (0, 0)
    poses = [_pose(value[place]) if len(value) > place else (0.0,) * 6 for place in (2, 3)]
    return View(stamp[0] + 1e-6 * stamp[1], _camera(value[4] if len(value) > 4 else TOP), *poses)


def _camera(value: Any) -> int:
    """Number of a camera given by number or name; the top one for an unknown one."""
    number = camera_number(value)
    return TOP if number is None else number


def _pose(value: Any) -> tuple[float, ...]:
    return tuple(float(each) for each in value) if _is_list(value, 6) else (0.0,) * 6


def _pair(value: Sequence[Any]) -> Pair:
    return float(value[0]), float(value[1])


def _is_list(value: Any, least: int) -> bool:
    return isinstance(value, (list, tuple)) and len(value) >= least
