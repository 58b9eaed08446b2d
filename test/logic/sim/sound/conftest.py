"""A room with a robot's head and sounds in it, without physics: time passes when a test says so."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import pytest

from nao_sim_bridge.base.readings import Pose
from nao_sim_bridge.base.samples import RATE
from nao_sim_bridge.base.tasks import TaskIds
from nao_sim_bridge.model.model_reader import load_model
from nao_sim_bridge.sound.files import SoundReader
from nao_sim_bridge.sound.settings import load_sound_settings
from nao_sim_bridge.sound.sound_world import Air, SoundWorld

TICK = 1.0 / 120.0
UPRIGHT = (0.0, 0.0, 0.0, 1.0)


class Room:
    """Sound of a robot whose torso and head are where a test puts them.

    Attributes:
        torso: Pose of the torso in world.
        yaw: Of the head, rad.
        pitch: Of the head, rad.
        moves: Called at each tick with the time in s, to change these.
    """

    def __init__(self, seed=0, **settings):
        self.model = load_model()
        settings.setdefault("background_db", -60.0)
        self.ids = TaskIds()
        self.air = Air(self.ids, TICK, replace(load_sound_settings(), **settings))
        self.world = SoundWorld(self.model, self.air, seed)
        self.torso = Pose((0.0, 0.0, 0.0), UPRIGHT)
        self.yaw = self.pitch = 0.0
        self.moves = None
        self._tick = 0
        self.world.begin(self.snapshot)

    def __getattr__(self, name):
        return getattr(self.world, name)

    @property
    def snapshot(self):
        return SimpleNamespace(tick=self._tick, torso=self.torso, positions=(self.yaw, self.pitch, *[0.0] * 24))

    def run(self, seconds):
        for _ in range(round(seconds / TICK)):
            self._tick += 1
            if self.moves is not None:
                self.moves(self._tick * TICK)
            self.world.record(self.snapshot)
            self.air.tick(self._tick)
            self.world.hear()

    def frames(self, from_s, to_s):
        """(4, frames) heard."""
        return self.world.microphones.heard(from_s, to_s).T

    @property
    def now(self):
        return round(self._tick * TICK * RATE)


@pytest.fixture
def room():
    """Makes rooms; the settings of sound can be changed by name."""
    made = []

    def make(**options):
        made.append(Room(**options))
        return made[-1]

    yield make
    for one in made:
        one.world.close()


@pytest.fixture(scope="module")
def reader():
    reading = SoundReader()
    yield reading
    reading.close()
