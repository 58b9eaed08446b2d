"""The air of a world: the clock of sound, what sounds in the world, and the voices of the robots in it."""

from __future__ import annotations

import itertools

from nao_sim_bridge.base.samples import RATE
from nao_sim_bridge.base.tasks import TaskIds
from nao_sim_bridge.sound.robot_voice import RobotVoice
from nao_sim_bridge.sound.settings import SoundSettings, load_sound_settings
from nao_sim_bridge.sound.sources import Sources
from nao_sim_bridge.sound.timeline import Timeline


class Air:
    """What robots in one world hear of it and of each other.

    Attributes:
        timeline: The clock of sound.
        numbers: For the names of sounds that nobody named.

    Args:
        settings: None for those of the file.
    """

    def __init__(self, ids: TaskIds, tick_s: float, settings: SoundSettings | None = None) -> None:
        self.settings = settings or load_sound_settings()
        self.ids = ids
        self.tick_s = tick_s
        self.timeline = Timeline(self.settings.keep_s, ids.guard)
        self.sources = Sources(self.timeline, ids, self.settings)
        self.numbers = itertools.count(1)
        self.voices: tuple[RobotVoice, ...] = ()

    @property
    def frames_per_tick(self) -> int:
        """Length of a tick in frames."""
        return round(self.tick_s * RATE)

    def tick(self, tick: int) -> None:
        """A tick has passed, and all robots know where their heads are at its end."""
        self.timeline.tick(round(tick * self.tick_s * RATE))

    def stop_all(self) -> None:
        for voice in self.voices:
            voice.loudspeakers.stop_all()
        self.sources.clear()
