"""Fluents that many threads hammer: no pulse is lost, none is counted twice, nobody is left listening."""

from __future__ import annotations

import threading

import pytest

from nao_library_modules.process_modules.control import do, par, pursue, top_level
from nao_library_modules.process_modules.failures import PlanFailure, fail
from nao_library_modules.process_modules.flow import checkpoint, sleep, wait_until
from nao_library_modules.process_modules.fluents import (
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

THREADS = 8
ROUNDS = 400


def in_threads(*bodies):
    """Threads that have begun, all at the same moment."""
    barrier = threading.Barrier(len(bodies))

    def run(body):
        barrier.wait(10.0)
        body()

    threads = [threading.Thread(target=run, args=(body,)) for body in bodies]
    for thread in threads:
        thread.start()
    return threads


def join(threads):
    for thread in threads:
        thread.join(60.0)
        assert not thread.is_alive()


def counts(fluent):
    def body():
        for _ in range(ROUNDS):
            fluent.update(lambda value: value + 1)

    return body


def test_updates_of_many_threads_are_all_counted():
    fluent = Fluent("a", 0)
    join(in_threads(*[counts(fluent)] * THREADS))
    assert fluent.value == fluent.pulses == THREADS * ROUNDS


@pytest.mark.parametrize("missed, least, most", [("always", THREADS * ROUNDS, THREADS * ROUNDS), ("once", 1, 1)])
def test_pulses_of_many_threads_are_remembered(missed, least, most):
    fluent = Fluent("a", 0)
    pulses = pulsed(fluent, missed)
    join(in_threads(*[counts(fluent)] * THREADS))
    taken = 0
    while pulses.take():
        taken += 1
    assert least <= taken <= most


def test_a_pulse_is_taken_by_one_of_many_who_take():
    fluent = Fluent("a", 0)
    pulses = pulsed(fluent, "always")
    taken, over = [], threading.Event()

    def take():
        mine = 0
        while not over.is_set() or pulses.value:
            mine += bool(pulses.take())
        taken.append(mine)

    takers = in_threads(*[take] * 4)
    join(in_threads(*[counts(fluent)] * 4))
    over.set()
    join(takers)
    assert sum(taken) == 4 * ROUNDS


def test_whenever_with_always_runs_once_for_each_pulse_of_many_threads():
    fluent, runs = Fluent("a", 1), Fluent("runs", 0)
    listening = threading.Event()
    each = 50

    def body():
        listening.set()
        runs.update(lambda count: count + 1)

    def hammer():
        listening.wait(10.0)
        for _ in range(each):
            fluent.pulse()

    threads = in_threads(*[hammer] * 4)
    # Once at the beginning, for it is true; then once for each pulse.
    top_level(lambda: pursue(do(whenever, fluent, body, "always"), lambda: wait_for(runs >= 4 * each + 1, 30.0)))
    join(threads)
    assert runs.value == 4 * each + 1


def test_whenever_with_once_sees_the_last_value():
    fluent, seen, last = Fluent("a", 0), [], Fluent("last", False)

    def body():
        value = fluent.value
        seen.append(value)
        if value == THREADS * ROUNDS:
            last.value = True

    threads = in_threads(*[counts(fluent)] * THREADS)
    assert top_level(lambda: pursue(do(whenever, fluent, body, "once"), lambda: wait_for(last, timeout=60.0)))
    join(threads)
    assert seen == sorted(seen)


def test_a_failure_in_whenever_is_one_of_the_plan_and_nobody_listens_on():
    fluent = Fluent("a", 0)

    def body():
        fail("too hot")

    with pytest.raises(PlanFailure, match="too hot"):
        top_level(lambda: par(do(whenever, fluent, body), lambda: (sleep(0.002), setattr(fluent, "value", 1))))
    assert fluent._listeners == ()


def test_nobody_listens_when_waits_have_ended_however_they_ended():
    a, b = Fluent("a", 0), Fluent("b", 0)
    networks = [a > 5, (a + b) > 5, fl_and(a, b), fl_or(a, fl_not(b)), fl_eq(a, b), fl_funcall(max, a, b), ~a & b]

    def stay(network):
        wait_for(network & Fluent("never", False))

    def quick():
        wait_for((a + 1) > 0)
        wait_for(a > 100, timeout=0.001)
        sleep(0.002)
        return "over"

    assert top_level(lambda: pursue(*(do(stay, network) for network in networks), quick)) == "over"
    with pytest.raises(PlanFailure):
        top_level(lambda: par(*(do(stay, network) for network in networks), lambda: (sleep(0.002), fail("over"))))
    assert a._listeners == b._listeners == ()


def test_networks_of_networks_wake_whoever_waits():
    inputs = [Fluent(f"input {number}", 0) for number in range(10)]
    total = inputs[0] + 0
    for each in inputs[1:]:
        total = total + each

    def work(fluent):
        def body():
            for _ in range(100):
                fluent.update(lambda value: value + 1)

        return body

    threads = in_threads(*map(work, inputs))
    assert top_level(lambda: par(*[do(wait_for, total >= 1000, 60.0)] * 4)) == [True] * 4
    join(threads)
    assert total.value == 1000


def test_a_value_that_changes_is_handed_from_thread_to_thread():
    """A ring: each waits for its number and gives the next one; one lost wake-up would leave all waiting."""
    token, players, rounds = Fluent("token", 0), 6, 60

    def player(number):
        for turn in range(rounds):
            wait_for(token.eq(turn * players + number))
            token.value = turn * players + number + 1

    top_level(lambda: par(*(do(player, number) for number in range(players))))
    assert token.value == players * rounds


def test_a_timeout_and_a_change_at_the_same_moment_agree():
    for _ in range(50):
        fluent = Fluent("a", False)
        timer = threading.Timer(0.002, lambda fluent=fluent: setattr(fluent, "value", "there"))
        timer.start()
        answer = top_level(lambda fluent=fluent: wait_for(fluent, timeout=0.002))
        assert answer in (False, "there")
        timer.join()
        assert fluent._listeners == ()


def test_a_change_is_seen_by_who_began_to_look_before_it():
    fluent = Fluent("a", 0)

    def changes():
        changed = fl_value_changed(fluent)
        ready.value = True
        wait_for(changed)
        return fluent.value

    ready = Fluent("ready", False)
    assert top_level(lambda: par(changes, lambda: (wait_for(ready), setattr(fluent, "value", 7))))[0] == 7


def test_an_error_in_a_network_comes_out_where_it_is_waited_for():
    fluent = Fluent("a", 1)
    with pytest.raises(ZeroDivisionError):
        top_level(lambda: wait_for(1 / (fluent - 1)))
    assert fluent._listeners == ()


def test_fluents_are_set_while_plans_are_ended_and_suspended(beside):
    fluent, stop = Fluent("a", 0), threading.Event()

    def hammer():
        while not stop.is_set():
            fluent.update(lambda value: value + 1)

    def waits():
        while True:
            seen = fluent.value
            wait_until(lambda seen=seen: fluent.value > seen, [fluent])
            checkpoint()

    threads = in_threads(hammer)
    try:
        for _ in range(10):
            plan = beside(lambda: par(waits, waits))
            plan.root.suspend()
            plan.root.wake_up()
            plan.root.evaporate("over")
            with pytest.raises(PlanFailure, match="over"):
                plan.ended()
    finally:
        stop.set()
        join(threads)
    assert fluent._listeners == ()
