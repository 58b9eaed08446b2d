"""How loud the own loudspeakers are at the microphones, foretold and heard."""

from __future__ import annotations

import numpy as np
import pytest

from nao_sim_bridge.sim.hearing.own_voice import OwnVoice
from nao_sim_bridge.sim.sound.samples import RATE, Sound, sine


@pytest.fixture
def robot(bench):
    one = bench(stiffness=0.0)
    one.sound = one.simulation.sound
    one.own = OwnVoice(one.model, one.sound)
    return one


def test_it_is_what_the_microphones_hear(robot):
    chance = np.random.default_rng(3)
    robot.sound.loudspeakers.play(Sound(0.1 * chance.standard_normal(RATE).astype(np.float32)), "noise")
    robot.run(0.8)
    heard = robot.sound.microphones.heard(0.3, 0.6).astype(float) * 32768.0
    assert robot.own.power(0.3, 0.6) == pytest.approx(np.mean(heard**2), rel=0.1)


def test_one_side_is_less_than_both(robot):
    robot.sound.loudspeakers.play(sine(500.0, 1.0), "left", pan=-1.0)
    robot.run(0.8)
    left = robot.own.power(0.3, 0.6)
    robot.sound.loudspeakers.play(sine(500.0, 1.0), "right", pan=1.0)
    robot.run(0.8)
    assert robot.own.power(0.85, 0.95) == pytest.approx(2.0 * left, rel=0.1)


def test_nothing_is_added_when_nothing_plays_or_a_file_is_heard(robot):
    robot.run(0.5)
    assert robot.own.power(0.1, 0.4) == 0.0
    robot.sound.loudspeakers.play(sine(500.0, 1.0), "tone")
    robot.run(0.5)
    assert robot.own.power(0.6, 0.9) > 0.0
    robot.sound.microphones.replaced_by = sine(300.0, 1.0)
    assert robot.own.power(0.6, 0.9) == 0.0
