"""How loud the robot's own loudspeakers are in its microphones."""

from __future__ import annotations

import numpy as np

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.model.robot_model import RobotModel
from nao_sim_bridge.sound.sound_world import SoundWorld

FULL_SCALE = 32768.0


class OwnVoice:
    """Works out what the loudspeakers add to the microphones. Any thread."""

    def __init__(self, model: RobotModel, sound: SoundWorld) -> None:
        self._sound = sound
        speakers = np.array([place.position for place in model.loudspeakers])
        distances = np.linalg.norm(sound.microphones.places[None] - speakers[:, None], axis=-1)
        settings = sound.settings
        # Each of the two gives half of what both give together at 1 m.
        gains = settings.peak_of(settings.loudspeaker_full_scale_db) / 2.0
        gains = gains / np.maximum(distances, settings.near_field_m) * FULL_SCALE
        self._powers = (gains**2).mean(axis=1)

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
