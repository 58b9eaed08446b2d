"""Suspension and ends at every kind of wait."""

from __future__ import annotations

import threading

import pytest
from cram_waits import SHORT, forever, seen

from nao_library_modules.process_modules.control import (
    do,
    par,
    partial_order,
    pursue,
    seq,
    subtask,
    top_level,
    try_all,
    try_in_order,
)
from nao_library_modules.process_modules.failures import PlanFailure, TaskEvaporatedFailure, fail
from nao_library_modules.process_modules.flow import (
    checkpoint,
    retry_after_suspension,
    sleep,
    uninterrupted,
    wait_until,
)
from nao_library_modules.process_modules.fluents import Fluent
from nao_library_modules.process_modules.handling import (
    do_retry,
    get_counter,
    give,
    with_failure_handling,
    with_retry_counters,
)
from nao_library_modules.process_modules.policies import Policy, timeout_policy, with_policy
from nao_library_modules.process_modules.tasks import TaskState
from nao_library_modules.process_modules.waiting import wait_for, whenever


def handler_waits(wait):
    return with_failure_handling(do(fail, "stumbled"), {PlanFailure: lambda failure: (wait(), give())})


def retried_after(wait):
    def body():
        with with_retry_counters(tries=1):

            def once():
                if get_counter("tries"):
                    fail("again")

            with_failure_handling(once, {PlanFailure: lambda failure: do_retry("tries", before=wait)})

    return body()


def run_whenever(wait):
    fluent = Fluent("once", True)

    def body():
        wait()
        fluent.value = False
        ended.value = True

    ended = Fluent("ended", False)
    fluent.pulse()
    pursue(do(whenever, fluent, body), do(wait_for, ended), do(keep_pulsing, fluent))


def keep_pulsing(fluent):
    while True:
        fluent.pulse()
        sleep(0.002)


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
    "policy's init": lambda wait: with_policy(
        Policy("slow", Fluent("never", False), init=lambda: (wait(), True)[1]), do(int, "1")
    ),
    "retry_after_suspension": lambda wait: retry_after_suspension(wait),
    "whenever": run_whenever,
}


@pytest.mark.parametrize("where", WAITS)
@pytest.mark.parametrize("kind", ["wait_for", "timeout", "wait_until", "compute"])
def test_a_plan_is_suspended_wherever_it_waits(where, kind, beside):
    reached, go, over = Fluent("reached", 0), Fluent("go", False), Fluent("over", False)

    def wait():
        reached.update(lambda count: count + 1)
        if kind == "wait_for":
            wait_for(go)
        elif kind == "timeout":
            assert wait_for(go, timeout=1000.0)
        elif kind == "wait_until":
            wait_until(lambda: go.value)
        else:
            while not go.value:
                sleep(0.0005)
                checkpoint()

    def body():
        WAITS[where](wait)
        checkpoint()
        over.value = True
        return "done"

    plan = beside(body)
    seen(reached)
    plan.root.suspend("a pause")
    go.value = True
    assert top_level(lambda: wait_for(over, timeout=SHORT)) is False
    assert plan.root.state is TaskState.SUSPENDED
    plan.root.wake_up()
    assert plan.ended() == "done"
    assert {task.state for task in plan.root} <= {TaskState.SUCCEEDED, TaskState.FAILED, TaskState.EVAPORATED}


@pytest.mark.parametrize("where", WAITS)
def test_a_plan_is_ended_while_it_is_suspended_wherever_it_waits(where, beside):
    reached, go = Fluent("reached", 0), Fluent("go", False)

    def wait():
        reached.update(lambda count: count + 1)
        wait_for(go)

    plan = beside(do(WAITS[where], wait))
    seen(reached)
    plan.root.suspend()
    go.value = True
    plan.root.evaporate("enough")
    with pytest.raises(TaskEvaporatedFailure, match="enough"):
        plan.ended()
    assert all(task.state.over or task.state is TaskState.CREATED for task in plan.root)


def test_a_branch_alone_is_suspended_and_its_siblings_go_on(beside):
    reached, go = Fluent("reached", False), Fluent("go", False)
    counted = Fluent("counted", 0)

    def pauses():
        reached.value = True
        wait_for(go)

    def counts():
        for _ in range(20):
            sleep(0.001)
            counted.update(lambda count: count + 1)

    plan = beside(lambda: par(do(pauses, name="pauses"), counts))
    seen(reached)
    branch = plan.root.find("pauses")
    branch.suspend()
    go.value = True
    seen(counted >= 20)
    assert not branch.state.over and plan.root.state is TaskState.RUNNING
    branch.wake_up()
    plan.ended()


def test_branches_that_begin_in_a_suspended_plan_wait(beside):
    inside, go, begun = Fluent("inside", False), Fluent("go", False), Fluent("begun", False)

    def body():
        inside.value = True
        with uninterrupted():
            wait_until(lambda: go.value, [go])
        par(do(setattr, begun, "value", True), do(setattr, begun, "value", True))

    plan = beside(body)
    seen(inside)
    plan.root.suspend()
    go.value = True
    assert top_level(lambda: wait_for(begun, timeout=SHORT)) is False
    plan.root.wake_up()
    plan.ended()
    assert begun.value


def test_a_timeout_of_a_wait_does_not_end_a_suspension(beside):
    reached = Fluent("reached", False)

    def body():
        reached.value = True
        return wait_for(Fluent("never", False), timeout=0.01)

    plan = beside(body)
    seen(reached)
    plan.root.suspend()
    top_level(lambda: sleep(0.03))
    assert plan.root.state is TaskState.SUSPENDED
    plan.root.wake_up()
    assert plan.ended() is False


def test_many_threads_suspend_and_wake_a_plan(beside):
    go, rounds = Fluent("go", False), 100
    plan = beside(lambda: par(*[do(wait_for, go)] * 4, do(forever)))

    def shake():
        for _ in range(rounds):
            plan.root.suspend()
            plan.root.wake_up()

    threads = [threading.Thread(target=shake) for _ in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert plan.root.state is TaskState.RUNNING
    go.value = True
    plan.root.find("forever").evaporate("over")
    with pytest.raises(TaskEvaporatedFailure):
        plan.ended()
