"""The sound of a world, and of each robot in it: what it plays and what it hears."""

from __future__ import annotations

import itertools
from typing import Callable

from nao_sim_bridge.base.samples import RATE
from nao_sim_bridge.base.tasks import TaskIds
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.model.robot_model import RobotModel
from nao_sim_bridge.sound.ears import Ears
from nao_sim_bridge.sound.loudspeakers import Loudspeakers, RobotVoice
from nao_sim_bridge.sound.microphones import Microphones
from nao_sim_bridge.sound.settings import SoundSettings, load_sound_settings
from nao_sim_bridge.sound.sources import Sources
from nao_sim_bridge.sound.timeline import Timeline


class Air:
    """What robots in one world hear of it and of each other; settings are those of the file by default.

    `numbers` are for the names of sounds that nobody named.
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


class SoundWorld:
    """What sounds and what is heard. It stays at a reset of the simulation, which ends everything that plays.

    The seed is that of the background noise; `released` is called when time that waited for ears need not any more.
    """

    def __init__(self, model: RobotModel, air: Air, seed: int, released: Callable[[], None] = lambda: None) -> None:
        self.settings = air.settings
        self.timeline = air.timeline
        self.loudspeakers = Loudspeakers(self.timeline, air.ids)
        self.sources = air.sources
        self.numbers = air.numbers
        self.microphones = Microphones(
            model,
            self.settings,
            self.timeline,
            self.loudspeakers,
            self.sources,
            air.frames_per_tick,
            seed,
            lambda: [voice for voice in air.voices if voice is not self._voice],
        )
        self.ears = Ears(self.timeline, self.microphones, released, air.ids.guard)
        self._poses = self.microphones.poses
        self._voice = RobotVoice(
            model, self.settings, self.timeline, self.loudspeakers, self._poses, air.frames_per_tick
        )
        air.voices += (self._voice,)

    @property
    def time(self) -> float:
        """The time of now, s; any thread."""
        return self.timeline.now / RATE

    def begin(self, snapshot: Snapshot) -> None:
        """The robot has been put into the world; at the start and at each reset."""
        if not self._poses.knows(snapshot.tick):  # else a reset, from the next tick on: what is past stays
            self._poses.record(snapshot.tick, snapshot)

    def record(self, snapshot: Snapshot) -> None:
        """A tick has passed: where the head is at its end. `Air.tick` follows when all robots have done that."""
        self._poses.record(snapshot.tick, snapshot)

    def hear(self) -> None:
        """After `Air.tick`: let those who listen hear what can be heard now."""
        if self.timeline.now >= self.ears.due:
            self.ears.wake()

    def close(self) -> None:
        """End everything that the robot plays, and all listeners."""
        self.loudspeakers.stop_all()
        self.ears.close()
