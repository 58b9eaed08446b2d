"""Eyes that blink until they are told to stop."""

from __future__ import annotations

import random

import pytest

from nao_library_modules.driver.blinking import Blinks, blink, fade
from nao_library_modules.driver.goal_crowd import Replaced
from nao_library_modules.errors import BadGoal, Preempted
from nao_library_modules.interrupt import Interrupt

RED, GREEN, BLACK = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 0.0)
BLINKS = Blinks([RED, GREEN], BLACK, 0.3, 2.0, 0.5)


class CountingClock:
    """Time that passes by waiting; triggers an interrupt after some waits."""

    def __init__(self, interrupt, waits, reason=None):
        self.waits = []
        self._interrupt, self._left, self._reason = interrupt, waits, reason

    def wait(self, duration, interrupt):
        self.waits.append(duration)
        self._left -= 1
        if self._left == 0:
            interrupt.trigger(self._reason)
        return not interrupt.is_set()


@pytest.fixture
def interrupt():
    return Interrupt()


@pytest.fixture
def fades(monkeypatch, robot_of_head):
    """Calls of fadeRGB, which take no time."""
    monkeypatch.setattr(robot_of_head.leds, "_slow", lambda name: None)
    return robot_of_head.proxy("ALLeds").calls


@pytest.fixture
def robot_of_head():
    from fake_robot import FakeRobot

    return FakeRobot()


def test_a_blink_takes_thirds_and_pauses_follow(robot_of_head, fades, interrupt):
    clock, told = CountingClock(interrupt, 6), []
    assert blink(robot_of_head, BLINKS, clock, interrupt, told.append, random.Random(1)) is False
    assert clock.waits[0::2] == pytest.approx([0.1] * 3)
    assert all(0.0 <= pause <= 3.5 for pause in clock.waits[1::2])
    colours = [tuple(call[2:5]) for call in fades]
    assert colours[1::2][:3] == [BLACK] * 3 and colours[0:6:2] == told
    assert all(call[1] == "FaceLeds" and call[5] == pytest.approx(0.1) for call in fades[:6])
    assert fades[-1] == ("fadeRGB", "FaceLeds", 0.0, 0.0, 0.0, 0.0), "the eyes end in the background's colour"


def test_a_newer_goal_takes_the_eyes_as_they_are(robot_of_head, fades, interrupt):
    clock = CountingClock(interrupt, 1, Replaced())
    assert blink(robot_of_head, BLINKS, clock, interrupt, lambda _: None, random.Random(1)) is True
    assert len(fades) == 1


def test_a_fade_ends_with_the_interrupt(robot_of_head, interrupt):
    interrupt.trigger()
    with pytest.raises(Preempted):
        fade(robot_of_head, "FaceLeds", RED, 10.0, interrupt)
    assert robot_of_head.leds.pending[0].canceled


def test_pauses_are_cut_at_both_ends():
    chance = random.Random(3)
    pauses = [Blinks([RED], BLACK, 0.3, 1.0, 2.0).pause(chance) for _ in range(2000)]
    assert min(pauses) == 0.0 and max(pauses) <= 7.0
    assert 1.0 < sum(pauses) / len(pauses) < 1.6


@pytest.mark.parametrize(
    "blinks, words",
    [
        (Blinks([], BLACK, 0.3, 1.0, 0.1), "colors"),
        (Blinks([(0.0, 2.0, 0.0)], BLACK, 0.3, 1.0, 0.1), r"colors\[0\]"),
        (Blinks([RED], (0.0, 0.0, -1.0), 0.3, 1.0, 0.1), "bg_color"),
        (Blinks([RED], BLACK, 0.0, 1.0, 0.1), "blink_duration"),
        (Blinks([RED], BLACK, 0.3, 0.0, 0.1), "blink_rate_mean"),
        (Blinks([RED], BLACK, 0.3, float("nan"), 0.1), "blink_rate_mean"),
        (Blinks([RED], BLACK, 0.3, 1.0, -0.1), "blink_rate_sd"),
    ],
)
def test_what_cannot_be_blinked_is_told(blinks, words):
    with pytest.raises(BadGoal, match=words):
        blinks.check()


def test_a_deviation_of_nothing_is_allowed():
    blinks = Blinks([RED], BLACK, 0.3, 1.0, 0.0)
    blinks.check()
    assert blinks.pause(random.Random(0)) == 1.0
