"""Tasks: ended, suspended and woken from outside."""

from __future__ import annotations

import pytest

from nao_library_modules.process_modules.control import do, par, seq, subtask, top_level
from nao_library_modules.process_modules.failures import PlanError, TaskEvaporatedFailure
from nao_library_modules.process_modules.flow import (
    checkpoint,
    retry_after_suspension,
    sleep,
    uninterrupted,
    wait_until,
)
from nao_library_modules.process_modules.fluents import Fluent
from nao_library_modules.process_modules.tasks import TaskState, current_task
from nao_library_modules.process_modules.waiting import wait_for


@pytest.fixture
def reached():
    """How often a plan came by; tests wait for it."""

    class Reached(Fluent):
        def next(self):
            self.update(lambda count: count + 1)

        def times(self, count):
            top_level(lambda: wait_for(self >= count))

    return Reached("reached", 0)


def test_a_plan_is_ended_while_it_waits_and_puts_things_right(beside, reached):
    done = []

    def body():
        try:
            reached.next()
            wait_until(lambda: False)
        finally:
            with uninterrupted():
                sleep(0.001)
                done.append("put right")

    plan = beside(lambda: par(body, body))
    reached.times(2)
    plan.root.evaporate("enough")
    with pytest.raises(TaskEvaporatedFailure, match="enough"):
        plan.ended()
    assert done == ["put right"] * 2
    assert {task.state for task in plan.root} == {TaskState.EVAPORATED}


def test_who_does_not_protect_it_cannot_wait_while_it_is_ended(beside, reached):
    waited = []

    def body():
        try:
            reached.next()
            wait_until(lambda: False)
        finally:
            waited.append(True)
            sleep(1000.0)

    plan = beside(body)
    reached.times(1)
    plan.root.evaporate()
    with pytest.raises(TaskEvaporatedFailure):
        plan.ended()
    assert waited == [True]


def test_a_step_that_somebody_ends_fails_and_its_sequence_may_go_on(beside, reached):
    def step():
        reached.next()
        wait_until(lambda: False)

    def body():
        try:
            subtask(do(step))
        except TaskEvaporatedFailure as failure:
            return failure.reason

    plan = beside(body)
    reached.times(1)
    plan.root.find("step").evaporate("skip it")
    assert plan.ended() == "skip it"
    assert plan.root.state is TaskState.SUCCEEDED


def test_a_suspended_plan_does_nothing_until_it_is_woken(beside, reached):
    go = Fluent("go", 0)

    def body():
        for step in (1, 2):
            wait_for(go >= step)
            reached.next()

    plan = beside(lambda: par(body))
    go.value = 1
    reached.times(1)
    plan.root.suspend("wait a moment")
    assert {task.state for task in plan.root} == {TaskState.SUSPENDED}
    go.value = 2
    assert top_level(lambda: wait_for(reached >= 2, timeout=0.02)) is False
    plan.root.wake_up()
    plan.ended()
    assert reached.value == 2


def test_as_often_as_it_is_suspended_it_has_to_be_woken(beside, reached):
    go = Fluent("go", False)
    plan = beside(do(wait_for, go))
    plan.root.suspend()
    plan.root.suspend()
    plan.root.wake_up()
    assert plan.root.state is TaskState.SUSPENDED
    plan.root.wake_up()
    with pytest.raises(PlanError, match="is not suspended"):
        plan.root.wake_up()
    go.value = True
    assert plan.ended() is True


def test_a_suspended_plan_can_be_ended(beside, reached):
    plan = beside(lambda: seq(reached.next, do(sleep, 1000.0)))
    reached.times(1)
    plan.root.suspend()
    plan.root.evaporate("over")
    with pytest.raises(TaskEvaporatedFailure, match="over"):
        plan.ended()


def test_what_cannot_pause_is_ended_and_begun_again(beside, reached):
    sent, cancelled, go = [], Fluent("cancelled", 0), Fluent("go", False)

    def goal():
        sent.append(len(sent))
        try:
            reached.next()
            wait_for(go)
            return "arrived"
        finally:
            if not go.value:
                cancelled.value += 1

    plan = beside(lambda: retry_after_suspension(goal))
    reached.times(1)
    plan.root.suspend()
    assert top_level(lambda: wait_for(cancelled, timeout=10.0)) == 1
    assert sent == [0]
    plan.root.wake_up()
    reached.times(2)
    go.value = True
    assert plan.ended() == "arrived"
    assert (sent, cancelled.value) == ([0, 1], 1)


def test_a_plan_that_computes_can_be_ended_at_its_checkpoints(beside, reached):
    def compute():
        while True:
            reached.next()
            checkpoint()

    plan = beside(compute)
    reached.times(3)
    plan.root.evaporate()
    with pytest.raises(TaskEvaporatedFailure):
        plan.ended()


def test_a_task_may_end_itself():
    def body():
        current_task().evaporate("had enough")
        sleep(1000.0)

    with pytest.raises(TaskEvaporatedFailure, match="had enough"):
        top_level(body)


def test_tasks_are_found_by_name_and_a_wrong_name_tells_which_there_are(run_plan):
    _, root = run_plan(lambda: seq(do(int, 1, name="one"), do(int, 2, name="two")), name="plan")
    assert root.find("two").result == 2
    with pytest.raises(PlanError, match="no task 'three' in plan: there are plan, seq, one, two"):
        root.find("three")


def test_a_result_is_asked_for_when_it_is_there(beside, reached):
    plan = beside(lambda: seq(reached.next, do(sleep, 1000.0)))
    reached.times(1)
    with pytest.raises(PlanError, match="is running: it has no result yet"):
        plan.root.value()
    assert plan.root.join(timeout=0.001) is False
    plan.root.evaporate()
    assert plan.root.join(timeout=10.0)
    with pytest.raises(TaskEvaporatedFailure):
        plan.ended()
