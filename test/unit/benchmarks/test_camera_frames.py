"""The program that times camera frames must time new ones, and pictures of the same things."""

from __future__ import annotations

import numpy as np
import pytest
from nao_benchmarks.errors import BenchmarkError


def test_both_kinds_of_frames_are_timed_equally_often(program):
    times = program.time_frames(2, "320x240")
    assert len(times["ours"]) == len(times["reference"]) == 2
    assert min(times["ours"] + times["reference"]) > 0.0


def test_an_old_frame_is_no_measurement(program, monkeypatch):
    monkeypatch.setattr(program, "RATE", 5)
    monkeypatch.setattr(program.Simulation, "tick", lambda simulation: None)
    monkeypatch.setattr(program, "PATIENCE", 0.1)
    with pytest.raises((BenchmarkError, TimeoutError)):
        program.time_frames(2, "320x240")


def test_the_bare_picture_shows_the_same_room(program, monkeypatch):
    """What is bright and dark in one is so in the other."""
    simulation = program.Simulation(program.Scene(world=program.WORLD, posture="Stand"))
    bare = program.Bare(simulation, 320, 240)
    pictures = []
    take = program.pybullet.getCameraImage
    monkeypatch.setattr(program.pybullet, "getCameraImage", lambda *a, **k: pictures.append(take(*a, **k)))
    bare.take()
    rgb = np.asarray(pictures[0][2], np.float32).reshape(240, 320, 4)[..., :3]
    stream = simulation.cameras.open("test", program.TOP, 1, program.RGB, 30)
    simulation.run(0.02)
    ours = stream.take(60.0).array().astype(np.float32)
    simulation.close()
    bare.close()
    blocks = [picture.mean(axis=2).reshape(12, 20, 16, 20).mean(axis=(1, 3)).ravel() for picture in (rgb, ours)]
    assert np.corrcoef(*blocks)[0, 1] > 0.6
