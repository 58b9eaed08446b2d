"""Finds faces in pictures: where they are, where their eyes, nose and mouth are, and what they look like."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Sequence, Tuple

import numpy as np

from nao_sim_bridge.base.imports import Library
from nao_sim_bridge.cameras.optics import Optics
from nao_sim_bridge.vision.faces_features import Box, FacePoints, Point, describe, find_eyes, find_points

cv2 = Library("cv2")
# Which cascade finds faces, and which has to agree in the place that it found.
FINDER, SECOND_OPINION = "haarcascade_frontalface_alt.xml", "haarcascade_frontalface_default.xml"
# Smallest face, px, step between the sizes, and how many windows have to agree.
LEAST, STEP, AGREE = 20, 1.1, 3
# The second cascade looks at a face enlarged to this width with some of its surroundings, px and share of the width.
SECOND_WIDTH, SECOND_MARGIN = 96, 0.25
# Nobody is blue or green, in whatever light: the most blue and green for each red, in the middle of a face.
MOST_BLUE, MOST_GREEN = 1.15, 1.15
# While faces are known, the whole picture is looked through this often only, s; in between, near them.
WHOLE_PICTURE_EVERY = 0.3
NEAR = 0.6
"""How far around a known face it is looked for, in its widths."""

Angles = Tuple[float, float]
# How far a face may get from one picture to the next, in its widths, and by how much its size may change.
REACH, GROWTH = 1.0, 1.4
FORGOTTEN = 1.0
"""When a face that has gone is forgotten, s; one that comes after that is another one."""


@dataclass(frozen=True)
class FaceSettings:
    """What the detector is told with a picture: when it was taken, s, by which camera, and what is wanted.

    With `track` a face keeps its number from picture to picture, and is looked for where it was.
    """

    time: float
    camera: int = 0
    track: bool = True
    describe: bool = True


@dataclass(frozen=True)
class SeenFace:
    """A face; its number is the same while it stays in view.

    Its box is the frame x, y, width, height in px, whose centre and size are in rad. Angles are alpha, to the left, and
    beta, downwards, in rad; of eyes, nose and mouth those of the `FacePoints`. See `describe` for the description, None
    when none is wanted.
    """

    number: int
    box: Box
    centre: Angles
    size: Angles
    left_eye: Tuple[Angles, ...]
    right_eye: Tuple[Angles, ...]
    nose: Tuple[Angles, ...]
    mouth: Tuple[Angles, ...]
    description: np.ndarray | None


class FaceDetector:
    """Looks for faces that are turned towards the camera, with the cascades that come with OpenCV."""

    def __init__(self) -> None:
        self._finder = _cascade(FINDER)
        self._second = _cascade(SECOND_OPINION)
        self._tracks = Tracks()
        self._camera: int | None = None
        self._whole_at = -WHOLE_PICTURE_EVERY

    def detect(self, image: np.ndarray, optics: Optics, settings: FaceSettings) -> list[SeenFace]:
        """The faces in a picture, the largest first."""
        if settings.camera != self._camera:
            self._tracks.clear()
            self._camera = settings.camera
        grey = cv2.cvtColor(image, cv2.COLOR_BGR2GRAY)
        known = self._tracks.boxes(grey.shape) if settings.track else []
        if known and settings.time < self._whole_at + WHOLE_PICTURE_EVERY:
            boxes = self._find_near(grey, known)
        else:
            boxes = self._find(grey)
            self._whole_at = settings.time
        boxes = sorted((box for box in boxes if _has_skin(image, box)), key=lambda box: -box[2])
        if not settings.track:
            self._tracks.clear()
        numbers = self._tracks.follow(boxes, grey.shape, settings.time)
        return [self._seen(number, box, image, grey, optics, settings) for number, box in zip(numbers, boxes)]

    def _find_near(self, grey: np.ndarray, known: Sequence[Box]) -> list[Box]:
        """Faces where faces were."""
        found: list[Box] = []
        for x, y, width, height in known:
            left, top = max(0, round(x - NEAR * width)), max(0, round(y - NEAR * height))
            part = grey[top : round(y + (1.0 + NEAR) * height), left : round(x + (1.0 + NEAR) * width)]
            for box in self._find(part, max(LEAST, round(0.7 * width)), round(1.4 * width)):
                moved = (box[0] + left, box[1] + top, box[2], box[3])
                if not any(_overlap(moved, other) for other in found):
                    found.append(moved)
        return found

    def _find(self, grey: np.ndarray, least: int = LEAST, most: int = 0) -> list[Box]:
        if min(grey.shape) < least:
            return []
        candidates = self._finder.detectMultiScale(
            grey, STEP, AGREE, minSize=(least, least), maxSize=(most, most) if most else (0, 0)
        )
        return [tuple(map(float, box)) for box in candidates if self._is_face(grey, box)]  # type: ignore[misc]

    def _is_face(self, grey: np.ndarray, box: Sequence[int]) -> bool:
        """Whether the second cascade sees a face there, too."""
        x, y, width, height = map(int, box)
        margin = round(SECOND_MARGIN * width)
        part = grey[max(0, y - margin) : y + height + margin, max(0, x - margin) : x + width + margin]
        scale = SECOND_WIDTH / width
        part = cv2.resize(part, None, fx=scale, fy=scale, interpolation=cv2.INTER_LINEAR)
        least = round(0.7 * SECOND_WIDTH)
        return len(self._second.detectMultiScale(part, 1.05, 1, minSize=(least, least))) > 0

    def _seen(
        self, number: int, box: Box, image: np.ndarray, grey: np.ndarray, optics: Optics, settings: FaceSettings
    ) -> SeenFace:
        rows, columns = grey.shape
        eyes = find_eyes(grey, box)
        points: FacePoints = find_points(grey, eyes)

        def angles(many: Sequence[Point]) -> Tuple[Angles, ...]:
            return tuple(optics.angles((x + 0.5) / columns, (y + 0.5) / rows) for x, y in many)

        x, y, width, height = box
        return SeenFace(
            number,
            box,
            centre=optics.angles((x + width / 2.0) / columns, (y + height / 2.0) / rows),
            size=optics.angular_size(width / columns, height / rows),
            left_eye=angles(points.left_eye),
            right_eye=angles(points.right_eye),
            nose=angles(points.nose),
            mouth=angles(points.mouth),
            description=describe(image, eyes) if settings.describe else None,
        )


def _cascade(name: str) -> cv2.CascadeClassifier:
    return cv2.CascadeClassifier(cv2.data.haarcascades + name)


def _has_skin(image: np.ndarray, box: Box) -> bool:
    """Whether what is in a frame could have the colour of skin; a grey picture has."""
    x, y, width, height = box
    inner = image[round(y + 0.3 * height) : round(y + 0.8 * height), round(x + 0.25 * width) : round(x + 0.75 * width)]
    blue, green, red = np.median(inner.reshape(-1, 3), axis=0) + 1.0
    return bool(blue < MOST_BLUE * red and green < MOST_GREEN * red)


def _overlap(one: Box, other: Box) -> bool:
    """Whether two frames are of the same face."""
    dx = abs(one[0] + one[2] / 2.0 - other[0] - other[2] / 2.0)
    dy = abs(one[1] + one[3] / 2.0 - other[1] - other[3] / 2.0)
    return max(dx, dy) < 0.5 * max(one[2], other[2])


@dataclass
class _Track:
    """A face: its number, its frame as shares of the picture, and when it was last seen, s."""

    number: int
    place: np.ndarray
    seen: float


class Tracks:
    def __init__(self) -> None:
        self._tracks: list[_Track] = []
        self._count = 0

    def clear(self) -> None:
        """All have gone."""
        self._tracks.clear()

    def boxes(self, shape: Tuple[int, ...]) -> list[Box]:
        """Where they were last, px of a picture of this shape."""
        scale = _scale(shape)
        return [tuple(track.place * scale) for track in self._tracks]  # type: ignore[misc]

    def follow(self, boxes: Sequence[Box], shape: Tuple[int, ...], time: float) -> list[int]:
        """Numbers of the faces in these frames; the nearest pairs come first."""
        self._tracks = [track for track in self._tracks if time - track.seen <= FORGOTTEN]
        places = [np.array(box) / _scale(shape) for box in boxes]
        pairs = [(_distance(t.place, p), i, j) for i, t in enumerate(self._tracks) for j, p in enumerate(places)]
        numbers: dict[int, _Track] = {}
        taken: set[int] = set()
        for distance, i, j in sorted(pairs):
            if distance <= REACH and i not in taken and j not in numbers:
                taken.add(i)
                numbers[j] = self._tracks[i]
        for j, place in enumerate(places):
            if j not in numbers:
                self._count += 1
                numbers[j] = _Track(self._count, place, time)
                self._tracks.append(numbers[j])
            numbers[j].place, numbers[j].seen = place, time
        return [numbers[j].number for j in range(len(places))]


def _scale(shape: Tuple[int, ...]) -> np.ndarray:
    return np.array((shape[1], shape[0], shape[1], shape[0]), dtype=float)


def _distance(one: np.ndarray, other: np.ndarray) -> float:
    """Between the middles of two frames, in widths; too far when the sizes differ too much."""
    ratio = one[2] / other[2]
    if max(ratio, 1.0 / ratio) > GROWTH:
        return 2.0 * REACH
    middle = one[:2] + one[2:] / 2.0 - other[:2] - other[2:] / 2.0
    return float(np.max(np.abs(middle) / np.minimum(one[2:], other[2:])))
