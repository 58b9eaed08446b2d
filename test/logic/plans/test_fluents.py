"""Fluents: networks, pulses, and no wake-up that is lost."""

from __future__ import annotations

import numpy as np
import pytest

import nao_library_modules.process_modules as p


def test_networks_follow_their_inputs():
    a, b = p.Fluent("a", 2), p.Fluent("b", 3)
    networks = [
        (a + b, 5, 9), (1 + a, 3, 7), (a - b, -1, 3), (10 - a, 8, 4), (2 * a * b, 12, 36), (b / a, 1.5, 0.5),
        (6 / a, 3.0, 1.0), (a < b, True, False), (a <= 2, True, False), (a > 1, True, True), (a > 2, False, True),
        (a >= 2, True, True), (a >= b, False, True), (a.eq(2), True, False), ((a > 1) & (b > 1), True, True),
        (p.fl_or(a > 5, b > 5), False, True), ((a > 5) | (b > 5), False, True), (~p.fl_or(a > 5, b > 5), True, False),
        (p.fl_eq(a, b), False, False), (p.fl_not(p.fl_and(a, b)), False, False), (p.fl_funcall(max, a, b, 1), 3, 6),
    ]  # fmt: skip
    assert [network.value for network, _, _ in networks] == [before for _, before, _ in networks]
    a.value = 6
    assert [network.value for network, _, _ in networks] == [after for _, _, after in networks]
    assert (a + b * 2).name == "(a + b * 2)"


def test_a_value_that_is_set_pulses_unless_it_is_equal():
    fluent = p.Fluent("a", 1)
    fluent.value = 1
    assert fluent.pulses == 0
    fluent.value = 2
    fluent.pulse()
    assert fluent.pulses == 2
    picture = p.Fluent("values that cannot be compared", np.zeros(2))
    picture.value = np.zeros(2)
    assert picture.pulses == 1


def test_wait_for_answers_the_value_or_false_when_the_time_is_over():
    fluent = p.Fluent("a", 0)
    assert p.top_level(lambda: p.par(lambda: p.wait_for(fluent), lambda: setattr(fluent, "value", 7))) == [7, None]
    assert p.top_level(lambda: p.wait_for(fluent > 10, timeout=0.01)) is False


def test_a_change_of_value_counts_from_when_it_was_asked_for():
    fluent, ready = p.Fluent("a", 1), p.Fluent("ready", False)

    def changes():
        changed = p.fl_value_changed(fluent)
        assert not changed.value
        ready.value = True
        p.wait_for(changed)
        return fluent.value

    assert p.top_level(lambda: p.par(changes, lambda: (p.wait_for(ready), setattr(fluent, "value", 7))))[0] == 7


@pytest.mark.parametrize("missed, taken", [("once", 1), ("always", 3)])
def test_pulses_are_remembered_until_they_are_taken(missed, taken):
    fluent = p.Fluent("a", 0)
    pulses = p.pulsed(fluent, missed)
    for value in (1, 2, 3):
        fluent.value = value
    assert [pulses.take() for _ in range(4)] == [True] * taken + [False] * (4 - taken)


@pytest.mark.parametrize("missed, bodies", [("never", 1), ("once", 2), ("always", 4)])
def test_whenever_runs_at_pulses_and_treats_missed_ones_as_it_is_told(missed, bodies):
    fluent, end, runs = p.Fluent("a", 1), p.Fluent("end", False), []

    def body():
        runs.append(fluent.value)
        if len(runs) == 1:
            for _ in range(3):  # nothing pulses after the first run: what runs then was missed
                fluent.pulse()
        end.value = len(runs) == bodies

    p.top_level(lambda: p.pursue(p.do(p.whenever, fluent, body, missed), lambda: p.wait_for(end)))
    assert len(runs) == bodies
