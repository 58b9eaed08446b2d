"""Numbers of faces: the same one for a face as long as it stays in view."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Sequence, Tuple

import numpy as np

from nao_sim_bridge.vision.faces_points import Box

# How far a face may get from one picture to the next, in its widths, and by how much its size may change.
REACH, GROWTH = 1.0, 1.4
FORGOTTEN = 1.0
"""When a face that has gone is forgotten, s; one that comes after that is another one."""


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
