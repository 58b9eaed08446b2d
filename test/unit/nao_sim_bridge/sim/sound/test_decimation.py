from __future__ import annotations

import numpy as np
import pytest

from nao_sim_bridge.sim.sound.decimation import REACH, third


def through(frequency):
    at = np.arange(-REACH, 4800 + REACH)
    return third(np.sin(2 * np.pi * frequency / 48000 * at).astype(np.float32))


@pytest.mark.parametrize("frequency", [100.0, 1000.0, 4000.0, 6500.0])
def test_tones_that_fit_come_through_without_delay(frequency):
    wanted = np.sin(2 * np.pi * frequency / 16000 * np.arange(1600))
    assert through(frequency) == pytest.approx(wanted, abs=0.01)


@pytest.mark.parametrize("frequency", [9500.0, 12000.0, 16000.0, 20000.0])
def test_tones_that_do_not_fit_are_gone(frequency):
    assert np.abs(through(frequency)).max() < 1e-3
