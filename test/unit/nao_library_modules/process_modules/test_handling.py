"""Failure handling, retry counters and policies."""

from __future__ import annotations

import pytest

from nao_library_modules.process_modules.control import do, top_level
from nao_library_modules.process_modules.failures import (
    LowLevelFailure,
    NavigationGoalNotReached,
    NavigationHighLevelFailure,
    NavigationLowLevelFailure,
    PerceptionObjectNotFound,
    PlanError,
    PlanFailure,
    PlanTimedOut,
    PolicyCheckConditionMet,
    PolicyInitFailed,
    fail,
)
from nao_library_modules.process_modules.flow import sleep, wait_until
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


class Stumbling:
    """Fails so often, then answers."""

    def __init__(self, times, failure=NavigationGoalNotReached):
        self.tries = 0
        self._times = times
        self._failure = failure

    def __call__(self):
        self.tries += 1
        if self.tries <= self._times:
            fail(self._failure, f"try {self.tries}")
        return "there"


def handle(body, handlers, **counters):
    def plan():
        with with_retry_counters(**counters):
            return with_failure_handling(body, handlers)

    return top_level(plan)


def test_a_body_is_tried_again():
    body = Stumbling(2)
    assert handle(body, {NavigationLowLevelFailure: lambda failure: retry()}) == "there"
    assert body.tries == 3


def test_counters_say_how_often():
    body, told = Stumbling(5), []

    def again(failure):
        told.append(get_counter("walk"))
        do_retry("walk", before=lambda: told.append("stood up"))
        fail(NavigationHighLevelFailure, f"gave up after {failure}")

    with pytest.raises(NavigationHighLevelFailure, match="gave up after try 3"):
        handle(body, {NavigationLowLevelFailure: again}, walk=2)
    assert told == [2, "stood up", 1, "stood up", 0]


def test_a_counter_can_be_reset():
    body = Stumbling(3)

    def again(failure):
        if get_counter("walk") == 0:
            reset_counter("walk")
        do_retry("walk")

    assert handle(body, {PlanFailure: again}, walk=1) == "there"


def test_an_unknown_counter_is_an_error():
    with pytest.raises(PlanError, match="no retry counter 'wakl': there are walk"):
        handle(Stumbling(1), {PlanFailure: lambda failure: do_retry("wakl")}, walk=1)


def test_a_handler_may_answer_and_the_first_that_fits_counts():
    handlers = {
        PerceptionObjectNotFound: lambda failure: give("not seen"),
        (NavigationLowLevelFailure, KeyedFailure): lambda failure: give(str(failure)),
        LowLevelFailure: lambda failure: give("something"),
    }
    assert handle(Stumbling(1), handlers) == "try 1"
    assert handle(Stumbling(1, PerceptionObjectNotFound), handlers) == "not seen"
    assert handle(Stumbling(1, LowLevelFailure), handlers) == "something"


class KeyedFailure(PlanFailure):
    pass


def test_a_handler_that_returns_passes_the_failure_up():
    seen = []
    with pytest.raises(NavigationGoalNotReached, match="try 1"):
        handle(Stumbling(1), {PlanFailure: seen.append})
    assert [str(failure) for failure in seen] == ["try 1"]


def test_a_failure_that_no_handler_fits_goes_through():
    with pytest.raises(NavigationGoalNotReached):
        handle(Stumbling(1), {PerceptionObjectNotFound: lambda failure: give()})


def test_handlers_of_outer_blocks_see_what_inner_ones_pass_up():
    inner = do(with_failure_handling, Stumbling(1), {PlanFailure: lambda failure: None})
    assert handle(inner, {PlanFailure: lambda failure: give("outside")}) == "outside"


def test_only_failures_are_handled():
    with pytest.raises(PlanError, match="<class 'ValueError'> is no class of PlanFailure"):
        handle(Stumbling(1), {ValueError: give})
    with pytest.raises(ZeroDivisionError):
        handle(lambda: 1 / 0, {PlanFailure: lambda failure: give()})


def test_failures_carry_facts():
    with pytest.raises(NavigationGoalNotReached) as caught:
        fail(NavigationGoalNotReached, "too far", distance=0.3)
    assert caught.value.distance == 0.3 and caught.value.details == {"distance": 0.3}
    assert str(NavigationGoalNotReached()) == "navigation goal not reached"
    with pytest.raises(PlanError, match="3 is no PlanFailure"):
        fail(3)


# --- policies ---------------------------------------------------------------------------------------------------------


def test_a_body_that_is_quick_enough_answers():
    assert top_level(lambda: with_policy(timeout_policy(1000.0), lambda: "there")) == "there"


def test_a_body_that_is_too_slow_is_ended():
    ended = []

    def slow():
        try:
            sleep(1000.0)
        finally:
            ended.append(True)

    with pytest.raises(PlanTimedOut, match="policy 'at most 0.01 s' ended what it watched"):
        top_level(lambda: with_policy(timeout_policy(0.01), slow))
    assert ended == [True]


def test_the_parts_of_a_policy_come_in_order():
    fallen, done = Fluent("fallen", False), []

    def body():
        done.append("body")
        fallen.value = True
        try:
            wait_until(lambda: False)
        finally:
            done.append("ended")

    policy = Policy(
        "upright",
        fallen,
        init=lambda: done.append("init"),
        recover=lambda: done.append("recover"),
        clean_up=lambda: done.append("clean up"),
    )
    with pytest.raises(PolicyCheckConditionMet) as caught:
        top_level(lambda: with_policy(policy, body))
    assert caught.value.policy == "upright"
    assert done == ["init", "body", "ended", "recover", "clean up"]


def test_a_function_is_asked_again_and_again():
    asked = []

    def check():
        asked.append(True)
        return len(asked) == 3

    with pytest.raises(PolicyCheckConditionMet):
        top_level(lambda: with_policy(Policy("third time", check, period=0.001), do(sleep, 1000.0)))


def test_a_policy_that_cannot_begin_does_not_let_the_body_begin():
    done = []
    policy = Policy("upright", Fluent("never", False), init=lambda: False, clean_up=lambda: done.append("clean up"))
    with pytest.raises(PolicyInitFailed, match="policy 'upright' could not begin"):
        top_level(lambda: with_policy(policy, do(done.append, "body")))
    assert done == []


def test_a_failure_of_the_body_comes_through_and_cleans_up():
    done = []
    policy = Policy("upright", Fluent("never", False), clean_up=lambda: done.append("clean up"))
    with pytest.raises(NavigationGoalNotReached):
        top_level(lambda: with_policy(policy, Stumbling(1)))
    assert done == ["clean up"]
