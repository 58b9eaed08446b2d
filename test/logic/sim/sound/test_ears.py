"""Blocks of what is heard, and followers of time."""

from __future__ import annotations

import threading

import numpy as np
import pytest

from nao_sim_bridge.base.samples import pcm16, sine
from nao_sim_bridge.sound.ears import BLOCK
from nao_sim_bridge.sound.sources import SoundSource
from nao_sim_bridge.sound.timeline import LONGEST, Follower


@pytest.fixture
def loud(room):
    """A room with a radio."""
    one = room(background_db=30.0)
    one.sources.add(SoundSource("radio", (1.0, 0.5, 0.3), sine(1000.0, 5.0, 0.5), level_db=80.0, loop=True))
    return one


def times(blocks):
    return [block.time for block in blocks]


def joined(blocks):
    return np.concatenate([block.samples for block in blocks])


def test_blocks_follow_each_other_and_are_what_the_microphones_heard(loud):
    blocks = []
    listener = loud.ears.listen("test", blocks.append)
    loud.run(2.0)
    loud.ears.catch_up()
    listener.close()
    assert times(blocks) == pytest.approx([0.17 * k for k in range(11)])
    samples = joined(blocks)
    assert samples.shape == (11 * BLOCK, 4) and samples.dtype == np.int16
    assert np.abs(samples.astype(int) - pcm16(loud.microphones.heard(0.0, 11 * 0.17))).max() <= 1


def test_one_microphone_at_16_khz(loud):
    one, mean, wide = [], [], []
    loud.ears.listen("one", one.append, "16k1", "rear")
    loud.ears.listen("mean", mean.append, "16k1", "all")
    loud.ears.listen("wide", wide.append)
    loud.run(1.0)
    loud.ears.catch_up()
    assert all(block.samples.shape == (2720, 1) and block.rate == 16000 for block in one + mean)
    assert times(one) == times(wide)
    narrow, every_third = joined(one)[:, 0].astype(float), joined(wide)[::3].astype(float)
    # A tone of 1 kHz fits into both; noise above 8 kHz does not.
    assert np.abs(narrow - every_third[:, 3])[300:].max() < 40
    assert np.corrcoef(narrow[300:], every_third[300:, 3])[0, 1] > 0.999
    assert joined(mean)[300:, 0] == pytest.approx(every_third[300:].mean(axis=1), abs=40)


@pytest.mark.parametrize("wants, rate", [("48k4", 48000), ("16k1", 16000)])
def test_an_exact_listener_hears_from_its_first_to_its_last_moment(loud, wants, rate):
    loud.run(0.1)
    blocks, whole = [], []
    loud.ears.listen("whole", whole.append)  # who waits for a first whole block holds nobody up
    listener = loud.ears.listen("recorder", blocks.append, wants, exact=True)
    loud.run(0.05)
    assert not whole
    loud.run(0.95)
    listener.close()
    loud.run(1.0)
    loud.ears.catch_up()
    assert blocks[0].time == pytest.approx(0.1, abs=1e-4)
    assert sum(len(block.samples) for block in blocks) == rate
    for first, second in zip(blocks, blocks[1:]):
        assert first.end == pytest.approx(second.time)


def test_ears_lag_behind_a_slow_listener_and_ask_time_to_wait(loud):
    entered, go_on = threading.Event(), threading.Event()
    loud.ears.listen("slow", lambda block: entered.set() or go_on.wait(60.0))
    loud.run(0.2)
    assert entered.wait(60.0) and not loud.ears.holds()
    loud.run(0.3)
    assert loud.ears.lag == pytest.approx(0.34) and loud.ears.holds()
    go_on.set()
    loud.ears.catch_up(15.0)
    assert loud.ears.lag == 0.0 and not loud.ears.holds()


def test_what_cannot_be_worked_out_is_not_heard_and_holds_no_time_up(loud, monkeypatch):
    blocks, render = [], loud.microphones.render
    monkeypatch.setattr(loud.microphones, "render", lambda first, last: 1 / 0 if first < 0 else render(first, last))
    listener = loud.ears.listen("test", blocks.append, exact=True)
    loud.run(0.6)
    loud.ears.catch_up()
    assert not loud.ears.holds()
    listener.close()
    assert times(blocks)[0] == pytest.approx(0.17) and blocks[-1].end == pytest.approx(0.6, abs=1e-3)
    assert [one.error for one in loud.ears.guard.failures()] == ["ZeroDivisionError: division by zero"]


def test_a_follower_is_told_of_all_time_from_its_beginning_to_its_end(room):
    one, stretches = room(), []
    one.run(0.5)
    follower = Follower("test", one.timeline, lambda first, last: stretches.append((first, last)), step=4800)
    one.run(3.025)  # the last step is not complete
    follower.close()
    one.run(0.5)
    assert stretches[0][0] == 24000 and stretches[-1][1] == 3.525 * 48000
    assert all(second[0] == first[1] for first, second in zip(stretches, stretches[1:]))
    assert max(last - first for first, last in stretches) <= LONGEST
    assert follower.lag == 0.0
