"""Tasks that are ended, suspended and woken from outside, at every kind of wait."""

from __future__ import annotations

import threading

import pytest
from plan_tools import Beside, seen, stays_false

import nao_library_modules.process_modules as p
from nao_library_modules.process_modules.failures import TaskEvaporatedFailure
from naoqi.errors import NaoError


def test_an_end_in_the_middle_of_a_protected_part_counts_afterwards():
    inside, go, after = p.Fluent("inside", False), p.Fluent("go", False), []

    def body():
        with p.uninterrupted():
            inside.value = True
            p.wait_for(go)
            after.append("protected")
        p.checkpoint()
        after.append("never")

    plan = Beside(body)
    seen(inside)
    plan.root.evaporate("over")
    assert not plan.root.state.over
    go.value = True
    plan.fails(TaskEvaporatedFailure, "over")
    assert after == ["protected"]


def test_a_step_that_somebody_ends_fails_and_its_plan_may_go_on(stays):
    def body():
        try:
            p.subtask(stays("step"))
        except TaskEvaporatedFailure as failure:
            return failure.reason

    plan = Beside(body)
    seen(stays.there)
    plan.root.find("step").evaporate("skip it")
    assert plan.ended() == "skip it" and plan.root.state is p.TaskState.SUCCEEDED


def handler_waits(wait):
    p.with_failure_handling(p.do(p.fail, "stumbled"), {p.PlanFailure: lambda failure: (wait(), p.give())})


def retried_after(wait):
    with p.with_retry_counters(tries=1):
        once = lambda: p.get_counter("tries") and p.fail("again")  # noqa: E731
        p.with_failure_handling(once, {p.PlanFailure: lambda failure: p.do_retry("tries", before=wait)})


WAITS = {
    "plain": lambda wait: wait(),
    "par": lambda wait: p.par(wait, wait),
    "partial_order": lambda wait: p.partial_order({"a": wait, "b": wait}, [("a", "b")]),
    "failure handler": handler_waits,
    "before a retry": retried_after,
    "policy": lambda wait: p.with_policy(p.timeout_policy(1000.0), wait),
    "retry_after_suspension": p.retry_after_suspension,
}
KINDS = {
    "wait_for": p.wait_for,
    "timeout": lambda go: p.wait_for(go, timeout=1000.0) or p.fail("timed out"),
    "compute": lambda go: [(p.sleep(0.0005), p.checkpoint()) for _ in iter(lambda: bool(go.value), True)],
}


@pytest.mark.parametrize("where, kind", [*((each, "wait_for") for each in WAITS), *(("plain", each) for each in KINDS)])
def test_a_plan_is_suspended_wherever_it_waits_and_goes_on_when_it_is_woken(where, kind):
    reached, go, over = p.Fluent("reached", 0), p.Fluent("go", False), p.Fluent("over", False)

    def wait():
        reached.update(lambda count: count + 1)
        KINDS[kind](go)

    def body():
        WAITS[where](wait)
        p.checkpoint()
        over.value = True
        return "done"

    plan = Beside(body)
    seen(reached)
    plan.root.suspend("a pause")
    assert plan.root.reason == "a pause"
    go.value = True
    assert stays_false(over) and plan.root.state is p.TaskState.SUSPENDED
    plan.root.wake_up()
    assert plan.ended() == "done"
    assert all(task.state.over for task in plan.root)


@pytest.mark.parametrize("suspended", [True, False])
@pytest.mark.parametrize("where", WAITS)
def test_a_plan_is_ended_wherever_it_waits_also_while_it_is_suspended(where, suspended):
    reached, go = p.Fluent("reached", 0), p.Fluent("go", False)
    plan = Beside(p.do(WAITS[where], lambda: (reached.update(lambda count: count + 1), KINDS["compute"](go))))
    seen(reached)
    if suspended:
        plan.root.suspend()
        go.value = True
    plan.root.evaporate("enough")
    plan.fails(TaskEvaporatedFailure, "enough")
    assert all(task.state.over or task.state is p.TaskState.CREATED for task in plan.root)


def test_as_often_as_it_is_suspended_it_has_to_be_woken():
    go = p.Fluent("go", False)
    plan = Beside(lambda: p.par(*[p.do(p.wait_for, go)] * 3))
    plan.root.suspend()
    plan.root.suspend()
    plan.root.wake_up()
    assert plan.root.state is p.TaskState.SUSPENDED
    plan.root.wake_up()
    with pytest.raises(p.PlanError, match="is not suspended"):
        plan.root.wake_up()
    go.value = True
    assert plan.ended() == [True] * 3


def test_what_cannot_pause_is_ended_and_begun_again():
    sent, cancelled, go = p.Fluent("sent", 0), p.Fluent("cancelled", 0), p.Fluent("go", False)

    def goal():
        try:
            sent.update(lambda count: count + 1)
            p.wait_for(go)
            return "arrived"
        finally:
            if not go.value:
                cancelled.value += 1

    plan = Beside(lambda: p.retry_after_suspension(goal))
    seen(sent)
    plan.root.suspend()
    assert seen(cancelled) == 1 and sent.value == 1
    plan.root.wake_up()
    seen(sent >= 2)
    go.value = True
    assert plan.ended() == "arrived"
    assert (sent.value, cancelled.value) == (2, 1)


def test_a_plan_that_is_started_runs_beside_and_is_waited_for_or_cancelled():
    begun, go_on = threading.Event(), p.Fluent("go on", False)

    @p.def_top_level_plan
    def wait_for_it(answer):
        begun.set()
        p.wait_for(go_on)
        return answer

    first, second = wait_for_it.start("done"), wait_for_it.start("never")
    assert begun.wait(60.0) and not first.done()
    with pytest.raises(NaoError, match="the plan wait_for_it is not over after 0.01 s; it goes on"):
        first.result(0.01)
    second.cancel()
    with pytest.raises(TaskEvaporatedFailure, match="cancelled"):
        second.result(60.0)
    go_on.value = True
    assert first.result(60.0) == "done"
