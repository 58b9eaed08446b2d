from __future__ import annotations

import numpy as np
import pytest

from nao_sim_bridge.sim.sound.envelope import PART, Envelope


def test_it_stays_until_set_and_then_goes_straight():
    envelope = Envelope((1.0,), 100)
    envelope.set(1000, (0.0,))
    assert envelope.at(999) == (1.0,) and envelope.at(1050) == pytest.approx((0.5,)) and envelope.at(5000) == (0.0,)
    assert envelope.between(0, 1000) == (1.0,)
    assert envelope.between(1100, 2000) == (0.0,)
    assert envelope.between(1000, 1100)[0] == pytest.approx(1.0 - np.arange(100) / 100)


def test_a_change_on_the_way_starts_where_it_is():
    envelope = Envelope((0.0, 1.0), 100)
    envelope.set(0, (1.0, 0.0))
    envelope.set(50, (0.5, 0.5))
    values = envelope.over(np.arange(0, 300))
    assert np.abs(np.diff(values[0])).max() <= 0.0101
    assert envelope.at(75) == pytest.approx((0.5, 0.5))


def test_the_past_never_changes():
    envelope = Envelope((0.0,), 100)
    frames = np.arange(0, 20000)
    known = np.zeros(0)
    for change, now in enumerate(range(0, 20000, 37)):
        known = np.concatenate([known, envelope.over(frames[len(known) : max(now, 1)])[0]])
        envelope.set(now, (change % 7,))
    assert envelope.over(frames[: len(known)])[0] == pytest.approx(known, abs=1e-9)


def test_many_changes_are_kept_in_parts_and_read_across_them():
    envelope = Envelope((0.0,), 10)
    for change in range(5 * PART):
        envelope.set(100 * change, (change + 1.0,))
    ends = np.array([100 * change + 99 for change in range(5 * PART)])
    assert envelope.over(ends)[0].tolist() == [change + 1.0 for change in range(5 * PART)]
    envelope.forget(100 * 4 * PART)
    assert envelope.at(100 * 4 * PART + 99) == (4 * PART + 1.0,)
    assert sum(len(part) for part in envelope._parts) < 3 * PART
