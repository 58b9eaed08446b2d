"""Process modules where they meet plans: cancelled in each state, failing, suspended."""

from __future__ import annotations

import pytest
from cram_modules import One, state_of, to, wait_here
from cram_waits import SHORT

from nao_library_modules.process_modules.control import do, par, top_level, try_in_order
from nao_library_modules.process_modules.designators.designator import Designator, action
from nao_library_modules.process_modules.designators.rules import Command
from nao_library_modules.process_modules.failures import (
    NavigationGoalNotReached,
    PlanFailure,
    TaskEvaporatedFailure,
    fail,
)
from nao_library_modules.process_modules.flow import sleep, wait_until
from nao_library_modules.process_modules.handling import give, retry, with_failure_handling
from nao_library_modules.process_modules.policies import timeout_policy, with_policy
from nao_library_modules.process_modules.process_module import ModuleState, pm_cancel, pm_status
from nao_library_modules.process_modules.registry import perform, with_process_modules_running
from nao_library_modules.process_modules.tasks import TaskState

# --- cancelled in each state ------------------------------------------------------------------------------------------


def test_cancelling_a_module_that_does_nothing_does_nothing(one):
    pm_cancel(one)
    assert pm_status(one) is ModuleState.WAITING
    assert top_level(lambda: perform(to("quick", "a"))) == "a"


def test_cancelling_an_offline_module_does_nothing(log):
    module = One(log)
    pm_cancel(module)
    assert pm_status(module) is ModuleState.OFFLINE


def test_cancelling_a_module_that_works_ends_that_and_what_waits(one, log, beside):
    plans = [beside(do(perform, to("wait", "a")))]
    log.wait("begun", "a")
    plans += [beside(do(perform, to("wait", word))) for word in "bc"]
    assert top_level(lambda: wait_until(lambda: len(one._waiting) == 2, (), 0.0)) or wait_here(one, 2)
    pm_cancel(one)
    for plan in plans:
        with pytest.raises(TaskEvaporatedFailure):
            plan.ended()
    assert log.events.value == (("begun", "a"), ("over", "a"))
    assert pm_status(one) is ModuleState.WAITING


def test_a_plan_that_is_ended_while_it_waits_for_its_turn_takes_its_place_back(one, log, beside):
    first = beside(do(perform, to("wait", "a")))
    log.wait("begun", "a")
    second = beside(do(perform, to("wait", "b")))
    wait_here(one, 1)
    second.root.evaporate("changed my mind")
    with pytest.raises(TaskEvaporatedFailure):
        second.ended()
    log.let("a", "b")
    assert first.ended() == "a"
    assert ("begun", "b") not in log.events.value


def test_a_failed_module_can_be_cancelled_and_goes_on(one, log):
    log.let("far")
    with pytest.raises(NavigationGoalNotReached):
        top_level(lambda: perform(to("stumble", "far")))
    assert pm_status(one) is ModuleState.FAILED
    pm_cancel(one)
    assert top_level(lambda: perform(to("quick", "b"))) == "b"
    state_of(one, ModuleState.WAITING)


def test_a_command_that_fails_while_it_is_ended_does_not_hide_why_the_plan_failed(one, log):
    def second():
        top = lambda: ("begun", "a") in log.events.value  # noqa: E731
        wait_until(top, [log.events])
        fail(NavigationGoalNotReached, "first")

    with pytest.raises(NavigationGoalNotReached, match="first"):
        top_level(lambda: par(do(perform, to("stumble at the end", "a")), second))
    assert log.count("over") == 1


def test_a_plan_waits_for_commands_that_put_things_right(one, log, beside):
    plan = beside(do(perform, to("protected", "a")))
    log.wait("begun", "a")
    plan.root.evaporate("over")
    assert plan.root.join(SHORT) is False
    log.let("a")
    with pytest.raises(TaskEvaporatedFailure):
        plan.ended()
    assert log.events.value[-1] == ("over", "a")


# --- failures ---------------------------------------------------------------------------------------------------------


def test_a_failure_of_a_module_ends_what_runs_beside_it_in_another_module(one, many, log):
    log.let("far")

    def stumble():
        wait_until(lambda: ("begun", "walk") in log.events.value, [log.events])
        perform(to("stumble", "far", "many"))

    with pytest.raises(NavigationGoalNotReached) as caught:
        top_level(lambda: par(do(perform, to("wait", "walk")), stumble))
    assert caught.value.word == "far"
    assert ("over", "walk") in log.events.value
    assert one.state is ModuleState.WAITING and many.state is ModuleState.FAILED


def test_a_failed_command_is_tried_again(one, log):
    log.let("far")
    tries = []

    def again(failure):
        tries.append(failure.word)
        if len(tries) < 3:
            retry()
        give("gave up")

    body = do(perform, to("stumble", "far"))
    assert top_level(lambda: with_failure_handling(body, {NavigationGoalNotReached: again})) == "gave up"
    assert tries == ["far"] * 3 and log.count("begun") == 3


def test_the_next_solution_is_tried_when_one_fails(one, log):
    log.let("far")
    desig = Designator(
        action,
        {"type": "either"},
        resolve=lambda _: [Command("one", "stumble", {"word": "far"}), Command("one", "quick", {"word": "near"})],
    )
    assert top_level(lambda: try_in_order(do(perform, desig), lambda: perform(desig.next_solution()))) == "near"


def test_a_policy_ends_a_command(one, log):
    with pytest.raises(PlanFailure, match="at most 0.02 s"):
        top_level(lambda: with_policy(timeout_policy(0.02), do(perform, to("wait", "a"))))
    assert log.events.value == (("begun", "a"), ("over", "a"))


# --- suspension -------------------------------------------------------------------------------------------------------


def test_a_suspended_plan_that_waits_for_its_turn_asks_again(one, log, beside):
    first = beside(do(perform, to("wait", "a")))
    log.wait("begun", "a")
    second = beside(do(perform, to("wait", "b")))
    wait_here(one, 1)
    second.root.suspend()
    top_level(lambda: while_waiting(one, 0))
    log.let("a", "b")
    assert first.ended() == "a"
    assert ("begun", "b") not in log.events.value
    second.root.wake_up()
    assert second.ended() == "b"


def while_waiting(module, count):
    while len(module._waiting) != count:
        sleep(0.001)


def test_what_was_done_when_the_suspension_came_is_not_done_again(log, beside):
    module, suspended = One(log), []

    def suspend_at_the_end(task):
        if task.parent is None and task.state is TaskState.SUCCEEDED and not suspended:
            suspended.append(True)
            plan.root.suspend("just now")

    module.observers.append(suspend_at_the_end)
    with with_process_modules_running(module):
        plan = beside(do(perform, to("wait", "a")))
        log.wait("begun", "a")
        log.let("a")
        state_of(module, ModuleState.WAITING)
        assert plan.root.join(SHORT) is False and plan.root.state is TaskState.SUSPENDED
        plan.root.wake_up()
        assert plan.ended() == "a"
    assert log.count("begun") == 1


def test_par_of_two_modules_is_suspended_and_both_begin_again(one, many, log, beside):
    plan = beside(lambda: par(do(perform, to("wait", "a")), do(perform, to("wait", "b", "many"))))
    log.wait("begun", "a")
    log.wait("begun", "b")
    plan.root.suspend()
    log.wait("over", "a")
    log.wait("over", "b")
    log.let("a", "b")
    plan.root.wake_up()
    assert plan.ended() == ["a", "b"]
    assert log.count("begun") == 4


def test_a_suspended_command_is_ended(one, log, beside):
    plan = beside(do(perform, to("wait", "a")))
    log.wait("begun", "a")
    plan.root.suspend()
    log.wait("over", "a")
    plan.root.evaporate("over")
    with pytest.raises(TaskEvaporatedFailure, match="over"):
        plan.ended()
    assert log.count("begun") == 1


def test_a_command_in_a_failure_handler_is_suspended(one, log, beside):
    handlers = {PlanFailure: lambda failure: give(perform(to("wait", "a")))}
    plan = beside(lambda: with_failure_handling(do(fail, "no"), handlers))
    log.wait("begun", "a")
    plan.root.suspend()
    log.wait("over", "a")
    log.let("a")
    plan.root.wake_up()
    assert plan.ended() == "a"
