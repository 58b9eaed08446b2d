"""Fluents: networks, pulses, and no wake-up that is lost."""

from __future__ import annotations

import threading

import numpy as np
import pytest

from nao_library_modules.process_modules.control import do, par, pursue, top_level
from nao_library_modules.process_modules.failures import PlanError
from nao_library_modules.process_modules.fluents import (
    AnyFluent,
    Fluent,
    fl_and,
    fl_eq,
    fl_funcall,
    fl_not,
    fl_or,
    fl_value_changed,
    pulsed,
)
from nao_library_modules.process_modules.waiting import wait_for, whenever


def test_networks_follow_their_inputs():
    a, b = Fluent("a", 2), Fluent("b", 3)
    networks = {
        "sum": a + b,
        "reversed": 10 - a,
        "product": 2 * a * b,
        "share": b / a,
        "less": a < b,
        "at least": a >= 2,
        "equal": a.eq(2),
        "both": (a > 1) & (b > 1),
        "one": fl_or(a > 5, b > 5),
        "none": ~fl_or(a > 5, b > 5),
        "same": fl_eq(a, b),
        "not": fl_not(fl_and(a, b)),
        "most": fl_funcall(max, a, b, 1),
    }
    values = {name: network.value for name, network in networks.items()}
    assert values == {
        "sum": 5,
        "reversed": 8,
        "product": 12,
        "share": 1.5,
        "less": True,
        "at least": True,
        "equal": True,
        "both": True,
        "one": False,
        "none": True,
        "same": False,
        "not": False,
        "most": 3,
    }
    a.value = 6
    assert networks["sum"].value == 9 and networks["one"].value and not networks["less"].value
    assert (a + b * 2).name == "(a + b * 2)"


def test_an_equal_value_does_not_pulse_and_another_one_does():
    fluent = Fluent("a", 1)
    fluent.value = 1
    assert fluent.pulses == 0
    fluent.value = 2
    fluent.pulse()
    assert fluent.pulses == 2


def test_values_that_cannot_be_compared_pulse_whenever_they_are_set():
    fluent = Fluent("picture", np.zeros(2))
    fluent.value = np.zeros(2)
    assert fluent.pulses == 1


def test_nobody_takes_a_fluent_for_its_value():
    with pytest.raises(PlanError, match="the fluent door is neither true nor false"):
        bool(Fluent("door", True))


def test_wait_for_answers_the_value_or_false_when_the_time_is_over():
    fluent = Fluent("a", 0)
    assert top_level(lambda: par(lambda: wait_for(fluent), lambda: setattr(fluent, "value", 7))) == [7, None]
    assert top_level(lambda: wait_for(fluent > 10, timeout=0.01)) is False
    assert fluent._listeners == ()


def test_a_change_of_value_is_counted_from_when_it_was_asked_for():
    fluent = Fluent("a", 1)
    changed = fl_value_changed(fluent)
    assert not changed.value
    fluent.value = 2
    assert changed.value


@pytest.mark.parametrize("missed, taken", [("once", 1), ("always", 3)])
def test_pulses_are_remembered_until_they_are_taken(missed, taken):
    fluent = Fluent("a", 0)
    pulses = pulsed(fluent, missed)
    for value in (1, 2, 3):
        fluent.value = value
    assert [pulses.take() for _ in range(4)] == [True] * taken + [False] * (4 - taken)


@pytest.mark.parametrize("missed, bodies", [("never", 1), ("once", 2), ("always", 4)])
def test_whenever_runs_at_pulses_and_treats_missed_ones_as_it_is_told(missed, bodies):
    fluent, end = Fluent("a", 0), Fluent("end", False)
    runs = []

    def body():
        runs.append(fluent.value)
        if len(runs) == 1:
            for _ in range(3):
                fluent.pulse()
        if len(runs) == bodies:
            end.value = True

    def plan():
        fluent.value = 1
        wait_for(end)

    # Nothing pulses after the first run: what runs then was missed.
    fluent.value = 1
    top_level(lambda: pursue(do(whenever, fluent, body, missed), lambda: wait_for(end)))
    assert len(runs) == bodies


def test_whenever_leaves_pulses_out_at_which_it_is_not_true():
    fluent, end = Fluent("a", 0), Fluent("end", False)
    seen = []

    def body():
        seen.append(fluent.value)
        fluent.value = 0
        end.value = True

    def pulse():
        fluent.pulse()
        fluent.value = 5
        wait_for(end)

    top_level(lambda: pursue(do(whenever, fluent, body), pulse))
    assert seen == [5]


def test_an_unknown_policy_about_pulses_is_an_error():
    with pytest.raises(PlanError, match="missed is 'twice': never, once or always"):
        pulsed(Fluent("a"), "twice")


def test_no_wake_up_is_lost_between_many_threads():
    """Two counters chase each other; a wake-up that is lost would leave both waiting."""
    ping, pong = Fluent("ping", 0), Fluent("pong", 0)
    rounds, players = 300, 8
    total = rounds * players

    def player():
        for _ in range(rounds):
            mine = ping.update(lambda count: count + 1)
            wait_for(pong >= mine)

    def echo():
        seen = 0
        while seen < total:
            seen = wait_for(fl_funcall(lambda count, seen=seen: count if count > seen else 0, ping))
            pong.value = seen

    top_level(lambda: par(echo, *[player] * players))
    assert ping.value == pong.value == total


def test_changes_from_outside_of_plans_wake_who_waits():
    fluent = Fluent("a", 0)

    def count():
        for _ in range(500):
            fluent.update(lambda value: value + 1)

    threads = [threading.Thread(target=count) for _ in range(4)]
    for thread in threads:
        thread.start()
    assert top_level(lambda: wait_for(fluent >= 2000)) is True
    for thread in threads:
        thread.join()


def test_a_kind_of_fluent_without_its_own_value_cannot_be_made():
    class Nothing(AnyFluent):
        def listen(self, listener):
            pass

    with pytest.raises(TypeError, match="abstract.*pulses.*unlisten.*value"):
        Nothing("nothing")
