"""Process modules: one thing at a time or several, cancelled in each state, failing, suspended, stopped, watched."""

from __future__ import annotations

import threading

import pytest
from plan_tools import LIMIT, SHORT, Beside, One, at_once, fails, seen, state_of, to

import nao_library_modules.process_modules as p
from nao_library_modules.process_modules.failures import (
    DesignatorError,
    NavigationGoalNotReached,
    NoMatchingProcessModule,
    ProcessModuleNotRunning,
    TaskEvaporatedFailure,
    UnknownProcessModule,
)
from nao_library_modules.process_modules.process_module import (
    ModuleState,
    get_process_module,
    start_process_modules,
    stop_process_modules,
    wait_for_process_module_running,
)


def performing(*arguments, **options):
    return p.do(p.perform, to(*arguments, **options))


def perform(*arguments, **options):
    return p.top_level(performing(*arguments, **options))


@pytest.fixture
def begun(log):
    """A plan whose command has begun: it waits until the log lets its word."""

    def begin(word, module="one", how="wait", **arguments):
        plan = Beside(performing(how, word, module, **arguments))
        log.wait("begun", word)
        return plan

    return begin


def in_line(module, word, **arguments):
    """A plan whose command waits for its turn."""
    count = module.asked.value + 1
    plan = Beside(performing("wait", word, module.name, **arguments))
    seen(module.asked >= count)
    return plan


def test_a_designator_is_carried_out_by_its_module_and_answered(one):
    desig, command = to("quick", "a"), p.Command("one", "quick", {"word": "a"})
    ways = [p.do(p.pm_execute, one, desig), p.do(p.pm_execute, "one", desig), p.do(p.pm_execute_matching, desig)]
    ways += [p.do(p.perform, desig), p.do(p.perform, command), p.do(p.pm_execute, one, command)]
    assert [p.top_level(way) for way in ways] == ["a"] * 6 and p.matching_process_module(desig) == "one"
    twice = p.Designator(p.action, {}, resolve=lambda _: [lambda: [p.perform(to("quick", word)) for word in "ab"]])
    assert p.top_level(p.do(p.perform, twice)) == ["a", "b"], "an action may be a plan of other actions"


def test_what_goes_wrong_in_a_module_goes_wrong_in_the_plan_and_can_be_tried_otherwise(one, log):
    log.let("far")
    assert fails(NavigationGoalNotReached, "far is far", performing("stumble", "far")).word == "far"
    assert p.pm_status(one) is ModuleState.FAILED
    p.pm_cancel(one)
    fails(KeyError, "", performing("bug"))
    assert perform("quick", "b") == "b"
    state_of(one, ModuleState.WAITING)
    tries = []

    def again(failure):
        tries.append(failure.word)
        p.retry() if len(tries) < 3 else p.give("gave up")

    handlers = {NavigationGoalNotReached: again}
    assert p.top_level(lambda: p.with_failure_handling(performing("stumble", "far"), handlers)) == "gave up"
    assert log.words("begun")[3:] == tries == ["far"] * 3
    commands = [p.Command("one", "stumble", {"word": "far"}), p.Command("one", "quick", {"word": "near"})]
    desig = p.Designator(p.action, {"type": "either"}, resolve=lambda _: commands)
    other = lambda: p.perform(desig.next_solution())  # noqa: E731
    assert p.top_level(lambda: p.try_in_order(p.do(p.perform, desig), other)) == "near"


def test_one_thing_at_a_time_or_all_at_once(one, many, log):
    plan = lambda: p.top_level(lambda: p.seq(*[performing("quick", "a")] * 5))  # noqa: E731
    assert at_once(*[plan] * 4) == ["a"] * 4
    assert [what for what, _ in log.events.value] == ["begun", "over"] * 20
    words = [str(number) for number in range(10)]
    let = lambda: (p.wait_until(lambda: len(log.words("begun")) == 30, [log.events]), log.let(*words))  # noqa: E731
    assert p.top_level(lambda: p.par(let, *(performing("wait", word, "many") for word in words)))[1:] == words


def test_commands_that_need_the_same_take_turns_in_their_order(many, log, begun):
    plans = [begun("a", "many", needs=["left"]), in_line(many, "b", needs=["left", "right"])]
    plans += [in_line(many, "c", needs=["right"]), begun("d", "many", needs=["head"])]
    assert log.words("begun") == ["a", "d"], "who needs the same overtakes nobody"
    log.let("a", "b", "c", "d")
    assert [plan.ended() for plan in plans] == ["a", "b", "c", "d"]
    at = log.events.value.index
    assert at(("over", "a")) < at(("begun", "b")) < at(("over", "b")) < at(("begun", "c"))


def test_cancelling_a_module_ends_what_it_does_and_what_waits(one, log, begun):
    p.pm_cancel(one)
    assert p.pm_status(one) is ModuleState.WAITING
    plans = [begun("a"), in_line(one, "b"), in_line(one, "c")]
    p.pm_cancel(one)
    for plan in plans:
        plan.fails(TaskEvaporatedFailure, "cancelled")
    assert log.events.value == (("begun", "a"), ("over", "a"))
    state_of(one, ModuleState.WAITING)


def test_a_plan_that_ends_cancels_what_it_asked_for_and_sees_it_end(one, log):
    leave = lambda: (log.happened("begun", "a"), "left")[1]  # noqa: E731
    assert p.top_level(lambda: p.pursue(performing("wait", "a"), leave)) == "left"
    assert log.events.value == (("begun", "a"), ("over", "a")) and p.pm_status(one) is ModuleState.WAITING
    fails(p.PlanFailure, "at most 0.02 s", lambda: p.with_policy(p.timeout_policy(0.02), performing("wait", "b")))
    assert log.words("over") == ["a", "b"]


def test_a_failure_ends_what_runs_beside_it_also_where_that_fails_while_it_is_ended(one, many, log):
    log.let("far")
    stumble = lambda: (log.happened("begun", "walk"), p.perform(to("stumble", "far", "many")))  # noqa: E731
    fails(NavigationGoalNotReached, "far", lambda: p.par(performing("wait", "walk"), stumble))
    assert log.words("over") == ["far", "walk"]
    assert (one.state, many.state) == (ModuleState.WAITING, ModuleState.FAILED)
    second = lambda: (log.happened("begun", "a"), p.fail(NavigationGoalNotReached, "first"))  # noqa: E731
    fails(NavigationGoalNotReached, "first", lambda: p.par(performing("stumble at the end", "a"), second))


def test_a_suspension_takes_commands_back_and_sends_them_again(one, many, log):
    handlers = {p.PlanFailure: lambda failure: p.give(p.perform(to("wait", "b", "many")))}
    in_handler = lambda: p.with_failure_handling(p.do(p.fail, "no"), handlers)  # noqa: E731
    plan = Beside(lambda: p.par(performing("wait", "a"), in_handler))
    log.wait("begun", "a")
    log.wait("begun", "b")
    plan.root.suspend()
    log.wait("over", "a")
    log.wait("over", "b")
    log.let("a", "b")
    plan.root.wake_up()
    assert plan.ended() == ["a", "b"] and sorted(log.words("begun")) == ["a", "a", "b", "b"]


def test_stopping_ends_what_runs_and_what_waits(log, begun):
    module = One(log)
    start_process_modules(module)
    plans = [begun("a"), in_line(module, "b")]
    stop_process_modules()
    for plan in plans:
        plan.fails((TaskEvaporatedFailure, ProcessModuleNotRunning))
    assert module.state is ModuleState.OFFLINE and log.words("begun") == log.words("over") == ["a"]
    assert not p.available_process_module("one")
    with pytest.raises(ProcessModuleNotRunning, match="one does not run"):
        module.stop()
    with p.with_process_modules_running(module):
        assert perform("quick", "again") == "again"


def test_a_module_may_run_in_a_thread_of_ones_own_until_it_is_stopped(log):
    module = One(log)
    thread = threading.Thread(target=p.pm_run, args=(module,))
    thread.start()
    state_of(module, ModuleState.WAITING)
    assert p.top_level(lambda: p.pm_execute(module, to("quick", "a"))) == "a"
    module.stop()
    thread.join(LIMIT)
    assert not thread.is_alive() and module.state is ModuleState.OFFLINE


def test_plans_wait_for_an_offline_module_and_go_on_when_it_starts(log):
    module = One(log)
    plan = Beside(p.do(p.pm_execute, module, p.Command("one", "quick", {"word": "a"})))
    assert plan.root.join(SHORT) is False
    with p.with_process_modules_running(module):
        assert plan.ended() == "a"


def test_aliases_last_as_long_as_their_block_and_hide_others(one, many):
    with p.with_process_module_aliases(hand="one"):
        assert get_process_module("hand") is one and perform("quick", "a", "hand") == "a"
        with p.with_process_module_aliases(hand="many"):
            assert get_process_module("hand") is many
        assert get_process_module("hand") is one
        with pytest.raises(UnknownProcessModule, match="no process module 'foot': there are .*hand, .*many.*one"):
            get_process_module("foot")
    assert not p.available_process_module("hand")


def test_what_cannot_be_performed_is_told(one):
    assert p.top_level(lambda: wait_for_process_module_running("one", timeout=5.0))
    fails(NoMatchingProcessModule, "is for the process module foot, which does not run", performing("kick", "", "foot"))
    fails(p.PlanError, "'open' is no designator", lambda: p.perform("open"))
    place, three = p.a(p.location, pose=[0, 0, 0]), p.Designator(p.action, {}, resolve=lambda desig: [3])
    fails(p.PlanError, "no designator of an action or a motion", lambda: p.perform(place))
    fails(DesignatorError, "its solution 3 is nothing that a process module", lambda: p.pm_execute(one, three))
    fails(DesignatorError, "", lambda: p.perform(p.an(p.action, type="juggling with knives")))


def test_a_monitor_answers_what_its_module_has_done(one):
    asked = p.do(p.monitor_process_module, one)
    seen_by = lambda: (p.wait_until(lambda: bool(one.watchers)), p.perform(to("quick", "a")))[1]  # noqa: E731
    assert p.top_level(lambda: p.par(asked, seen_by)) == ["a", "a"] and list(one.watchers) == []
