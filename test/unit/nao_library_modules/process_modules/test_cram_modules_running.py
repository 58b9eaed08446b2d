"""Process modules begin, end, and are called by other names."""

from __future__ import annotations

import threading

import pytest
from cram_modules import LIMIT, Many, One, state_of, to, wait_here

from nao_library_modules.process_modules.control import do, par, pursue, seq, top_level
from nao_library_modules.process_modules.designators.rules import Command
from nao_library_modules.process_modules.failures import (
    PlanFailure,
    ProcessModuleNotRunning,
    TaskEvaporatedFailure,
    UnknownProcessModule,
)
from nao_library_modules.process_modules.fluents import Fluent
from nao_library_modules.process_modules.process_module import ModuleState, pm_run
from nao_library_modules.process_modules.registry import (
    available_process_module,
    get_process_module,
    perform,
    pm_execute,
    start_process_modules,
    stop_process_modules,
    with_process_module_aliases,
    with_process_modules_running,
)
from nao_library_modules.process_modules.waiting import wait_for


def test_pm_run_in_a_thread_of_ones_own_ends_with_stop(log):
    module, stopped = One(log), threading.Event()
    after = []

    def mine():
        pm_run(module)
        after.append(module.state)
        stopped.wait(LIMIT)

    thread = threading.Thread(target=mine)
    thread.start()
    state_of(module, ModuleState.WAITING)
    assert top_level(lambda: pm_execute(module, Command("one", "quick", {"word": "a"}))) == "a"
    stopper = threading.Thread(target=module.stop)
    stopper.start()
    stopper.join(LIMIT / 2.0)
    hung = stopper.is_alive()
    stopped.set()
    thread.join(LIMIT)
    stopper.join(LIMIT)
    assert not hung, "stop waits for a thread that has long left pm_run"
    assert after == [ModuleState.OFFLINE]
    with with_process_modules_running(module):
        assert module.state is ModuleState.WAITING


def test_plans_that_wait_for_an_offline_module_go_on_when_it_starts_all_of_them(log, beside):
    module = One(log)
    plans = [beside(do(pm_execute, module, Command("one", "quick", {"word": word}))) for word in "abcd"]
    plans[0].root.evaporate("too late")
    with pytest.raises(TaskEvaporatedFailure):
        plans[0].ended()
    plans[1].root.suspend()
    with with_process_modules_running(module):
        assert [plan.ended() for plan in plans[2:]] == ["c", "d"]
        plans[1].root.wake_up()
        assert plans[1].ended() == "b"


def test_stopping_ends_what_runs_and_what_waits(log, beside):
    module = One(log)
    start_process_modules(module)
    plans = [beside(do(perform, to("wait", "a")))]
    log.wait("begun", "a")
    plans.append(beside(do(perform, to("wait", "b"))))
    wait_here(module, 1)
    stop_process_modules()
    for plan in plans:
        with pytest.raises((TaskEvaporatedFailure, ProcessModuleNotRunning)):
            plan.ended()
    assert module.state is ModuleState.OFFLINE and log.count("begun") == log.count("over") == 1


def test_modules_that_are_started_while_another_one_cannot_are_stopped_again(log, one):
    other = Many(log)
    with pytest.raises(PlanFailure if issubclass(ProcessModuleNotRunning, PlanFailure) else Exception):
        with with_process_modules_running(other, One(log)):
            pass
    assert other.state is ModuleState.OFFLINE and one.state is ModuleState.WAITING


def test_a_failure_in_the_block_stops_the_modules(log):
    module = One(log)
    with pytest.raises(ZeroDivisionError), with_process_modules_running(module):
        1 / 0  # noqa: B018
    assert module.state is ModuleState.OFFLINE


def test_aliases_last_as_long_as_their_block_and_hide_others(one, many):
    with with_process_module_aliases(hand="one"):
        assert get_process_module("hand") is one
        with with_process_module_aliases(hand="many", foot="many"):
            assert get_process_module("hand") is many and available_process_module("foot")
        assert get_process_module("hand") is one
        with pytest.raises(UnknownProcessModule):
            get_process_module("foot")
    with pytest.raises(UnknownProcessModule):
        get_process_module("hand")


def test_aliases_of_plans_beside_each_other_do_not_take_each_others_away(one, many):
    first_in, second_in, first_out = (Fluent(name, False) for name in ("first in", "second in", "first out"))

    def first():
        with with_process_module_aliases(hand="one"):
            first_in.value = True
            wait_for(second_in)
        first_out.value = True

    def second():
        wait_for(first_in)
        with with_process_module_aliases(foot="many"):
            second_in.value = True
            wait_for(first_out)
            assert get_process_module("foot") is many
        with pytest.raises(UnknownProcessModule):
            get_process_module("hand")

    top_level(lambda: par(first, second))


def test_commands_go_to_modules_by_their_aliases(one, log):
    with with_process_module_aliases(anything="one"):
        assert top_level(lambda: perform(to("quick", "a", "anything"))) == "a"
        assert top_level(lambda: pm_execute("anything", to("quick", "b", "anything"))) == "b"


def test_many_plans_use_a_module_from_many_threads(one, log):
    outcome = []

    def user(number):
        outcome.append(top_level(lambda: seq(*(do(perform, to("quick", f"{number}")) for _ in range(10)))))

    threads = [threading.Thread(target=user, args=(number,)) for number in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(30.0)
    assert sorted(outcome) == [str(number) for number in range(8)]
    # One thing at a time: each ends before the next begins.
    events = [what for what, _ in log.events.value]
    assert events == ["begun", "over"] * 80


def test_whichever_module_is_first_decides(one, many, log):
    log.let("b")
    answer = top_level(lambda: pursue(do(perform, to("wait", "a")), do(perform, to("wait", "b", "many"))))
    assert answer == "b"
    assert {event for event in log.events.value if event[1] == "a"} in (set(), {("begun", "a"), ("over", "a")})
