"""Detections from the events of the robot's vision: in angles of the camera, and in space. Pure."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from statistics import median
from typing import Any, List, NamedTuple, Tuple

from ..audio_in.hearing import turned
from ..core.nao_facts import camera_number

BALL, FACE, LANDMARK, CODE, MOVEMENT = "ball", "face", "landmark", "code", "movement"

Pose = Tuple[float, float, float, float, float, float]
"""NAOqi's Position6D: m and rad about X, Y, Z, Z turned about last."""


class Lens(NamedTuple):
    """Field of view of a camera, rad: horizontal and vertical."""

    width: float
    height: float


class Region(NamedTuple):
    """Part of a picture, in fractions of its width and height: centre from the upper left corner, extent."""

    x: float
    y: float
    width: float
    height: float


@dataclass(frozen=True)
class Detection:
    """Something in a picture; rad."""

    kind: str  # ball, face, landmark, code or movement
    name: str  # person, number of the landmark, text of the code; empty: none, or unknown
    key: str  # identifies the thing in the next picture
    confidence: float  # 0..1
    alpha: float  # of the centre
    beta: float
    size_x: float  # the whole width
    size_y: float
    heading: float = 0.0  # rotation in the picture, anticlockwise
    region: Region | None = None  # None: the robot has to be asked


@dataclass(frozen=True)
class DetectionArray:
    """The detections of one picture; None: the event does not say."""

    time: float | None  # the robot's time of the picture, s
    camera: int | None  # index
    in_torso: Pose | None  # pose of the camera
    in_robot: Pose | None  # pose of the camera in NAOqi's FRAME_ROBOT
    detections: tuple[Detection, ...]


NOTHING = DetectionArray(None, None, None, None, ())


def code_detections(value: Any, width: int, height: int, lens: Lens) -> tuple[Detection, ...]:
    """Codes, from BarcodeReader/BarcodeDetected.

    Raises ValueError if the value is something else.

    Args:
        value: [[text, [[x, y], [x, y], [x, y], [x, y]]], ...]: corners in pixels, around the code from its upper left.
        width: Of the picture, pixels.
        height: Of the picture, pixels.
        lens: Field of view of the camera.
    """
    try:
        return tuple(
            _code(text, [_finite(corner) for corner in corners], (width, height), lens) for text, corners, *_ in value
        )
    except (TypeError, ValueError, IndexError) as error:
        raise ValueError(f"no codes that were read: {value!r}") from error


def _read(what: str, read: Callable[[Any], list[Detection]], value: Any) -> DetectionArray:
    """The picture of which an event tells. Raises ValueError if its value is something else.

    `what`: its content in words. `read`: reads the content. `value`: [[s, us], content, camera in the torso, camera in
    FRAME_ROBOT, camera]; angles in rad.
    """
    if not value:
        return NOTHING
    try:
        (seconds, microseconds), content, in_torso, in_robot, camera, *_ = value
        return DetectionArray(
            float(seconds) + 1e-6 * float(microseconds),
            _camera(camera),
            _pose(in_torso),
            _pose(in_robot),
            tuple(read(content)),
        )
    except (TypeError, ValueError, IndexError) as error:
        raise ValueError(f"no {what} that were detected: {value!r}") from error


def _camera(camera: Any) -> int:
    number = camera_number(camera)
    if number is None:
        raise ValueError(f"no camera {camera!r}")
    return number


def _pose(values: Sequence[float]) -> Pose:
    x, y, z, wx, wy, wz = _finite(values)
    return x, y, z, wx, wy, wz


def _finite(values: Sequence[Any]) -> list[float]:
    numbers = [float(value) for value in values]
    if not all(map(math.isfinite, numbers)):
        raise ValueError(f"{numbers} are not finite")
    return numbers


def _ball(content: Any) -> list[Detection]:
    """From redBallDetected: [alpha, beta, radius, radius]."""
    alpha, beta, radius_x, radius_y = _finite(content)
    return [Detection(BALL, "", BALL, 1.0, alpha, beta, 2.0 * radius_x, 2.0 * radius_y)]


def _landmarks(content: Any) -> list[Detection]:
    """From LandmarkDetected: [[[1, alpha, beta, width, height, heading], [number]], ...]; the number may be bare."""
    detections = []
    for shape, number in content:
        _, alpha, beta, width, height, *heading = _finite(shape)
        turn = heading[0] if heading else 0.0
        name = str(int(number[0] if isinstance(number, (list, tuple)) else number))
        detections.append(Detection(LANDMARK, name, name, 1.0, alpha, beta, width, height, turn))
    return detections


def _faces(content: Any) -> list[Detection]:
    """From FaceDetected: [[[0, alpha, beta, width, height], [id, score, name, ...]], ..., recognised for some time].

    The only face of a picture, if it has no name, gets that of the only person who was recognised for some time.
    """
    shapes = [entry for entry in content if len(entry) == 2 and isinstance(entry[0], (list, tuple))]
    known = _recognised(content[-1]) if content and len(shapes) < len(content) else []
    numbers = [int(extra[0]) for _, extra in shapes]
    detections = []
    for place, (shape, extra) in enumerate(shapes):
        _, alpha, beta, width, height, *_ = _finite(shape)
        score, name = float(extra[1]), str(extra[2])
        if not name and len(shapes) == len(known) == 1:
            name = known[0]
        # Numbers identify faces from picture to picture, unless the robot gives all faces the same one.
        key = f"#{numbers[place]}" if numbers.count(numbers[place]) == 1 else name or f"face {place}"
        detections.append(Detection(FACE, name, key, min(max(score, 0.0), 1.0), alpha, beta, width, height))
    return detections


def _recognised(entry: Any) -> list[str]:
    """Names in TimeFilteredRecoInfo: [2, [name]] or [3, [name, ...]]; there are none in [] and [4]."""
    if len(entry) == 2 and entry[0] in (2, 3):
        return [str(name) for name in entry[1]]
    return []


def _movements(content: Any) -> list[Detection]:
    """From MovementDetection/MovementInfo: [[[alpha, beta], [left, top, width, height], [share, share], ...], ...].

    The shares that moved are those of the picture's pixels and of the region's.
    """
    detections = []
    for place, (centre, region, moving, *_) in enumerate(content):
        alpha, beta = _finite(centre)
        *_, width, height = _finite(region)
        of_region = moving[-1] if isinstance(moving, (list, tuple)) else moving
        confidence = min(max(float(of_region), 0.0), 1.0)
        detections.append(Detection(MOVEMENT, "", f"{place}", confidence, alpha, beta, abs(width), abs(height)))
    return detections


ball_detections = partial(_read, "red ball", _ball)
landmark_detections = partial(_read, "landmarks", _landmarks)
face_detections = partial(_read, "faces", _faces)
movement_detections = partial(_read, "movements", _movements)


def _code(text: Any, corners: list[list[float]], picture: tuple[int, int], lens: Lens) -> Detection:
    if not isinstance(text, str) or len(corners) != 4 or any(len(corner) != 2 for corner in corners):
        raise ValueError(f"{text!r} with {len(corners)} corners is no code")
    xs, ys = [x / picture[0] for x, _ in corners], [y / picture[1] for _, y in corners]
    region = Region((max(xs) + min(xs)) / 2.0, (max(ys) + min(ys)) / 2.0, max(xs) - min(xs), max(ys) - min(ys))
    # In units of the focal length: X right, Y down.
    across, down = 2.0 * math.tan(lens.width / 2.0), 2.0 * math.tan(lens.height / 2.0)
    plane = [((x - 0.5) * across, (y - 0.5) * down) for x, y in zip(xs, ys)]
    upper = (plane[1][0] - plane[0][0], plane[1][1] - plane[0][1])
    sides = [math.dist(plane[a], plane[b]) for a, b in ((0, 1), (3, 2), (0, 3), (1, 2))]
    return Detection(
        CODE,
        text,
        text,
        1.0,
        math.atan((0.5 - region.x) * across),
        math.atan((region.y - 0.5) * down),
        2.0 * math.atan((sides[0] + sides[1]) / 4.0),
        2.0 * math.atan((sides[2] + sides[3]) / 4.0),
        math.atan2(-upper[1], upper[0]),
        region,
    )


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
