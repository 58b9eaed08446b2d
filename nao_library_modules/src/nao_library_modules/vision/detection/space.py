"""Positions of detections in space from the place in the picture, the camera's pose, and the real size. Pure.

Camera frames are NAOqi's here: X along the axis, Y left, Z up. Optical frames have X right, Y down, Z along the axis.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from statistics import median
from typing import List, Tuple

from ...audio_in.events import turned
from .events import BALL, CODE, FACE, LANDMARK, Detection, Lens, Pose, Region

Vector = Tuple[float, float, float]

DEFAULT_SIZES = {BALL: 0.03, LANDMARK: 0.092, FACE: 0.16}
"""m: radius of a ball, diameter of a landmark, width of a head; the size of other things is not known."""


@dataclass(frozen=True)
class LocalizedDetection:
    """A detection with its position; m, rad."""

    detection: Detection
    camera: int  # index
    time: float  # ROS time of the picture, s
    region: Region
    distance: float | None  # from the camera to its centre; None if the size is not known
    in_camera: Vector  # 1 m away without a distance
    in_torso: Vector
    in_robot: Vector  # in NAOqi's FRAME_ROBOT
    camera_in_robot: Vector
    looks: int = 1  # number of pictures that show it

    @property
    def label(self) -> str:
        """Its name, else its kind."""
        return self.detection.name or self.detection.kind

    @property
    def in_optical(self) -> Vector:
        """Position in the camera's optical frame, m."""
        x, y, z = self.in_camera
        return -y, -z, x


def located(
    detection: Detection,
    camera: int,
    time: float,
    region: Region,
    lens: Lens,
    size: float,
    in_torso: Pose,
    in_robot: Pose,
) -> LocalizedDetection:
    """Place a detection in space.

    Args:
        detection: From a picture.
        camera: Index of the camera.
        time: ROS time of the picture, s.
        region: Of the detection in the picture.
        lens: Of the camera.
        size: Real size, m: a ball's radius, else its width; 0 if it is not known.
        in_torso: The camera's pose in the torso frame.
        in_robot: The camera's pose in FRAME_ROBOT.
    """
    across, down = 2.0 * math.tan(lens.width / 2.0), 2.0 * math.tan(lens.height / 2.0)
    ray = (1.0, (0.5 - region.x) * across, (0.5 - region.y) * down)
    stretch = math.hypot(*ray)
    known = size > 0.0 and detection.size_x > 0.0 and detection.size_y > 0.0
    distance = _distance(detection, size, ray, region.width * across, region.height * down) if known else None
    scale = (1.0 if distance is None else distance) / stretch
    place = (ray[0] * scale, ray[1] * scale, ray[2] * scale)
    return LocalizedDetection(
        detection,
        camera,
        time,
        region,
        distance,
        place,
        moved(place, in_torso),
        moved(place, in_robot),
        (in_robot[0], in_robot[1], in_robot[2]),
    )


def _distance(detection: Detection, size: float, ray: Vector, width: float, height: float) -> float:
    """Distance of a detection, m.

    Args:
        detection: From a picture.
        size: Real size, m.
        ray: To its centre, 1 along the axis.
        width: In the picture, in units of the focal length.
        height: Likewise.
    """
    stretch = math.hypot(*ray)
    if detection.kind == BALL:  # its size is the angle in which it is seen, wherever in the picture
        return size / math.sin((detection.size_x + detection.size_y) / 4.0)
    if detection.kind == CODE:  # it may be turned in the picture, and is larger then
        return stretch * size / (2.0 * math.tan(detection.size_x / 2.0))
    # Away from the axis everything is drawn larger than the angle in which it is seen.
    across = width * math.hypot(1.0, ray[2]) / stretch**2
    if detection.kind == LANDMARK:  # a disc that is seen from the side is narrower one way only
        return size / max(across, height * math.hypot(1.0, ray[1]) / stretch**2)
    return size / across


def moved(point: Vector, pose: Pose) -> Vector:
    """A point (m) of a frame in the frame that the pose of the former refers to."""
    x, y, z = turned(point, pose[3:])
    return x + pose[0], y + pose[1], z + pose[2]


NEAR = 0.3
"""m; detections so near to each other, but never in one picture, are of one thing: detectors give it a new number when
the head turns."""
Group = List[Tuple[int, LocalizedDetection]]


def merged(pictures: Sequence[Sequence[LocalizedDetection]]) -> list[LocalizedDetection]:
    """Merge the detections of several pictures (oldest first), each thing once: the medians, the most frequent name.

    Those with a name come first, then those of most pictures, then the oldest; the time is that of the last picture.
    """
    things: dict[tuple[str, str], Group] = {}
    for number, picture in enumerate(pictures):
        for detection in picture:
            things.setdefault((detection.detection.kind, detection.detection.key), []).append((number, detection))
    groups: list[Group] = []
    for group in things.values():
        known = next((other for other in groups if _one_thing(other, group)), None)
        if known is None:
            groups.append(group)
        else:
            known[:] = sorted([*known, *group], key=lambda entry: entry[0])
    found = [_middle([detection for _, detection in group]) for group in groups]
    return sorted(found, key=lambda each: (not each.detection.name, -each.looks))


def _one_thing(one: Group, other: Group) -> bool:
    if one[0][1].detection.kind != other[0][1].detection.kind or {n for n, _ in one} & {n for n, _ in other}:
        return False
    first, second = ({s.detection.name for _, s in group if s.detection.name} for group in (one, other))
    if first and second and not first & second:
        return False
    places = [_vector([s.in_robot for _, s in group]) for group in (one, other)]
    return math.dist(*places) < NEAR


def _middle(detections: list[LocalizedDetection]) -> LocalizedDetection:
    last = detections[-1]
    if len(detections) == 1:
        return last
    names = Counter(s.detection.name for s in detections if s.detection.name)
    name = names.most_common(1)[0][0] if names else ""
    numbers = ("confidence", "alpha", "beta", "size_x", "size_y", "heading")
    detection = replace(
        last.detection,
        name=name,
        **{field: median(getattr(s.detection, field) for s in detections) for field in numbers},
    )
    distances = [s.distance for s in detections if s.distance is not None]
    return replace(
        last,
        detection=detection,
        region=Region(*_medians([s.region for s in detections])),
        distance=median(distances) if distances else None,
        in_camera=_vector([s.in_camera for s in detections]),
        in_torso=_vector([s.in_torso for s in detections]),
        in_robot=_vector([s.in_robot for s in detections]),
        camera_in_robot=_vector([s.camera_in_robot for s in detections]),
        looks=len(detections),
    )


def _medians(rows: Sequence[Sequence[float]]) -> list[float]:
    return [median(column) for column in zip(*rows)]


def _vector(points: Sequence[Vector]) -> Vector:
    x, y, z = _medians(points)
    return x, y, z
