"""Where a sound comes from, out of the delays between the microphones. Pure arithmetic on blocks of samples.

The delays of the six pairs are searched together (steered response power): over the shadows that a direction can have
on the plane of the microphones, the one is taken at which the cross-correlations of all pairs add up highest. Each
frequency counts by how far it stands out from the noise, up to a bound: so tones, whose lines carry everything, are
found as well as noise and speech.

A shadow belongs to two directions, see `MicrophoneArray`. Sounds that matter are mostly somewhat above the level of a
NAO's head, so the elevations that `PRIOR` likes are believed; where both directions are near each other, or the shadow
is too near the rim to tell, the mean of what is likely is taken.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import combinations
from typing import Sequence

import numpy as np

from nao_sim_bridge.hearing.spectra import CrossSpectra, frequencies

# Elevations above the horizon that sounds have: mean and standard deviation, rad. Sources 0.2 to 1.7 m above the floor
# at 1 to 3 m from a head at 0.5 m.
PRIOR = (math.radians(10.0), math.radians(15.0))
# Standard deviation of a shadow: what noise and the curvature of waves from 1 m make of it.
SHADOW_ERROR = 0.006
# Two directions nearer to each other than this are not told apart: their mean is taken, rad.
SAME = math.radians(25.0)
# A frequency does not count more than one that stands out by this power ratio.
MOST_WEIGHT = 10.0**2.5
OVERSAMPLING = 8
# Shadows searched first, and by how much the rim is overstepped: noise may put the best one outside.
STEP, RIM = 0.05, 1.1
REFINEMENTS = 3
# Square of the radius within which shadows have a direction on each side of the plane.
INNERMOST_RIM = 1.0 - 1e-6
UPRIGHT = (0.0, 0.0, 1.0)
SPEED_OF_SOUND = 343.0
# How far sounds are taken to be, m: waves from there are not plane, which would be felt nearer than 2 m.
DISTANCE = 1.7


@dataclass(frozen=True)
class MicrophoneArray:
    """The four microphones as an array: how delays between them and directions belong together.

    Their places, (4, 3), are in the frame of the head, m, from their middle. The rows of `axes`, (3, 3), are two axes
    of their plane, ahead and to the left, and its normal, upwards. Pairs are (6, 2) indices; baselines, (6, 2), lead
    from the first to the second of each pair, on the axes of the plane, in s of sound's way.

    The plane is tilted forward by 27 degrees, so delays tell only the *shadow* of a direction: its projection (2,) on
    that plane. Two directions, one the mirror image of the other, have the same shadow.
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


@dataclass(frozen=True)
class Bearing:
    """The direction of a sound in the frame of the head, rad: azimuth from ahead to the left, and elevation upwards.

    Its coherence is the share of the sound that fits to this direction, 0..1.
    """

    azimuth: float
    elevation: float
    coherence: float


class DirectionFinder:
    """Finds directions with one array, in samples of `rate` Hz."""

    def __init__(self, array: MicrophoneArray, rate: int) -> None:
        self._array = array
        self._step = 1.0 / rate / OVERSAMPLING
        self._bound = RIM * array.longest_lag + 2.0 * self._step
        lags = np.arange(-self._bound, self._bound + self._step, self._step)
        self._steering = np.exp(-2j * np.pi * np.outer(lags, frequencies(rate)))
        self._shadows = _disc(STEP, RIM)
        self._places = self._rows(self._shadows).round().astype(int)
        self._errors = _square(3.0 * SHADOW_ERROR)
        self._chances = np.exp(-0.5 * (self._errors**2).sum(axis=1) / SHADOW_ERROR**2)

    def find(self, spectra: CrossSpectra, up: Sequence[float] = UPRIGHT) -> Bearing:
        """Direction that the loudest sound of a block comes from; `up` is upwards in the frame of the head."""
        shadow, coherence = self.shadow(spectra)
        x, y, z = self.direction_of(shadow, up)
        return Bearing(math.atan2(y, x), math.asin(max(-1.0, min(1.0, z))), coherence)

    def shadow(self, spectra: CrossSpectra) -> tuple[np.ndarray, float]:
        """Shadow (2,) of the direction of a sound, and its coherence."""
        power = spectra.power
        ratio = np.maximum(power / spectra.noise - 1.0, 0.0)
        weights = np.minimum(ratio, MOST_WEIGHT) / power
        first, second = self._array.pairs.T
        correlations = (self._steering @ (spectra.products[:, first, second] * weights[:, None])).real
        columns = np.arange(len(first))
        response = correlations[self._places, columns].sum(axis=1)
        best, reach = self._shadows[np.argmax(response)], STEP
        for _ in range(REFINEMENTS):
            around = best + _square(reach)
            response = self._interpolated(correlations, around)
            best = around[np.argmax(response)]
            reach /= 4.0
        most = len(first) * float(weights @ power)
        return best, max(0.0, float(response.max()) / most) if most > 0.0 else 0.0

    def direction_of(self, shadow: np.ndarray, up: Sequence[float] = UPRIGHT) -> np.ndarray:
        """The unit vector that a shadow is most likely of."""
        shadows = shadow + self._errors
        squares = (shadows**2).sum(axis=1)
        inside = squares < INNERMOST_RIM
        if not inside.any():
            shadows, squares = shadow[None] * math.sqrt(INNERMOST_RIM / (shadow @ shadow)), np.array([INNERMOST_RIM])
            inside = np.array([True])
        heights = np.sqrt(1.0 - squares[inside])
        # The same area on the plane is a larger piece of the sphere towards the rim.
        likely = self._chances[inside] / heights if inside.size > 1 else np.ones(1)
        sides = [self._mean(shadows[inside], side * heights, likely, up) for side in (1.0, -1.0)]
        (above, more), (below, less) = sides
        if _angle(above, below) < SAME:
            mean = above + below
        else:
            mean = above if more >= less else below
        return mean / np.linalg.norm(mean)

    def _mean(
        self, shadows: np.ndarray, heights: np.ndarray, likely: np.ndarray, up: Sequence[float]
    ) -> tuple[np.ndarray, float]:
        """Sum (3,) of the directions on one side of the plane, each times how likely it is, and that of the chances."""
        directions = np.concatenate([shadows, heights[:, None]], axis=1) @ self._array.axes
        elevations = np.arcsin(np.clip(directions @ np.asarray(up), -1.0, 1.0))
        chances = likely * np.exp(-0.5 * ((elevations - PRIOR[0]) / PRIOR[1]) ** 2)
        return chances @ directions, float(chances.sum())

    def _rows(self, shadows: np.ndarray) -> np.ndarray:
        """(n, 6) rows of the lags in the table of correlations."""
        return (self._array.lags(shadows) + self._bound) / self._step

    def _interpolated(self, correlations: np.ndarray, shadows: np.ndarray) -> np.ndarray:
        rows = np.clip(self._rows(shadows), 0.0, len(correlations) - 2.0)
        below = rows.astype(int)
        share = rows - below
        columns = np.arange(rows.shape[1])
        values = correlations[below, columns] * (1.0 - share) + correlations[below + 1, columns] * share
        return values.sum(axis=1)


def _disc(step: float, radius: float) -> np.ndarray:
    """(n, 2) points of a square grid within a circle."""
    steps = np.arange(-math.ceil(radius / step), math.ceil(radius / step) + 1) * step
    points = np.stack(np.meshgrid(steps, steps, indexing="ij"), axis=-1).reshape(-1, 2)
    return points[np.hypot(points[:, 0], points[:, 1]) <= radius]


def _angle(first: np.ndarray, second: np.ndarray) -> float:
    """Angle between two vectors of any length, rad."""
    cosine = first @ second / (np.linalg.norm(first) * np.linalg.norm(second) + 1e-300)
    return math.acos(max(-1.0, min(1.0, cosine)))


def _square(reach: float) -> np.ndarray:
    """(81, 2) points around the origin, up to `reach` away on each axis."""
    steps = np.linspace(-reach, reach, 9)
    return np.stack(np.meshgrid(steps, steps, indexing="ij"), axis=-1).reshape(-1, 2)
