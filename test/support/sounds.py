"""Sounds of tests with a simulated robot: files, sources in its world, what was played, how loud and high it is."""

from __future__ import annotations

import numpy as np
import soundfile

from nao_sim_bridge.base.samples import Sound
from nao_sim_bridge.sound.sources import SoundSource

RATE = 48000


def loudness(samples):
    return float(np.sqrt(np.mean(np.square(samples, dtype=float))))


def frequency(samples, rate=RATE):
    """Of the strongest tone, Hz."""
    spectrum = np.abs(np.fft.rfft(samples * np.hanning(len(samples))))
    return np.argmax(spectrum) * rate / len(samples)


def tone(hertz, seconds, peak=0.5, rate=RATE):
    return peak * np.sin(2.0 * np.pi * hertz * np.arange(round(seconds * rate)) / rate)


def noise(seconds, seed=3):
    return 0.2 * np.random.default_rng(seed).standard_normal(round(RATE * seconds)).clip(-4, 4)


def write(robot, name, samples, rate=RATE, **options):
    """A sound file in the folder of the robot's clients; its path."""
    path = robot.server.files.folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    soundfile.write(str(path), samples, rate, **options)
    return path


def read(robot, name):
    """(frames, channels) of a file there, and its rate."""
    return soundfile.read(str(robot.server.files.folder / name), always_2d=True)


def sound_of(path):
    """A file of our own as a Sound."""
    return Sound(*soundfile.read(str(path), dtype="float32", always_2d=True))


def played(robot, begin, end=None):
    """(frames, 2) of what the loudspeakers played between two simulated times, s; up to now without the second."""
    speakers = robot.server.simulation.sound.loudspeakers
    return robot.server.runner.call(lambda: speakers.played(begin, robot.now.time if end is None else end)).samples


def span(robot, begin):
    """Simulated times of the first and the last sound since `begin`, s."""
    loud = np.flatnonzero(np.abs(played(robot, begin)).max(axis=1) > 1e-4) / RATE
    return begin + loud[0], begin + loud[-1]


def put(robot, place, samples, level_db=65.0, loop=False, name="source"):
    """A source of sound in the world, so loud at 1 m."""
    source = SoundSource(name, tuple(place), Sound(np.asarray(samples, np.float32)), level_db=level_db, loop=loop)
    robot.server.runner.call(lambda: robot.server.simulation.sound.sources.add(source))


def take(robot, name="source"):
    """End a source."""
    robot.server.runner.call(lambda: robot.server.simulation.sound.sources.remove(name))


def until(robot, future, limit=30.0):
    """Let time pass until a call is over; how long that took, in simulated s, exact to 0.05 s."""
    began = robot.now.time
    robot.settled()
    while future.isRunning() and robot.now.time < began + limit:
        robot.advance(0.05)
    robot.answer(future)
    return robot.now.time - began
