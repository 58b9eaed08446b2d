"""Failures that are handled, retries that are counted, and policies."""

from __future__ import annotations

import pytest
from plan_tools import fails, forever

import nao_library_modules.process_modules as p
from nao_library_modules.process_modules.failures import (
    LowLevelFailure,
    NavigationGoalNotReached,
    NavigationHighLevelFailure,
    NavigationLowLevelFailure,
    PerceptionObjectNotFound,
    PlanTimedOut,
    PolicyCheckConditionMet,
    PolicyNotFound,
)


class KeyedFailure(p.PlanFailure):
    pass


class Stumbling:
    """Fails so often, then answers."""

    def __init__(self, times, failure=NavigationGoalNotReached):
        self.tries, self._times, self._failure = 0, times, failure

    def __call__(self):
        self.tries += 1
        if self.tries <= self._times:
            p.fail(self._failure, f"try {self.tries}")
        return "there"


def handled(body, handlers, **counters):
    def plan():
        with p.with_retry_counters(**counters):
            return p.with_failure_handling(body, handlers)

    return plan


def handle(body, handlers, **counters):
    return p.top_level(handled(body, handlers, **counters))


def counted(name, **options):
    """A handler that tries again as long as a counter allows."""
    return {p.PlanFailure: lambda failure: p.do_retry(name, **options)}


def test_a_body_is_tried_again_as_often_as_it_fails():
    body = Stumbling(2)
    assert handle(body, {NavigationLowLevelFailure: lambda failure: p.retry()}) == "there" and body.tries == 3
    body = Stumbling(2000)  # retries need no deeper stack
    assert handle(body, {p.PlanFailure: lambda failure: p.retry()}) == "there"


def test_a_handler_may_answer_and_the_first_that_fits_counts():
    handlers = {
        PerceptionObjectNotFound: lambda failure: p.give("not seen"),
        (NavigationLowLevelFailure, KeyedFailure): lambda failure: p.give(str(failure)),
        LowLevelFailure: lambda failure: p.give("something"),
    }
    kinds = (NavigationGoalNotReached, KeyedFailure, PerceptionObjectNotFound, LowLevelFailure)
    answers = [handle(Stumbling(1, kind), handlers) for kind in kinds]
    assert answers == ["try 1", "try 1", "not seen", "something"]


def test_what_a_handler_does_not_answer_goes_to_the_outer_ones():
    seen_failures = []
    inner = p.do(p.with_failure_handling, Stumbling(1), {p.PlanFailure: seen_failures.append})
    assert handle(inner, {p.PlanFailure: lambda failure: p.give("outside")}) == "outside"
    assert [str(failure) for failure in seen_failures] == ["try 1"]
    never = {PerceptionObjectNotFound: lambda failure: p.give()}
    fails(NavigationGoalNotReached, "try 1", handled(Stumbling(1), never))


def test_failures_carry_facts():
    failure = fails(NavigationGoalNotReached, "too far", p.do(p.fail, NavigationGoalNotReached, "too far", distance=3))
    assert failure.distance == 3 and failure.details == {"distance": 3}
    assert str(NavigationGoalNotReached()) == "navigation goal not reached"
    with pytest.raises(p.PlanError, match="3 is no PlanFailure"):
        p.fail(3)


def test_counters_say_how_often_and_what_is_done_before():
    told = []

    def again(failure):
        told.append(p.get_counter("walk"))
        p.do_retry("walk", before=lambda: told.append("stood up"))
        p.fail(NavigationHighLevelFailure, f"gave up after {failure}")

    plan = handled(Stumbling(5), {NavigationLowLevelFailure: again}, walk=2)
    fails(NavigationHighLevelFailure, "gave up after try 3", plan)
    assert told == [2, "stood up", 1, "stood up", 0]


def test_a_counter_can_be_reset_and_an_unknown_one_is_an_error():
    def again(failure):
        if p.get_counter("walk") == 0:
            p.reset_counter("walk")
        p.do_retry("walk")

    assert handle(Stumbling(3), {p.PlanFailure: again}, walk=1) == "there"
    fails(p.PlanError, "no retry counter 'wakl': did you mean 'walk'", handled(Stumbling(1), counted("wakl"), walk=1))


def limited(limit, body):
    return lambda: p.with_policy(p.timeout_policy(limit), body)


def upright(fluent, done=None, **options):
    told = {} if done is None else {each: lambda each=each: done.append(each) for each in ("recover", "clean_up")}
    return p.Policy("upright", fluent, **{**told, **options})


def test_a_body_that_is_quick_enough_answers_and_one_that_is_too_slow_is_ended(stays):
    assert p.top_level(limited(1000.0, lambda: "there")) == "there"
    fails(PlanTimedOut, "policy 'at most 0.01 s' ended what it watched", limited(0.01, stays("slow").call))
    assert stays.ended == ["slow"]


def test_the_parts_of_a_policy_come_in_order(stays):
    policy = upright(stays.there, stays.ended, init=lambda: stays.ended.append("init") or True)
    assert fails(PolicyCheckConditionMet, "upright", lambda: p.with_policy(policy, stays("body"))).policy == "upright"
    assert stays.ended == ["init", "body", "recover", "clean_up"]


def test_a_function_is_asked_again_and_again_and_what_it_raises_breaks_the_plan():
    asked = []
    third = p.Policy("third time", lambda: asked.append(True) or len(asked) == 3, period=0.001)
    fails(PolicyCheckConditionMet, "third time", lambda: p.with_policy(third, forever))
    assert len(asked) == 3
    fails(ZeroDivisionError, "", lambda: p.with_policy(p.Policy("broken", lambda: 1 / 0, period=0.001), forever))


def test_policies_have_names_and_several_watch_one_body(stays):
    @p.define_policy("until told")
    def until(fluent, word):
        return p.Policy(f"until {word}", fluent)

    slow = stays("slow").call
    met = lambda: p.with_named_policy("until told", (stays.there, "noon"), slow)  # noqa: E731
    fails(PolicyCheckConditionMet, "policy 'until noon'", met)
    both = lambda: p.with_named_policies([("timeout", [0.01]), ("timeout", [1000.0])], forever)  # noqa: E731
    fails(PlanTimedOut, "policy 'at most 0.01 s'", both)
    assert p.top_level(lambda: p.with_policies([p.timeout_policy(1000.0)] * 2, lambda: "there")) == "there"
    fails(
        PolicyNotFound,
        "no policy 'untold': did you mean 'until told'.*; there are timeout, until told",
        lambda: p.named_policy("untold"),
    )
