"""What other robots hear of a robot: its loudspeakers as one source that moves with its head."""

from __future__ import annotations

import numpy as np

from nao_sim_bridge.model.robot_model import RobotModel
from nao_sim_bridge.sound.loudspeakers import Loudspeakers
from nao_sim_bridge.sound.poses import PoseTrack
from nao_sim_bridge.sound.settings import SoundSettings
from nao_sim_bridge.sound.timeline import Timeline


class RobotVoice:
    """The loudspeakers of a robot, heard from outside: half-way between the two. Any thread."""

    def __init__(
        self,
        model: RobotModel,
        settings: SoundSettings,
        timeline: Timeline,
        loudspeakers: Loudspeakers,
        poses: PoseTrack,
        frames_per_tick: int,
    ) -> None:
        self.loudspeakers = loudspeakers
        self._timeline = timeline
        self._poses = poses
        self._tick = frames_per_tick
        self._mouth = np.mean([place.position for place in model.loudspeakers], axis=0)[None]
        # Each of the two gives half of what both give together at 1 m.
        self._peak = np.float32(settings.peak_of(settings.loudspeaker_full_scale_db) / 2.0)

    def silent(self, first: int, last: int) -> bool:
        """Whether nothing has been played from frame `first` to `last`."""
        return not self.loudspeakers.sounds(first, last)

    def at(self, frames: np.ndarray) -> np.ndarray:
        """(..., 3) where it is at `frames` of any shape, none after now, in world, m; straight between two ticks."""
        newest = self._timeline.now // self._tick
        flat = np.minimum(frames.ravel() / self._tick, newest)
        first = int(np.floor(flat.min()))
        last = min(int(np.ceil(flat.max())), newest)
        places = self._poses.at(first, max(first, last)).place(self._mouth)[:, 0]
        knots = np.arange(first, first + len(places))
        lines = [np.interp(flat, knots, places[:, axis]) for axis in range(3)]
        return np.stack(lines, axis=-1).reshape((*frames.shape, 3))

    def dry(self, first: int, last: int) -> np.ndarray | None:
        """(last - first,) what it gives off, as a microphone at 1 m has it; None when that is nothing."""
        mixed = self.loudspeakers.mixed(first, last)
        return None if mixed is None else (mixed[:, 0] + mixed[:, 1]) * self._peak
