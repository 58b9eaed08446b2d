"""Tasks that are ended, suspended and woken from outside, at every kind of wait."""

from __future__ import annotations

import pytest
from plan_tools import LIMIT, Beside, at_once, fails, forever, seen, stays_false

from nao_library_modules.process_modules import (
    Fluent,
    PlanError,
    PlanFailure,
    Policy,
    TaskState,
    checkpoint,
    current_task,
    do,
    do_retry,
    fail,
    get_counter,
    give,
    par,
    partial_order,
    pursue,
    retry_after_suspension,
    seq,
    sleep,
    subtask,
    timeout_policy,
    top_level,
    try_all,
    try_in_order,
    uninterrupted,
    wait_for,
    wait_until,
    whenever,
    with_failure_handling,
    with_policy,
    with_retry_counters,
)
from nao_library_modules.process_modules.failures import TaskEvaporatedFailure

# --- ended ------------------------------------------------------------------------------------------------------------


def test_a_plan_is_ended_where_it_waits_and_puts_things_right(stays):
    done = []

    def put_right():
        with uninterrupted():
            sleep(0.001)
            done.append("put right")

    plan = Beside(lambda: par(stays("a", put_right), stays("b", put_right)))
    seen(stays.there >= 2)
    plan.root.evaporate("enough")
    plan.fails(TaskEvaporatedFailure, "enough")
    assert done == ["put right"] * 2
    assert {task.state for task in plan.root} == {TaskState.EVAPORATED}


def test_who_does_not_protect_it_cannot_wait_while_it_is_ended(stays):
    plan = Beside(stays("a", lambda: sleep(1000.0)).call)
    seen(stays.there)
    plan.root.evaporate()
    plan.fails(TaskEvaporatedFailure, "evaporated")
    assert stays.ended == ["a"]


def test_an_end_in_the_middle_of_a_protected_part_counts_afterwards():
    inside, go, after = Fluent("inside", False), Fluent("go", False), []

    def body():
        with uninterrupted():
            inside.value = True
            wait_for(go)
            after.append("protected")
        checkpoint()
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
            subtask(stays("step"))
        except TaskEvaporatedFailure as failure:
            return failure.reason

    plan = Beside(body)
    seen(stays.there)
    plan.root.find("step").evaporate("skip it")
    assert plan.ended() == "skip it" and plan.root.state is TaskState.SUCCEEDED


def test_a_task_above_that_is_ended_while_one_below_ends_is_ended_too(stays):
    plan = Beside(lambda: subtask(stays("below", lambda: plan.root.evaporate("all of it"))))
    seen(stays.there)
    plan.root.find("below").evaporate("only this")
    plan.fails(TaskEvaporatedFailure, "all of it")


def test_ending_many_times_is_ending_once_and_the_first_reason_stays(stays):
    plan = Beside(stays("a").call)
    seen(stays.there)
    plan.root.suspend("a pause")
    plan.root.evaporate("why it ended")
    at_once(*[lambda: plan.root.evaporate("why not")] * 4)
    plan.root.wake_up("woken too late")
    plan.fails(TaskEvaporatedFailure, "why it ended")
    plan.root.evaporate("much later")
    assert stays.ended == ["a"] and plan.root.reason == "why it ended"


def test_a_plan_that_computes_can_be_ended_at_its_checkpoints():
    turns = Fluent("turns", 0)

    def compute():
        while True:
            turns.update(lambda count: count + 1)
            checkpoint()

    plan = Beside(compute)
    seen(turns >= 3)
    plan.root.evaporate()
    plan.fails(TaskEvaporatedFailure)


def test_a_task_may_end_itself():
    fails(TaskEvaporatedFailure, "had enough", lambda: (current_task().evaporate("had enough"), sleep(1000.0)))


# --- asked for --------------------------------------------------------------------------------------------------------


def test_a_result_is_asked_for_when_it_is_there(stays):
    plan = Beside(stays("a").call)
    seen(stays.there)
    with pytest.raises(PlanError, match="is running: it has no result yet"):
        plan.root.value()
    assert plan.root.join(timeout=0.001) is False
    plan.root.evaporate("over")
    assert plan.root.join(timeout=LIMIT)
    plan.fails(TaskEvaporatedFailure)
    with pytest.raises(TaskEvaporatedFailure, match="over"):
        plan.root.value()


def test_a_task_waits_for_another_one_of_its_tree():
    def waits():
        task = current_task().tree.root.find("seven")
        task.join()
        return task.value()

    assert top_level(lambda: par(do(lambda: (sleep(0.001), 7)[1], name="seven"), waits)) == [7, 7]


# --- suspended --------------------------------------------------------------------------------------------------------


def handler_waits(wait):
    with_failure_handling(do(fail, "stumbled"), {PlanFailure: lambda failure: (wait(), give())})


def retried_after(wait):
    with with_retry_counters(tries=1):
        once = lambda: get_counter("tries") and fail("again")  # noqa: E731
        with_failure_handling(once, {PlanFailure: lambda failure: do_retry("tries", before=wait)})


def run_whenever(wait):
    fluent, ended = Fluent("once", True), Fluent("ended", False)

    def body():
        wait()
        fluent.value = False
        ended.value = True

    def keep_pulsing():
        while True:
            fluent.pulse()
            sleep(0.002)

    pursue(do(whenever, fluent, body), do(wait_for, ended), keep_pulsing)


def before_a_policy(wait):
    with_policy(Policy("slow", Fluent("never", False), init=lambda: (wait(), True)[1]), do(int, "1"))


WAITS = {
    "plain": lambda wait: wait(),
    "seq": lambda wait: seq(wait, wait),
    "par": lambda wait: par(wait, wait),
    "pursue": lambda wait: pursue(wait, forever),
    "try_all": lambda wait: try_all(do(fail, "no"), wait),
    "try_in_order": lambda wait: try_in_order(do(fail, "no"), wait),
    "partial_order": lambda wait: partial_order({"a": wait, "b": wait}, [("a", "b")]),
    "subtask": lambda wait: subtask(do(wait)),
    "failure handler": handler_waits,
    "before a retry": retried_after,
    "policy": lambda wait: with_policy(timeout_policy(1000.0), wait),
    "policy's init": before_a_policy,
    "retry_after_suspension": retry_after_suspension,
    "whenever": run_whenever,
}
KINDS = {
    "wait_for": wait_for,
    "timeout": lambda go: wait_for(go, timeout=1000.0) or fail("timed out"),
    "wait_until": lambda go: wait_until(lambda: go.value),
    "compute": lambda go: [(sleep(0.0005), checkpoint()) for _ in iter(lambda: bool(go.value), True)],
}


@pytest.mark.parametrize("where, kind", [*((each, "wait_for") for each in WAITS), *(("plain", each) for each in KINDS)])
def test_a_plan_is_suspended_wherever_it_waits_and_goes_on_when_it_is_woken(where, kind):
    reached, go, over = Fluent("reached", 0), Fluent("go", False), Fluent("over", False)

    def wait():
        reached.update(lambda count: count + 1)
        KINDS[kind](go)

    def body():
        WAITS[where](wait)
        checkpoint()
        over.value = True
        return "done"

    plan = Beside(body)
    seen(reached)
    plan.root.suspend("a pause")
    assert plan.root.reason == "a pause"
    go.value = True
    assert stays_false(over) and plan.root.state is TaskState.SUSPENDED
    plan.root.wake_up()
    assert plan.ended() == "done"
    assert all(task.state.over for task in plan.root)


@pytest.mark.parametrize("where", WAITS)
def test_a_plan_is_ended_while_it_is_suspended_wherever_it_waits(where):
    reached, go = Fluent("reached", 0), Fluent("go", False)
    plan = Beside(do(WAITS[where], lambda: (reached.update(lambda count: count + 1), wait_for(go))))
    seen(reached)
    plan.root.suspend()
    go.value = True
    plan.root.evaporate("enough")
    plan.fails(TaskEvaporatedFailure, "enough")
    assert all(task.state.over or task.state is TaskState.CREATED for task in plan.root)


def test_as_often_as_it_is_suspended_it_has_to_be_woken_also_by_many_at_once():
    go = Fluent("go", False)
    plan = Beside(lambda: par(*[do(wait_for, go)] * 3))
    plan.root.suspend()
    plan.root.suspend()
    plan.root.wake_up()
    assert plan.root.state is TaskState.SUSPENDED
    plan.root.wake_up()
    with pytest.raises(PlanError, match="is not suspended"):
        plan.root.wake_up()
    at_once(*[lambda: [(plan.root.suspend(), plan.root.wake_up()) for _ in range(30)]] * 4)
    assert plan.root.state is TaskState.RUNNING
    go.value = True
    assert plan.ended() == [True] * 3


def test_a_branch_alone_is_suspended_and_its_siblings_go_on():
    reached, go, counted = Fluent("reached", False), Fluent("go", False), Fluent("counted", 0)

    def counts():
        for _ in range(10):
            sleep(0.001)
            counted.update(lambda count: count + 1)

    pauses = do(lambda: (setattr(reached, "value", True), wait_for(go)), name="pauses")
    plan = Beside(lambda: par(pauses, lambda: (wait_for(go), counts())))
    seen(reached)
    branch = plan.root.find("pauses")
    branch.suspend()
    go.value = True
    seen(counted >= 10)
    assert not branch.state.over and plan.root.state is TaskState.RUNNING
    branch.wake_up()
    plan.ended()


def test_branches_that_begin_in_a_suspended_plan_wait():
    inside, go, begun = Fluent("inside", False), Fluent("go", False), Fluent("begun", 0)

    def body():
        inside.value = True
        with uninterrupted():
            wait_for(go)
        par(*[lambda: begun.update(lambda count: count + 1)] * 2)

    plan = Beside(body)
    seen(inside)
    plan.root.suspend()
    go.value = True
    assert stays_false(begun)
    plan.root.wake_up()
    plan.ended()
    assert begun.value == 2


def test_a_timeout_of_a_wait_does_not_end_a_suspension():
    reached = Fluent("reached", False)
    plan = Beside(lambda: (setattr(reached, "value", True), wait_for(Fluent("never", False), timeout=0.01))[1])
    seen(reached)
    plan.root.suspend()
    assert stays_false(Fluent("never", False)) and plan.root.state is TaskState.SUSPENDED
    plan.root.wake_up()
    assert plan.ended() is False


def test_what_cannot_pause_is_ended_and_begun_again():
    sent, cancelled, go = Fluent("sent", 0), Fluent("cancelled", 0), Fluent("go", False)

    def goal():
        try:
            sent.update(lambda count: count + 1)
            wait_for(go)
            return "arrived"
        finally:
            if not go.value:
                cancelled.value += 1

    plan = Beside(lambda: retry_after_suspension(goal))
    seen(sent)
    plan.root.suspend()
    assert seen(cancelled) == 1 and sent.value == 1
    plan.root.wake_up()
    seen(sent >= 2)
    go.value = True
    assert plan.ended() == "arrived"
    assert (sent.value, cancelled.value) == (2, 1)
