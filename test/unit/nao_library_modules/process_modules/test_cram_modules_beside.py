"""Process modules that do several things at once, and what is told to those who watch them."""

from __future__ import annotations

import pytest
from cram_modules import LIMIT, to, wait_here

from nao_library_modules.process_modules.control import do, par, top_level, try_in_order
from nao_library_modules.process_modules.failures import NavigationGoalNotReached, PlanFailure, TaskEvaporatedFailure
from nao_library_modules.process_modules.flow import sleep, wait_until
from nao_library_modules.process_modules.fluents import Fluent
from nao_library_modules.process_modules.handling import give, with_failure_handling
from nao_library_modules.process_modules.policies import timeout_policy, with_policy
from nao_library_modules.process_modules.process_module import pm_cancel
from nao_library_modules.process_modules.registry import monitor_process_module, perform
from nao_library_modules.process_modules.waiting import wait_for

# --- several at once --------------------------------------------------------------------------------------------------


def test_an_asynchronous_module_does_all_at_once(many, log):
    def let_all():
        wait_until(lambda: log.count("begun") == 20, [log.events])
        log.let(*map(str, range(20)))

    plans = [do(perform, to("wait", str(number), "many")) for number in range(20)]
    answers = top_level(lambda: par(let_all, *plans))
    assert answers[1:] == [str(number) for number in range(20)]


def test_commands_that_need_the_same_take_turns_in_their_order(many, log):
    def step(word, *needs):
        return do(perform, to("wait", word, "many", needs=needs))

    def let():
        wait_until(lambda: {("begun", "a"), ("begun", "d")} <= set(log.events.value), [log.events])
        assert ("begun", "b") not in log.events.value
        log.let("a", "b", "c", "d")

    top_level(lambda: par(step("a", "left"), step("d", "right"), do(later, step, log), let))
    order = [word for what, word in log.events.value if what == "begun"]
    assert order.index("a") < order.index("b")
    events = log.events.value
    assert events.index(("over", "a")) < events.index(("begun", "b"))


def later(step, log):
    wait_until(lambda: ("begun", "a") in log.events.value, [log.events])
    return step("b", "left", "right").call()


def test_one_of_several_commands_is_ended_and_the_others_go_on(many, log, beside):
    plan = beside(
        lambda: try_in_order(
            lambda: par(
                do(perform, to("wait", "a", "many"), name="a"),
            ),
            lambda: "second way",
        )
    )
    other = beside(do(perform, to("wait", "b", "many")))
    log.wait("begun", "a")
    log.wait("begun", "b")
    plan.root.find("a").evaporate("not this")
    assert plan.ended() == "second way"
    log.let("b")
    assert other.ended() == "b"


def test_what_waits_for_a_limb_is_cancelled_without_being_begun(many, log, beside):
    first = beside(do(perform, to("wait", "a", "many", needs=["left"])))
    log.wait("begun", "a")
    second = beside(do(perform, to("wait", "b", "many", needs=["left"])))
    third = None
    wait_here(many, 1)
    third = beside(do(perform, to("wait", "c", "many", needs=["left"])))
    wait_here(many, 2)
    second.root.evaporate("no")
    with pytest.raises(TaskEvaporatedFailure):
        second.ended()
    log.let("a", "c")
    assert (first.ended(), third.ended()) == ("a", "c")
    assert ("begun", "b") not in log.events.value


# --- watched ----------------------------------------------------------------------------------------------------------


def test_a_monitor_does_not_miss_an_end_that_another_one_follows(many, log):
    """Both end at the same moment: the second must not hide the first."""
    for turn in range(30):
        first, others = to("quick", f"first {turn}", "many"), [to("quick", "x", "many") for _ in range(6)]
        ready = Fluent("ready", False)

        def watch(first=first, ready=ready):
            ready.value = True
            return monitor_process_module("many", first)

        def act(first=first, others=others, ready=ready):
            wait_for(ready)
            sleep(0.001)
            par(do(perform, first), *(do(perform, other) for other in others))

        answer = top_level(lambda watch=watch, act=act: with_policy(timeout_policy(LIMIT), do(par, watch, act)))
        assert answer[0] == f"first {turn}"


def test_a_monitor_waits_for_its_designator_only(many, log):
    mine, other = to("wait", "mine", "many"), to("quick", "other", "many")
    watching = Fluent("watching", False)

    def watch():
        watching.value = True
        return monitor_process_module(many, mine)

    def act():
        wait_for(watching)
        sleep(0.002)
        perform(other)
        log.let("mine")
        return perform(mine)

    assert top_level(lambda: par(watch, act)) == ["mine", "mine"]


def test_several_monitors_see_the_same_failure(one, log):
    log.let("far")
    watching = Fluent("watching", 0)
    seen = []

    def watch():
        watching.update(lambda count: count + 1)
        try:
            monitor_process_module("one")
        except NavigationGoalNotReached as failure:
            seen.append(failure.word)

    def act():
        wait_for(watching >= 3)
        sleep(0.005)
        with_failure_handling(do(perform, to("stumble", "far")), {PlanFailure: lambda failure: give()})

    top_level(lambda: par(watch, watch, watch, act))
    assert seen == ["far"] * 3


def test_a_monitor_is_told_of_a_cancel(one, log):
    def watch():
        with pytest.raises(TaskEvaporatedFailure):
            monitor_process_module(one)

    def act():
        wait_until(lambda: ("begun", "a") in log.events.value, [log.events])
        sleep(0.002)
        pm_cancel(one)

    def do_it():
        return with_failure_handling(do(perform, to("wait", "a")), {PlanFailure: lambda failure: give()})

    top_level(lambda: par(watch, act, do_it))
