from __future__ import annotations

import threading

import pytest

from nao_sim_bridge.sim.sound.follower import LONGEST, Follower


@pytest.fixture
def followed(room):
    """A room, and a follower of its time with the stretches that it was told of."""
    one = room()
    one.run(0.5)
    stretches = []
    follower = Follower("test", one.timeline, lambda first, last: stretches.append((first, last)), step=4800)
    yield one, follower, stretches
    follower.close()


def test_it_is_told_of_all_time_from_its_beginning_to_its_end(followed):
    one, follower, stretches = followed
    one.run(3.0)
    follower.close()
    one.run(0.5)
    assert stretches[0][0] == 24000 and stretches[-1][1] == 3.5 * 48000
    assert all(second[0] == first[1] for first, second in zip(stretches, stretches[1:]))
    assert max(last - first for first, last in stretches) <= LONGEST
    assert follower.lag == 0.0


def test_the_end_is_told_even_when_no_step_was_complete(followed):
    one, follower, stretches = followed
    one.run(0.025)
    follower.close()
    assert stretches == [(24000, 25200)]


def test_it_lags_while_it_works(room, patience):
    one, entered, go_on = room(), threading.Event(), threading.Event()

    def handle(first, last):
        entered.set()
        assert go_on.wait(patience)

    follower = Follower("slow", one.timeline, handle, step=4800)
    one.run(0.2)
    assert entered.wait(patience)
    one.run(1.0)
    assert follower.lag == pytest.approx(1.2)
    go_on.set()
    follower.close()
    assert follower.lag == 0.0


def test_one_that_fails_ends_and_says_so(room, caplog, patience):
    one = room()
    follower = Follower("bad one", one.timeline, lambda first, last: 1 / 0, step=4800)
    one.run(0.5)
    follower._thread.join(patience)
    one.run(0.5)
    assert "bad one has ended" in caplog.text and follower.lag == 0.0
