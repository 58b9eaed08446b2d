"""How often walking commands go to the robot."""

from __future__ import annotations

import pytest

from nao_library_modules.driver.walk_commands import Velocity
from nao_library_modules.driver.walk_pace import PACE, REFRESH, WalkPace

FORWARD, STAND = Velocity(0.5, 0.0, 0.0), Velocity(0.0, 0.0, 0.0)


def test_commands_keep_a_distance():
    pace = WalkPace()
    assert pace.pause(10.0) <= 0.0
    pace.sent(FORWARD, 10.0)
    assert pace.pause(10.01) == pytest.approx(PACE - 0.01)
    assert pace.pause(10.0 + PACE) <= 1e-9


def sent_times(velocity, period, count):
    """At which of many equal commands, one each period, the robot is told."""
    pace, times = WalkPace(), []
    for n in range(count):
        now = 10.0 + n * period
        if pace.is_news(velocity, now):
            pace.sent(velocity, now)
            times.append(n * period)
    return times


def test_a_velocity_that_lasts_is_told_once_a_second():
    times = sent_times(FORWARD, 0.02, 160)
    assert times == pytest.approx([0.0, REFRESH, 2 * REFRESH, 3 * REFRESH], abs=0.021)


def test_an_idle_stick_is_told_once():
    assert sent_times(STAND, 0.02, 500) == [0.0]


def test_a_standstill_after_a_break_is_told_again():
    assert sent_times(STAND, 1.5, 3) == [0.0, 1.5, 3.0]


def test_changes_and_what_follows_another_command_are_news():
    pace = WalkPace()
    assert pace.is_news(FORWARD, 10.0)
    pace.sent(FORWARD, 10.0)
    assert pace.is_news(STAND, 10.1)
    assert not pace.is_news(FORWARD, 10.2)
    pace.sent(None, 10.3)
    assert pace.is_news(FORWARD, 10.4)
