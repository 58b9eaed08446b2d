"""Control constructs where their ends and failures meet."""

from __future__ import annotations

import threading

import pytest
from cram_waits import SHORT, forever, seen, states

from nao_library_modules.process_modules.control import (
    do,
    par,
    partial_order,
    pursue,
    seq,
    subtask,
    top_level,
    try_all,
    try_each_in_order,
    try_in_order,
)
from nao_library_modules.process_modules.failures import (
    CompositeFailure,
    ManipulationPoseUnreachable,
    NavigationGoalNotReached,
    PlanFailure,
    TaskEvaporatedFailure,
    fail,
)
from nao_library_modules.process_modules.flow import checkpoint, sleep, uninterrupted
from nao_library_modules.process_modules.fluents import Fluent
from nao_library_modules.process_modules.handling import give, with_failure_handling
from nao_library_modules.process_modules.tasks import TaskState, current_task
from nao_library_modules.process_modules.trace import Trace, trace_of
from nao_library_modules.process_modules.waiting import wait_for


def test_par_succeeds_only_when_all_have_ended():
    ended, go = [], Fluent("go", False)

    def slow():
        wait_for(go)
        ended.append("slow")

    def quick():
        ended.append("quick")
        go.value = True

    top_level(lambda: par(slow, quick))
    assert ended == ["quick", "slow"]


def test_par_raises_the_first_failure_though_others_fail_while_they_are_ended():
    waiting = Fluent("waiting", False)

    def stumbles_at_the_end():
        try:
            waiting.value = True
            forever()
        finally:
            fail(ManipulationPoseUnreachable, "while it was ended")

    def first():
        wait_for(waiting)
        fail(NavigationGoalNotReached, "first")

    with pytest.raises(NavigationGoalNotReached, match="first"):
        top_level(lambda: par(stumbles_at_the_end, first))


def test_the_failure_of_par_waits_for_those_that_put_things_right():
    waiting, right = Fluent("waiting", False), []

    def careful():
        try:
            waiting.value = True
            forever()
        finally:
            with uninterrupted():
                sleep(SHORT)
                right.append(True)

    def first():
        wait_for(waiting)
        fail("first")

    with pytest.raises(PlanFailure, match="first"):
        top_level(lambda: par(careful, first))
    assert right == [True]


def test_branches_that_have_ended_are_not_evaporated(beside):
    roots = []
    done = Fluent("done", False)

    def last():
        wait_for(done)
        fail("late")

    with pytest.raises(PlanFailure, match="late"):
        top_level(
            lambda: par(do(setattr, done, "value", True, name="quick"), do(last, name="last")),
            observers=[roots.append],
        )
    assert states(roots[0])["quick"] is TaskState.SUCCEEDED and states(roots[0])["last"] is TaskState.FAILED


def test_pursue_ends_branches_of_branches():
    ended, waiting = [], Fluent("waiting", 0)

    def deep(name):
        try:
            waiting.update(lambda count: count + 1)
            forever()
        finally:
            ended.append(name)

    def quick():
        wait_for(waiting >= 3)
        return "quick"

    nested = do(par, do(deep, "a"), do(pursue, do(deep, "b"), do(try_all, do(deep, "c"))))
    assert top_level(lambda: pursue(nested, quick)) == "quick"
    assert sorted(ended) == ["a", "b", "c"]


def test_try_all_keeps_the_failures_in_the_order_of_the_branches():
    gate = Fluent("gate", 0)

    def branch(number):
        wait_for(gate >= 2 - number)
        gate.value = 3 - number
        fail(f"branch {number}")

    with pytest.raises(CompositeFailure) as caught:
        top_level(lambda: try_all(*(do(branch, number) for number in range(3))))
    assert [str(failure) for failure in caught.value.failures] == ["branch 0", "branch 1", "branch 2"]


def test_composite_failures_of_composite_failures_keep_their_parts():
    inner = do(try_in_order, do(fail, "a"), do(fail, "b"))
    with pytest.raises(CompositeFailure) as caught:
        top_level(lambda: try_all(inner, do(fail, "c")))
    first, second = caught.value.failures
    assert [str(failure) for failure in first.failures] == ["a", "b"] and str(second) == "c"


def test_a_composite_failure_is_handled_as_a_plan_failure():
    body = do(try_in_order, do(fail, "a"), do(fail, "b"))
    handlers = {CompositeFailure: lambda failure: give(len(failure.failures))}
    assert top_level(lambda: with_failure_handling(body, handlers)) == 2


def test_try_each_in_order_goes_to_the_next_item_only_after_a_failure():
    tried = []

    def attempt(item):
        tried.append(item)
        if item < 3:
            fail(f"not {item}")
        return item

    assert top_level(lambda: try_each_in_order(attempt, iter(range(10)))) == 3
    assert tried == [0, 1, 2, 3]


def test_an_evaporated_branch_of_try_all_is_one_that_failed(beside):
    waiting = Fluent("waiting", False)

    def stays():
        waiting.value = True
        forever()

    plan = beside(lambda: try_all(do(stays, name="stays"), do(fail, "no")))
    seen(waiting)
    plan.root.find("stays").evaporate("enough of it")
    with pytest.raises(CompositeFailure) as caught:
        plan.ended()
    assert [type(failure) for failure in caught.value.failures][0] is TaskEvaporatedFailure


def test_a_failure_in_an_ordered_step_leaves_later_ones_undone():
    done = []
    steps = {"a": do(done.append, "a"), "b": do(fail, "b broke"), "c": do(done.append, "c")}
    with pytest.raises(PlanFailure, match="b broke"):
        top_level(lambda: partial_order(steps, [("a", "b", "c")]))
    assert done == ["a"]


def test_a_plan_that_is_ended_before_its_branches_begin_begins_none():
    done = []

    def body():
        current_task().evaporate("at once")
        par(do(done.append, 1), do(done.append, 2))

    with pytest.raises(TaskEvaporatedFailure, match="at once"):
        top_level(body)
    assert done == []


def test_ending_twice_is_ending_once(beside):
    ended, waiting = [], Fluent("waiting", False)

    def body():
        try:
            waiting.value = True
            forever()
        finally:
            ended.append(True)

    plan = beside(body)
    seen(waiting)
    threads = [threading.Thread(target=plan.root.evaporate, args=(f"reason {number}",)) for number in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    with pytest.raises(TaskEvaporatedFailure, match="reason"):
        plan.ended()
    plan.root.evaporate("much later")
    assert ended == [True] and "much later" not in plan.root.reason


def test_a_task_above_that_is_ended_while_one_below_ends_is_ended_too(beside):
    """The signal names the lower one; the upper one is what ends in the end, and as a failure of the plan."""
    waiting = Fluent("waiting", False)

    def body():
        try:
            waiting.value = True
            forever()
        finally:
            plan.root.evaporate("all of it")

    plan = beside(lambda: subtask(do(body, name="below")))
    seen(waiting)
    plan.root.find("below").evaporate("only this")
    with pytest.raises(TaskEvaporatedFailure, match="all of it"):
        plan.ended()


def test_why_a_task_ended_stays_when_it_is_woken_afterwards(beside):
    waiting = Fluent("waiting", False)
    plan = beside(lambda: (setattr(waiting, "value", True), forever()))
    seen(waiting)
    plan.root.suspend("a pause")
    plan.root.evaporate("why it ended")
    plan.root.wake_up("woken too late")
    with pytest.raises(TaskEvaporatedFailure, match="why it ended"):
        plan.ended()
    assert plan.root.reason == "why it ended"


def test_an_end_in_the_middle_of_a_protected_part_counts_afterwards(beside):
    inside, go, after = Fluent("inside", False), Fluent("go", False), []

    def body():
        with uninterrupted():
            inside.value = True
            wait_for(go)
            after.append("protected")
        checkpoint()
        after.append("never")

    plan = beside(body)
    seen(inside)
    plan.root.evaporate("over")
    assert not plan.root.state.over
    go.value = True
    with pytest.raises(TaskEvaporatedFailure, match="over"):
        plan.ended()
    assert after == ["protected"]


def test_joining_another_task_of_the_tree():
    def waits_for(name):
        def body():
            task = tree().find(name)
            task.join()
            return task.value()

        return body

    root = []

    def tree():
        return root[0]

    def plan():
        root.append(current_task())
        return par(do(sleep, 0.001, name="first"), do(lambda: 7, name="seven"), waits_for("seven"))

    assert top_level(plan)[2] == 7


def test_a_top_level_beside_another_one_is_none_inside_of_it():
    outcome = []

    def elsewhere():
        outcome.append(top_level(lambda: seq(lambda: "elsewhere")))

    def body():
        thread = threading.Thread(target=elsewhere)
        thread.start()
        thread.join()
        return outcome[0]

    assert top_level(body) == "elsewhere"


def test_the_trace_of_everything_tells_how_each_ended():
    roots, waiting = [], Fluent("waiting", False)

    def stays():
        waiting.value = True
        forever()

    def leaves():
        wait_for(waiting)
        fail(NavigationGoalNotReached, "stuck")

    def plan():
        with_failure_handling(
            lambda: par(do(stays, name="stays"), do(leaves, name="leaves")), {PlanFailure: lambda failure: give()}
        )
        return try_in_order(do(fail, "no", name="first"), do(int, "3", name="second"))

    assert top_level(plan, name="plan", observers=[roots.append]) == 3
    trace = trace_of(roots[0])
    state = {record.name: record.state for record in trace.records}
    assert state["stays"] == "evaporated" and state["leaves"] == "failed"
    assert state["first"] == "failed" and state["second"] == "succeeded" and state["plan"] == "succeeded"
    assert "stuck" in trace.named("leaves")[0].failure
    assert trace.named("stays")[0].failure
    for record in trace.records:
        parent = trace.records[record.parent] if record.parent is not None else record
        assert parent.number == (record.parent if record.parent is not None else 0)
        assert parent.began <= record.began <= record.ended <= parent.ended
    assert Trace.from_json(trace.to_json()) == trace


def test_a_trace_is_taken_from_many_threads_while_the_plan_grows(beside):
    stop = Fluent("stop", False)

    def grow():
        while not stop.value:
            par(do(int, "1"), do(int, "2"))
            checkpoint()

    plan = beside(lambda: par(grow, grow))
    problems = []

    def look():
        try:
            for _ in range(30):
                trace = trace_of(plan.root)
                assert Trace.from_json(trace.to_json()) == trace
        except Exception as error:
            problems.append(error)

    threads = [threading.Thread(target=look) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    stop.value = True
    plan.ended()
    assert problems == []
