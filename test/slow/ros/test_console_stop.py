"""The console's stop with twenty pages open, while something tries to hold it up. Order counts, not time."""

from __future__ import annotations

from statistics import median

import pytest
from console_clients import (
    StopLine,
    StopWatch,
    Visitor,
    begun_trial,
    hanging_master,
    idle_connections,
    opened_pages,
    pasted_yaml,
    post_stop,
)

PATHS = [f"{path}?robot=/" for path in ("/", "/wizard", "/study", "/behaviors", "/functions")]
STOPS = 5


@pytest.fixture(scope="module")
def operator(program):
    visitor = Visitor(program.url)
    with opened_pages(visitor, PATHS):
        yield visitor


@pytest.fixture(scope="module")
def stops(operator):
    """Carry out a stop in each way, several times, and see its cancel at the server; `after`: called behind each."""
    watch, line = StopWatch(), StopLine(operator)

    def stop_again(after=lambda: None):
        for _ in range(STOPS):
            for stop in (line.stop, lambda: post_stop(operator)):
                watch.measure(stop)
                after()

    stop_again()
    yield stop_again
    line.close()
    watch.close()


def test_a_stop_waits_for_no_text_that_somebody_pastes(program, stops):
    with pasted_yaml(Visitor(program.observer)) as answered:
        seen = []
        stops(lambda: seen.append(answered()))
    # A stop that waited for the text would come behind its answer, each time.
    assert median(second - first for first, second in zip([0, *seen], seen)) < 1


def test_a_stop_waits_for_no_stranger(program, stops):
    with idle_connections(program.port):
        stops()
        assert Visitor(program.observer).get("/functions?robot=/")


def test_a_stop_waits_for_no_master_that_hangs_while_pages_are_opened(stack, operator, stops):
    with hanging_master(stack.master_pid, operator, PATHS * 2):
        stops()


def test_a_stop_waits_for_no_trial_that_begins_while_the_master_hangs(stack, operator, stops):
    with begun_trial(stack.master_pid, operator):
        stops()
