"""Loudspeakers on a bench: simulated time without a robot, passed on by hand. And those of a simulated robot."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from nao_sim_bridge.sim.sound.loudspeakers import Loudspeakers
from nao_sim_bridge.sim.sound.samples import RATE, Sound
from nao_sim_bridge.sim.sound.timeline import Timeline
from nao_sim_bridge.sim.tasks import Task, TaskIds

TICK = 200
"""Frames between two ticks of the bench; no divisor of what is played."""


class SoundBench:
    """What services want of a simulation and its runner, as far as sound goes."""

    def __init__(self):
        self.timeline = Timeline(60.0)
        self.task_ids = TaskIds()
        self.task_ids.ask = lambda task: task.kill()
        self.sound = SimpleNamespace(loudspeakers=Loudspeakers(self.timeline, self.task_ids))

    @property
    def time(self):
        return self.timeline.now / RATE

    @property
    def loudspeakers(self):
        return self.sound.loudspeakers

    def advance(self, seconds):
        end = self.timeline.now + round(seconds * RATE)
        while self.timeline.now < end:
            self.timeline.tick(min(self.timeline.now + TICK, end))

    def execute(self, command, name="command"):
        """As the runner does it, at once."""
        task = Task(name, 0)
        try:
            task.finish(command())
        except Exception as error:
            task.finish(error=error)
        return task

    def played(self, begin, end):
        """(frames, 2) of what was played."""
        return self.loudspeakers.played(begin, end).samples


@pytest.fixture
def bench():
    return SoundBench()


@pytest.fixture
def noise():
    """Makes noise of a length in s."""
    random = np.random.default_rng(1)
    return lambda seconds, channels=1: Sound(
        random.uniform(-0.5, 0.5, (round(seconds * RATE), channels)).astype(np.float32), RATE
    )


@pytest.fixture
def device(robot):
    device = robot.ALAudioDevice
    device.setOutputVolume(100)
    device.muteAudioOut(False)
    device.openAudioOutputs()
    device.openAudioInputs()
    device.setParameter("outputSampleRate", 48000)
    yield device
    device.disableEnergyComputation()
    device.setFileAsInput("")
    device.flushAudioOutputs()


@pytest.fixture
def sound(robot):
    return robot.server.simulation.sound
