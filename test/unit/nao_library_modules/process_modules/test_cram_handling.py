"""Failures that are handled, and policies."""

from __future__ import annotations

import pytest
from cram_waits import forever, seen

from nao_library_modules.process_modules.control import do, par, seq, top_level
from nao_library_modules.process_modules.failures import (
    ManipulationPoseUnreachable,
    NavigationGoalNotReached,
    NavigationHighLevelFailure,
    PlanError,
    PlanFailure,
    PlanTimedOut,
    PolicyCheckConditionMet,
    TaskEvaporatedFailure,
    fail,
)
from nao_library_modules.process_modules.flow import sleep
from nao_library_modules.process_modules.fluents import Fluent
from nao_library_modules.process_modules.handling import (
    do_retry,
    get_counter,
    give,
    reset_counter,
    retry,
    with_failure_handling,
    with_retry_counters,
)
from nao_library_modules.process_modules.policies import Policy, timeout_policy, with_policy
from nao_library_modules.process_modules.waiting import wait_for


def test_a_handler_may_fail_with_something_else_and_outer_handlers_see_that():
    inner = do(
        with_failure_handling,
        do(fail, NavigationGoalNotReached, "stuck"),
        {NavigationGoalNotReached: lambda failure: fail(NavigationHighLevelFailure, f"for good: {failure}")},
    )
    outer = {
        NavigationGoalNotReached: lambda failure: give("low"),
        NavigationHighLevelFailure: lambda failure: give(str(failure)),
    }
    assert top_level(lambda: with_failure_handling(inner, outer)) == "for good: stuck"


def test_an_inner_retry_does_not_use_up_the_outer_counter():
    tried, counts = [], []

    def inner():
        with with_retry_counters(tries=2):

            def again(failure):
                do_retry("tries")

            return with_failure_handling(attempt, {PlanFailure: again})

    def attempt():
        tried.append(True)
        fail(f"try {len(tried)}")

    def outer_again(failure):
        counts.append(get_counter("tries"))
        do_retry("tries")

    def plan():
        with with_retry_counters(tries=1):
            with_failure_handling(inner, {PlanFailure: outer_again})

    with pytest.raises(PlanFailure, match="try 6"):
        top_level(plan)
    assert counts == [1, 0] and len(tried) == 6


def test_counters_hold_in_the_branches_of_their_block_each_for_itself():
    def branch(number):
        tried = []

        def body():
            tried.append(True)
            fail("again")

        def plan():
            with with_retry_counters(**{f"tries_{number}": number}):
                with_failure_handling(body, {PlanFailure: lambda failure: (do_retry(f"tries_{number}"), give())})

        plan()
        return len(tried)

    assert top_level(lambda: par(*(do(branch, number) for number in range(4)))) == [1, 2, 3, 4]


def test_a_counter_from_outside_counts_in_a_branch():
    def body():
        with with_retry_counters(all=3):

            def branch():
                return with_failure_handling(do(fail, "no"), {PlanFailure: lambda f: (do_retry("all"), give())})

            seq(branch, branch)
            left = get_counter("all")
            reset_counter("all")
            return left, get_counter("all")

    assert top_level(body) == (0, 3)


def test_failures_of_branches_are_handled_around_their_par():
    ended, waiting = [], Fluent("waiting", False)

    def walk():
        try:
            waiting.value = True
            forever()
        finally:
            ended.append("walk")

    def grasp():
        wait_for(waiting)
        waiting.value = False
        fail(ManipulationPoseUnreachable, "too far")

    tries = []

    def again(failure):
        tries.append(type(failure))
        if len(tries) < 3:
            retry()
        give("enough")

    handlers = {ManipulationPoseUnreachable: again}
    assert top_level(lambda: with_failure_handling(do(par, walk, grasp), handlers)) == "enough"
    assert ended == ["walk"] * 3 and len(tries) == 3


def test_thousands_of_retries_need_no_deeper_stack():
    tries = [0]

    def body():
        tries[0] += 1
        if tries[0] < 3000:
            raise NavigationGoalNotReached("again")
        return "there"

    assert top_level(lambda: with_failure_handling(body, {PlanFailure: lambda failure: retry()})) == "there"


def test_the_end_of_a_task_is_no_failure_that_its_handlers_see(beside):
    handled, waiting = [], Fluent("waiting", False)

    def body():
        waiting.value = True
        forever()

    plan = beside(lambda: with_failure_handling(body, {PlanFailure: lambda failure: handled.append(failure) or give()}))
    seen(waiting)
    plan.root.evaporate("over")
    with pytest.raises(TaskEvaporatedFailure):
        plan.ended()
    assert handled == []


def test_retry_and_give_outside_of_handlers_are_mistakes_or_answers_of_nobody():
    for wrong in (retry, give):
        with pytest.raises(PlanError):
            top_level(lambda wrong=wrong: seq(wrong))


def test_policies_nest_and_the_one_that_is_met_counts():
    fallen = Fluent("fallen", False)

    def body():
        fallen.value = True
        forever()

    upright = Policy("upright", fallen)
    with pytest.raises(PolicyCheckConditionMet, match="upright"):
        top_level(lambda: with_policy(timeout_policy(1000.0), lambda: with_policy(upright, body)))
    fallen.value = False
    with pytest.raises(PolicyCheckConditionMet, match="upright"):
        top_level(lambda: with_policy(upright, lambda: with_policy(timeout_policy(1000.0), body)))


def test_a_policy_is_a_failure_that_can_be_handled_and_the_body_tried_again():
    tries = []

    def body():
        tries.append(True)
        if len(tries) < 3:
            sleep(1000.0)
        return "in time"

    def plan():
        return with_failure_handling(
            lambda: with_policy(timeout_policy(0.01), body), {PlanTimedOut: lambda failure: retry()}
        )

    assert top_level(plan) == "in time" and len(tries) == 3


def test_cleaning_up_waits_and_happens_when_the_plan_is_ended(beside):
    waiting, cleaned = Fluent("waiting", False), []

    def body():
        waiting.value = True
        forever()

    policy = Policy("clean", Fluent("never", False), clean_up=lambda: cleaned.append(True))
    plan = beside(lambda: with_policy(policy, body))
    seen(waiting)
    plan.root.evaporate("over")
    with pytest.raises(TaskEvaporatedFailure):
        plan.ended()
    assert cleaned == [True]


def test_a_check_that_is_broken_breaks_the_plan():
    with pytest.raises(ZeroDivisionError):
        top_level(lambda: with_policy(Policy("broken", lambda: 1 / 0, period=0.001), forever))
