"""When commands that cease become too old."""

from __future__ import annotations

import pytest

from nao_library_modules.driver.walk_watchdog import WalkWatchdog


def test_it_watches_from_the_first_command_on():
    watchdog = WalkWatchdog(0.5)
    assert watchdog.left(7.0) is None
    watchdog.feed(10.0)
    assert watchdog.left(10.2) == pytest.approx(0.3)
    watchdog.feed(10.4)
    assert watchdog.left(10.5) == pytest.approx(0.4)
    assert watchdog.left(11.0) == pytest.approx(-0.1)


def test_it_watches_nothing_that_rests_and_nothing_without_a_limit():
    watchdog = WalkWatchdog(0.5)
    watchdog.feed(10.0)
    watchdog.rest()
    assert watchdog.left(20.0) is None
    for_ever = WalkWatchdog(0.0)
    for_ever.feed(10.0)
    assert for_ever.left(20.0) is None


def test_a_clock_that_is_set_back_gives_the_whole_time_again():
    watchdog = WalkWatchdog(0.5)
    watchdog.feed(1000.0)
    assert watchdog.left(1.0) == pytest.approx(0.5)
    assert watchdog.left(1.6) == pytest.approx(-0.1)
