"""The four microphones as an array: how delays between them and directions belong together. Pure functions.

Directions are unit vectors in the frame of the head. The four microphones lie in one plane, which is tilted forward by
27 degrees, so delays tell only the *shadow* of a direction: its projection (2,) on that plane. Two directions, one the
mirror image of the other, have the same shadow.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from typing import Sequence

import numpy as np

SPEED_OF_SOUND = 343.0
# How far sounds are taken to be, m: waves from there are not plane, which would be felt nearer than 2 m.
DISTANCE = 1.7


@dataclass(frozen=True)
class MicrophoneArray:
    """Where the microphones are.

    Attributes:
        places: (4, 3) in the frame of the head, m, from their middle.
        axes: (3, 3) rows: two axes of the plane of the microphones, ahead and to the left, and its normal, upwards.
        pairs: (6, 2) indices of the microphones of each pair.
        baselines: (6, 2) from the first to the second of each pair, on the axes of the plane, in s of sound's way.
    """

    places: np.ndarray
    axes: np.ndarray
    pairs: np.ndarray
    baselines: np.ndarray

    def lags(self, shadows: np.ndarray) -> np.ndarray:
        """(..., 6) s by which the second of each pair hears a sound later, by the shadow (..., 2) of its direction."""
        return -shadows @ self.baselines.T + self._curvature(shadows)

    def shadow(self, directions: np.ndarray) -> np.ndarray:
        """(..., 2) projection of unit vectors (..., 3) on the plane of the microphones."""
        return directions @ self.axes[:2].T

    def _curvature(self, shadows: np.ndarray) -> np.ndarray:
        """(..., 6) what a wave from `DISTANCE` adds to the lags of a plane wave, to second order."""
        along = shadows @ (self.places @ self.axes[:2].T).T
        later = ((self.places**2).sum(axis=1) - along**2) / (2.0 * DISTANCE * SPEED_OF_SOUND)
        return later[..., self.pairs[:, 1]] - later[..., self.pairs[:, 0]]

    @property
    def longest_lag(self) -> float:
        """Longest time that sound needs from one microphone to another, s."""
        return float(np.linalg.norm(self.baselines, axis=1).max())


def microphone_array(places: Sequence[Sequence[float]]) -> MicrophoneArray:
    """The array of microphones at `places` (4, 3), in the frame of the head, m."""
    centred = np.asarray(places, dtype=float)
    centred = centred - centred.mean(axis=0)
    axes = _plane(centred)
    pairs = np.array(list(combinations(range(len(centred)), 2)))
    baselines = (centred[pairs[:, 1]] - centred[pairs[:, 0]]) @ axes[:2].T / SPEED_OF_SOUND
    return MicrophoneArray(centred, axes, pairs, baselines)


def direction(azimuth: np.ndarray | float, elevation: np.ndarray | float) -> np.ndarray:
    """(..., 3) unit vectors; azimuth from ahead to the left, elevation upwards, rad."""
    level = np.cos(elevation)
    return np.stack([level * np.cos(azimuth), level * np.sin(azimuth), np.sin(elevation) + 0.0 * level], axis=-1)


def _plane(centred: np.ndarray) -> np.ndarray:
    """(3, 3) rows: axes of the plane that the places lie in, the first as far ahead as can be, and its normal."""
    normal = np.linalg.svd(centred)[2][2]
    normal = normal * np.sign(normal[2])
    ahead = np.array([1.0, 0.0, 0.0]) - normal[0] * normal
    ahead /= np.linalg.norm(ahead)
    return np.stack([ahead, np.cross(normal, ahead), normal])
