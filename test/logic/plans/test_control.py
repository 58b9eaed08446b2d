"""Control constructs: what counts, what is ended, in which order, and what the tree tells of it."""

from __future__ import annotations

import threading

import pytest
from plan_tools import Beside, at_once, fails, forever, seen

from nao_library_modules.process_modules import (
    CompositeFailure,
    Fluent,
    PlanError,
    PlanFailure,
    SimplePlanFailure,
    TaskState,
    Trace,
    checkpoint,
    current_task,
    do,
    fail,
    give,
    par,
    par_loop,
    partial_order,
    pursue,
    seq,
    sleep,
    subtask,
    top_level,
    trace_of,
    try_all,
    try_each_in_order,
    try_in_order,
    uninterrupted,
    wait_for,
    wait_until,
    with_failure_handling,
)
from nao_library_modules.process_modules.failures import (
    ManipulationPoseUnreachable,
    NavigationGoalNotReached,
    ObjectUnreachable,
    TaskEvaporatedFailure,
)


def no_ball():
    fail(ObjectUnreachable, "no ball")


def bug():
    return {}["missing"]


# --- one after the other, and at once ---------------------------------------------------------------------------------


def test_seq_goes_in_order_answers_the_last_and_ends_with_the_first_failure():
    done = []
    assert top_level(lambda: seq(do(done.append, 1), do(done.append, 2), lambda: "last")) == "last"
    assert done == [1, 2]
    fails(ObjectUnreachable, "no ball", lambda: seq(do(done.append, 3), no_ball, do(done.append, 4)))
    assert done == [1, 2, 3]


def test_par_answers_all_in_the_order_of_the_branches_when_all_have_ended():
    last, ended = Fluent("last", False), []

    def first():
        wait_for(last)
        ended.append("first")
        return 1

    def second():
        ended.append("second")
        last.value = True
        return 2

    assert top_level(lambda: par(first, second)) == [1, 2]
    assert ended == ["second", "first"]


def test_par_ends_its_other_branches_at_the_first_failure_and_waits_until_they_have_put_things_right(stays):
    right = []

    def put_right():
        with uninterrupted():
            sleep(0.005)
            right.append(True)

    plan = do(par, stays("a", put_right), stays("b", put_right), stays.once(2, no_ball))
    fails(ObjectUnreachable, "no ball", plan)
    assert sorted(stays.ended) == ["a", "b"] and right == [True, True]


def test_par_raises_the_first_failure_though_others_fail_while_they_are_ended(stays):
    late = do(fail, ManipulationPoseUnreachable, "while it was ended").call
    fails(NavigationGoalNotReached, "first", lambda: par(
        stays("a", late), stays.once(1, do(fail, NavigationGoalNotReached, "first").call)
    ))  # fmt: skip


def test_a_hundred_branches_fail_with_the_one_that_failed_first():
    gate = Fluent("gate", -1)

    def branch(number):
        wait_until(lambda: gate.value >= number, [gate])
        gate.update(lambda value: max(value, number + 1))
        fail(f"branch {number}")

    def begin():
        gate.value = 0
        forever()

    fails(PlanFailure, "branch 0$", lambda: par(begin, *(do(branch, number) for number in range(100))))


@pytest.mark.parametrize("construct", [pursue, try_all])
def test_the_first_that_succeeds_decides_and_ends_the_others(construct, stays):
    nested = do(par, stays("a"), do(pursue, stays("b"), do(try_all, stays("c"))))
    assert top_level(do(construct, nested, stays.once(3, lambda: "found"))) == "found"
    assert sorted(stays.ended) == ["a", "b", "c"]


def test_pursue_fails_with_a_failure_that_comes_first(stays):
    fails(ObjectUnreachable, "no ball", lambda: pursue(stays("a"), stays.once(1, no_ball)))
    assert stays.ended == ["a"]


def test_try_all_goes_on_after_a_failure():
    failed = Fluent("failed", False)

    def loser():
        try:
            no_ball()
        finally:
            failed.value = True

    assert top_level(lambda: try_all(loser, lambda: (wait_for(failed), "won")[1])) == "won"


@pytest.mark.parametrize("construct", [try_all, try_in_order])
def test_all_failures_together_are_one_that_keeps_them_in_the_order_of_the_branches(construct):
    third = Fluent("third", construct is try_in_order)

    def first():
        wait_for(third)
        no_ball()

    def last():
        third.value = True
        fail("too late")

    inner = do(try_in_order, do(fail, "a"), do(fail, "b"))
    failure = fails(CompositeFailure, "^all 3 failed: no ball; ", lambda: construct(first, inner, last))
    assert [type(each) for each in failure.failures] == [ObjectUnreachable, CompositeFailure, SimplePlanFailure]
    assert [str(each) for each in failure.failures[1].failures] == ["a", "b"]
    handlers = {CompositeFailure: lambda failure: give(len(failure.failures))}
    assert top_level(lambda: with_failure_handling(do(construct, first, inner, last), handlers)) == 3


def test_try_in_order_stops_at_the_first_success():
    tried = []

    def look(where):
        tried.append(where)
        if where < 3:
            fail(f"nothing at {where}")
        return where

    assert top_level(lambda: try_each_in_order(look, iter(range(10)))) == 3
    assert tried == [0, 1, 2, 3]


def test_par_loop_does_all_at_once():
    barrier = threading.Barrier(3)
    assert top_level(lambda: par_loop(lambda each: (barrier.wait(10.0), each * each)[1], [1, 2, 3])) == [1, 4, 9]


def test_a_bug_in_a_branch_is_raised_as_it_is(stays):
    fails(KeyError, "missing", lambda: par(stays("a"), stays.once(1, bug)))
    fails(KeyError, "missing", lambda: try_all(stays("b"), stays.once(2, bug)))
    fails(KeyError, "missing", lambda: try_in_order(bug, stays("c")))
    assert stays.ended == ["a", "b"]


# --- a partial order --------------------------------------------------------------------------------------------------


def test_partial_order_keeps_the_order_that_is_asked_for():
    done, names = [], ["serve", "cook", "shop", "lay the table"]
    order = [("shop", "cook", "serve"), ("lay the table", "serve")]
    answers = top_level(lambda: partial_order({name: do(done.append, name) for name in names}, order))
    assert list(answers) == names
    assert done.index("shop") < done.index("cook") < done.index("serve") == 3


def test_a_step_that_fails_leaves_what_waits_for_it_undone():
    done = []
    steps = {"a": do(done.append, "a"), "b": do(fail, "b broke"), "c": do(done.append, "c")}
    fails(PlanFailure, "b broke", lambda: partial_order(steps, [("a", "b", "c")]))
    assert done == ["a"]


@pytest.mark.parametrize(
    "order, told",
    [([("a", "b"), ("b", "a")], "a, b wait for each other"), ([("a", "c")], "no branch 'c': there are a, b")],
)
def test_an_order_that_cannot_be_is_an_error(order, told):
    fails(PlanError, told, lambda: partial_order({"a": no_ball, "b": no_ball}, order))


# --- mistakes ---------------------------------------------------------------------------------------------------------


def test_what_is_no_branch_is_an_error_and_nothing_to_do_is_done():
    fails(PlanError, "'walk' is no branch: give a function", lambda: seq("walk"))
    fails(PlanError, "pursue needs a branch", pursue)
    assert not top_level(seq) and not top_level(par)


def test_plans_begin_with_top_level_once_in_each_thread():
    with pytest.raises(PlanError, match="outside of a plan"):
        seq(no_ball)
    with pytest.raises(PlanError, match="outside of a plan"):
        current_task()
    fails(PlanError, "top_level inside of a plan", lambda: top_level(no_ball))
    assert top_level(lambda: at_once(lambda: top_level(lambda: seq(lambda: "elsewhere")))) == ["elsewhere"]


# --- branches that somebody ends --------------------------------------------------------------------------------------


def test_a_branch_that_somebody_ends_is_a_failure_of_its_construct(stays):
    plan = Beside(lambda: par(stays("a"), stays("b")))
    seen(stays.there >= 2)
    plan.root.find("a").evaporate("no time for a")
    plan.fails(TaskEvaporatedFailure, r"the task .*/par/a was evaporated: no time for a")
    assert sorted(stays.ended) == ["a", "b"]


def test_a_branch_of_try_all_that_somebody_ends_has_failed(stays):
    plan = Beside(lambda: try_all(stays("a"), do(fail, "no")))
    seen(stays.there)
    plan.root.find("a").evaporate("enough of it")
    with pytest.raises(CompositeFailure) as caught:
        plan.ended()
    assert isinstance(caught.value.failures[0], TaskEvaporatedFailure)


def test_the_end_of_a_branch_is_not_caught_by_accident():
    caught = []

    def careless():
        try:
            forever()
        except Exception as error:
            caught.append(error)

    assert top_level(lambda: pursue(careless, lambda: "over")) == "over"
    assert caught == []


def test_a_plan_that_is_ended_before_its_branches_begin_begins_none():
    done = []

    def body():
        current_task().evaporate("at once")
        par(do(done.append, 1), do(done.append, 2))

    fails(TaskEvaporatedFailure, "at once", body)
    assert done == []


# --- the tree and its trace -------------------------------------------------------------------------------------------


def test_the_tree_tells_what_came_of_everything(run_plan):
    answer, root = run_plan(lambda: par(do(int, "3", name="count"), lambda: subtask(do(len, "abc"))), name="plan")
    assert answer == [3, 3]
    assert [task.path for task in root] == ["plan", "plan/par", "plan/par/count", "plan/par/step", "plan/par/step/len"]
    assert {task.state for task in root} == {TaskState.SUCCEEDED}
    assert root.find("count").facts == {"arguments": "'3'"} and root.find("len").result == 3
    assert all(task.created <= task.began <= task.ended for task in root)
    with pytest.raises(PlanError, match="no task 'three' in plan: there are plan, par, count, step, len"):
        root.find("three")


def test_the_trace_tells_how_each_task_ended_within_its_parent_and_survives_json(run_plan, stays):
    def plan():
        gone = do(fail, NavigationGoalNotReached, "stuck").call
        both = do(par, stays("stays"), do(stays.once(1, gone).call, name="leaves"))
        with_failure_handling(both, {PlanFailure: lambda failure: give()})
        return try_in_order(do(fail, "no", name="first"), do(int, "3", name="second"))

    answer, root = run_plan(plan, name="plan")
    trace = trace_of(root)
    state = {record.name: record.state for record in trace.records}
    assert answer == 3 and Trace.from_json(trace.to_json()) == trace
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


def test_a_trace_is_taken_while_the_plan_grows():
    stop = Fluent("stop", False)

    def grow():
        while not stop.value:
            par(do(int, "1"), do(int, "2"))
            checkpoint()

    plan = Beside(lambda: par(grow, grow))

    def look():
        traces = [trace_of(plan.root) for _ in range(10)]
        return all(Trace.from_json(trace.to_json()) == trace for trace in traces)

    assert at_once(look, look) == [True, True]
    stop.value = True
    plan.ended()
