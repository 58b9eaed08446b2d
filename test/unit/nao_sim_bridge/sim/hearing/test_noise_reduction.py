"""Steady noise is taken out, and what stands out of it stays."""

from __future__ import annotations

import numpy as np
import pytest

from nao_sim_bridge.sim.hearing.noise_reduction import FRAME, noise_spectrum, reduce_noise

RATE = 16000


def noise(seconds, seed):
    return 0.01 * np.random.default_rng(seed).standard_normal(round(seconds * RATE)).astype(np.float32)


def level(samples):
    return 10.0 * np.log10(np.mean(np.square(samples, dtype=float)))


@pytest.fixture(scope="module")
def learnt():
    return noise_spectrum(noise(1.0, 1))


def test_noise_alone_is_lowered_to_about_the_least_gain(learnt):
    heard = noise(1.0, 2)
    lower = level(heard) - level(reduce_noise(heard, learnt, 0.25, 0.96))
    assert lower == pytest.approx(-20.0 * np.log10(0.25), abs=1.5)


def test_a_loud_tone_stays_and_the_noise_around_it_goes(learnt):
    tone = 0.3 * np.sin(2.0 * np.pi * 1000.0 * np.arange(RATE) / RATE)
    found = reduce_noise(tone + noise(1.0, 2), learnt, 0.25, 0.96)
    inside = slice(2 * FRAME, -2 * FRAME)
    assert level(found[inside] - tone[inside]) < level(noise(1.0, 2)) - 6.0


def test_without_noise_nothing_changes():
    speech = noise(0.5, 3)
    found = reduce_noise(speech, np.full(FRAME // 2 + 1, 1e-12), 0.25, 0.96)
    assert found == pytest.approx(speech, abs=1e-4)


@pytest.mark.parametrize("frames", [1, FRAME - 1, FRAME, 5000])
def test_any_length_keeps_its_length(learnt, frames):
    found = reduce_noise(noise(1.0, 4)[:frames], learnt, 0.25, 0.96)
    assert found.shape == (frames,) and np.isfinite(found).all()
