"""The value of `FaceDetected`, and what it says only once."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import chain
from typing import Any, Sequence, Tuple

from nao_sim_bridge.cameras.frame import Frame
from nao_sim_bridge.naoqi.vision.vision_extractor import in_picture
from nao_sim_bridge.vision.faces import SeenFace

# Numbers in the lists of points, those included that are always zero; eyebrows are not found any more.
EYE, EYEBROW, NOSE, MOUTH = 14, 6, 6, 16
# Kinds of news: one or several people who were not recognised before, or somebody unknown who has been here for long.
ONE, SEVERAL, STRANGER = 2, 3, 4
NOBODY_FOR = 4.0
"""After so long without a face, who comes is told again, s."""
STRANGER_AFTER = 8.0
"""After so long in view, somebody unknown is told, s."""
SHORT_GAP = 1.0
"""Somebody who is not seen for no longer than this is still in view, s."""


@dataclass(frozen=True)
class NamedFace:
    """A face and whose it is."""

    face: SeenFace
    name: str  # of the person, empty when unknown
    score: float  # how sure it is, 0..1; of the best guess, also when that was not good enough


class NamesOnce:
    """Tells who is there once, not with every picture: for robots that greet people."""

    def __init__(self) -> None:
        self._told: set[str] = set()
        self._last_face: float | None = None
        self._unknown_since: dict[int, tuple[float, float]] = {}
        self._told_strangers: set[int] = set()

    def news(self, faces: Sequence[NamedFace], time: float) -> list[Any]:
        """What is new at a simulated time, s: [2, [name]], [3, [name, ...]], [4] or []."""
        if faces:
            self._last_face = time
        elif self._last_face is not None and time - self._last_face > NOBODY_FOR:
            self._told.clear()
        strangers = self._strangers(faces, time)
        new = [name for name in dict.fromkeys(face.name for face in faces) if name and name not in self._told]
        self._told.update(new)
        if new:
            return [ONE if len(new) == 1 else SEVERAL, new]
        return [STRANGER] if strangers else []

    def _strangers(self, faces: Sequence[NamedFace], time: float) -> bool:
        """Whether somebody has just been unknown for long enough."""
        known = {face.face.number for face in faces if face.name}
        still = {
            number: (since, seen)
            for number, (since, seen) in self._unknown_since.items()
            if number not in known and time - seen <= SHORT_GAP
        }
        for face in faces:
            if not face.name:
                since, _ = still.get(face.face.number, (time, time))
                still[face.face.number] = (since, time)
        self._unknown_since = still
        long = {number for number, (since, seen) in still.items() if seen - since > STRANGER_AFTER}
        new = long - self._told_strangers
        self._told_strangers = long
        return bool(new)


def faces_value(frame: Frame, faces: Sequence[NamedFace], news: list[Any]) -> list[Any]:
    """[[seconds, microseconds], [face, ..., news], camera in FRAME_TORSO, camera in FRAME_ROBOT, camera].

    A face is [[0, alpha, beta, width, height], [number, score, name, left eye, right eye, eyebrow, eyebrow, nose,
    mouth]] with all points as angles, x to the left and y downwards, in rad.
    """
    return in_picture(frame, [*map(_face_info, faces), news], frame.camera)


def _face_info(named: NamedFace) -> list[Any]:
    face = named.face
    eyes = [_flat(face.left_eye, EYE), _flat(face.right_eye, EYE), [0.0] * EYEBROW, [0.0] * EYEBROW]
    nose, mouth = _flat(face.nose, NOSE), _flat(face.mouth, MOUTH)
    return [[0, *face.centre, *face.size], [face.number, named.score, named.name, *eyes, nose, mouth]]


def _flat(points: Sequence[Tuple[float, float]], count: int) -> list[float]:
    numbers = list(chain.from_iterable(points))
    return numbers + [0.0] * (count - len(numbers))
