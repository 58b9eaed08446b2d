"""Follows what the microphones hear, and says of each block where its sound comes from, if there is one."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Callable, Sequence

import numpy as np

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.hearing.detection import START, SoundDetector
from nao_sim_bridge.hearing.localisation import UPRIGHT, DirectionFinder, MicrophoneArray
from nao_sim_bridge.hearing.spectra import CrossSpectra, cross_spectra
from nao_sim_bridge.sound.sound_world import SoundWorld

# What is taken for a quiet room before anything was heard: power in samples of int16 squared, about 36 dB SPL. A sound
# that is there from the first moment on is found then; a noise without a direction is not, however loud.
QUIET = 170.0
# Coherence of what comes from nowhere in particular, and from which confidence on it is a direction.
NO_COHERENCE, LEAST_CONFIDENCE = 0.3, 0.3
# A frequency counts when it has more than this times the power of the background.
ABOVE_BACKGROUND = 2.0
# The own voice hides other sounds when it has more than this share of the power at the microphones.
MOST_OWN = 0.1
FULL_SCALE = 32768.0


@dataclass(frozen=True)
class HeardSound:
    """A sound that was located, in the frame of the head as `Bearing`, with a confidence of 0..1.

    Its time is the simulated one at which it begins in the block, or of the block itself if it has begun before, s; its
    energy is the root mean square of the samples, 0..32768.
    """

    time: float
    azimuth: float
    elevation: float
    confidence: float
    energy: float


class Localiser:
    """Locates the sounds that stand out from the background, in samples of `rate` Hz."""

    def __init__(self, array: MicrophoneArray, rate: int) -> None:
        self._detector = SoundDetector(rate, QUIET)
        self._finder = DirectionFinder(array, rate)

    @property
    def sensitivity(self) -> float:
        """0..1; the higher, the softer a sound may be."""
        return self._detector.sensitivity

    @sensitivity.setter
    def sensitivity(self, value: float) -> None:
        self._detector.sensitivity = value

    def feed(
        self,
        samples: np.ndarray,
        time: float,
        up: Sequence[float] = UPRIGHT,
        own_power: Callable[[], float] = lambda: 0.0,
    ) -> HeardSound | None:
        """Listen to a block, (n, microphones) int16 from `time`, s, on; the sound that stands out and has a direction.

        `up` is the unit vector upwards in the world, in the frame of the head. `own_power` tells what the own
        loudspeakers add to the mean square of the samples; it is asked when it matters.
        """
        edges = self._detector.feed(samples, time)
        if not self._detector.loud:
            return None
        power = float(np.mean(samples.astype(np.float32) ** 2))
        if own_power() > MOST_OWN * power:
            return None
        # What does not stand out from the background is no part of the sound: so a fan does not hide a voice.
        spectra = cross_spectra(self._detector.spectra)
        noise = np.maximum(spectra.noise, ABOVE_BACKGROUND * self._detector.background)
        bearing = self._finder.find(CrossSpectra(spectra.products, noise), up)
        confidence = (bearing.coherence - NO_COHERENCE) / (1.0 - NO_COHERENCE)
        if confidence < LEAST_CONFIDENCE:
            return None
        begun = [edge.time for edge in edges if edge.kind == START]
        return HeardSound(
            max([time, *begun[:1]]), bearing.azimuth, bearing.elevation, min(confidence, 1.0), math.sqrt(power)
        )


class OwnVoice:
    """Works out what the loudspeakers add to the microphones. Any thread."""

    def __init__(self, sound: SoundWorld) -> None:
        self._sound = sound
        self._powers = ((sound.microphones.own_gains * FULL_SCALE) ** 2).mean(axis=1)

    def power(self, from_s: float, to_s: float) -> float:
        """Mean square of int16 samples that the loudspeakers make between two simulated times, s.

        What is longer ago than is remembered was silent: nobody could tell any more.
        """
        if self._sound.microphones.replaced_by is not None:
            return 0.0
        try:
            played = self._sound.loudspeakers.played(from_s, to_s).samples
        except BadValue:
            return 0.0
        return float((played.astype(np.float64) ** 2).mean(axis=0) @ self._powers) if len(played) else 0.0
