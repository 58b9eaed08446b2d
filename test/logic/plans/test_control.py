"""Control constructs: what counts, what is ended, in which order, and what the tree tells of it."""

from __future__ import annotations

import threading

import pytest
from plan_tools import fails, forever

import nao_library_modules.process_modules as p
from nao_library_modules.process_modules.failures import NavigationGoalNotReached, ObjectUnreachable


def no_ball():
    p.fail(ObjectUnreachable, "no ball")


def bug():
    return {}["missing"]


def test_seq_goes_in_order_answers_the_last_and_ends_with_the_first_failure():
    done = []
    assert p.top_level(lambda: p.seq(p.do(done.append, 1), p.do(done.append, 2), lambda: "last")) == "last"
    assert done == [1, 2]
    fails(ObjectUnreachable, "no ball", lambda: p.seq(p.do(done.append, 3), no_ball, p.do(done.append, 4)))
    assert done == [1, 2, 3]


def test_par_answers_all_in_the_order_of_the_branches_when_all_have_ended():
    last, ended = p.Fluent("last", False), []

    def first():
        p.wait_for(last)
        ended.append("first")
        return 1

    def second():
        ended.append("second")
        last.value = True
        return 2

    assert p.top_level(lambda: p.par(first, second)) == [1, 2]
    assert ended == ["second", "first"]


def test_par_ends_its_other_branches_at_the_first_failure_and_waits_until_they_have_put_things_right(stays):
    right = []

    def put_right():
        with p.uninterrupted():
            p.sleep(0.005)
            right.append(True)

    plan = p.do(p.par, stays("a", put_right), stays("b", put_right), stays.once(2, no_ball))
    fails(ObjectUnreachable, "no ball", plan)
    assert sorted(stays.ended) == ["a", "b"] and right == [True, True]


@pytest.mark.parametrize("construct", [p.pursue, p.try_all])
def test_the_first_that_succeeds_decides_and_ends_the_others(construct, stays):
    nested = p.do(p.par, stays("a"), p.do(p.pursue, stays("b"), p.do(p.try_all, stays("c"))))
    assert p.top_level(p.do(construct, nested, stays.once(3, lambda: "found"))) == "found"
    assert sorted(stays.ended) == ["a", "b", "c"]


def test_pursue_fails_with_a_failure_that_comes_first(stays):
    fails(ObjectUnreachable, "no ball", lambda: p.pursue(stays("a"), stays.once(1, no_ball)))
    assert stays.ended == ["a"]


def test_try_all_goes_on_after_a_failure():
    failed = p.Fluent("failed", False)

    def loser():
        try:
            no_ball()
        finally:
            failed.value = True

    assert p.top_level(lambda: p.try_all(loser, lambda: (p.wait_for(failed), "won")[1])) == "won"


@pytest.mark.parametrize("construct", [p.try_all, p.try_in_order])
def test_all_failures_together_are_one_that_keeps_them_in_the_order_of_the_branches(construct):
    third = p.Fluent("third", construct is p.try_in_order)

    def first():
        p.wait_for(third)
        no_ball()

    def last():
        third.value = True
        p.fail("too late")

    inner = p.do(p.try_in_order, p.do(p.fail, "a"), p.do(p.fail, "b"))
    failure = fails(p.CompositeFailure, "^all 3 failed: no ball; ", lambda: construct(first, inner, last))
    assert [type(each) for each in failure.failures] == [ObjectUnreachable, p.CompositeFailure, p.SimplePlanFailure]
    assert [str(each) for each in failure.failures[1].failures] == ["a", "b"]
    handlers = {p.CompositeFailure: lambda failure: p.give(len(failure.failures))}
    assert p.top_level(lambda: p.with_failure_handling(p.do(construct, first, inner, last), handlers)) == 3


def test_try_in_order_stops_at_the_first_success():
    tried = []

    def look(where):
        tried.append(where)
        if where < 3:
            p.fail(f"nothing at {where}")
        return where

    assert p.top_level(lambda: p.try_each_in_order(look, iter(range(10)))) == 3
    assert tried == [0, 1, 2, 3]


def test_par_loop_does_all_at_once():
    barrier = threading.Barrier(3)
    assert p.top_level(lambda: p.par_loop(lambda each: (barrier.wait(60.0), each * each)[1], [1, 2, 3])) == [1, 4, 9]


def test_a_bug_in_a_branch_is_raised_as_it_is(stays):
    fails(KeyError, "missing", lambda: p.par(stays("a"), stays.once(1, bug)))
    fails(KeyError, "missing", lambda: p.try_all(stays("b"), stays.once(2, bug)))
    fails(KeyError, "missing", lambda: p.try_in_order(bug, stays("c")))
    assert stays.ended == ["a", "b"]


def test_partial_order_keeps_the_order_that_is_asked_for():
    done, names = [], ["serve", "cook", "shop", "lay the table"]
    order = [("shop", "cook", "serve"), ("lay the table", "serve")]
    answers = p.top_level(lambda: p.partial_order({name: p.do(done.append, name) for name in names}, order))
    assert list(answers) == names
    assert done.index("shop") < done.index("cook") < done.index("serve") == 3


@pytest.mark.parametrize(
    "order, told",
    [([("a", "b"), ("b", "a")], "a, b wait for each other"), ([("a", "c")], "no branch 'c': there are a, b")],
)
def test_an_order_that_cannot_be_is_an_error(order, told):
    fails(p.PlanError, told, lambda: p.partial_order({"a": no_ball, "b": no_ball}, order))


def test_the_end_of_a_branch_is_not_caught_by_accident():
    caught = []

    def careless():
        try:
            forever()
        except Exception as error:
            caught.append(error)

    assert p.top_level(lambda: p.pursue(careless, lambda: "over")) == "over"
    assert caught == []


def test_the_trace_tells_how_each_task_ended_within_its_parent_and_survives_json(run_plan, stays):
    def plan():
        gone = p.do(p.fail, NavigationGoalNotReached, "stuck").call
        both = p.do(p.par, stays("stays"), p.do(stays.once(1, gone).call, name="leaves"))
        p.with_failure_handling(both, {p.PlanFailure: lambda failure: p.give()})
        return p.try_in_order(p.do(p.fail, "no", name="first"), p.do(int, "3", name="second"))

    answer, root = run_plan(plan, name="plan")
    trace = p.trace_of(root)
    state = {record.name: record.state for record in trace.records}
    assert answer == 3 and p.Trace.from_json(trace.to_json()) == trace
    assert (state["stays"], state["leaves"], state["first"]) == ("evaporated", "failed", "failed")
    assert (state["second"], state["plan"]) == ("succeeded", "succeeded")
    assert trace.named("leaves")[0].failure == "NavigationGoalNotReached: stuck"
    assert trace.named("second")[0].result == "3" and trace.named("stays")[0].failure
    for record in trace.records[1:]:
        parent = trace.records[record.parent]
        assert record in trace.children(parent.number)
        assert parent.began <= record.began <= record.ended <= parent.ended
    lines = str(trace).split("\n")
    assert lines[0].startswith("+ plan  ") and [line for line in lines if line.startswith("    ! first  ('no')")]
