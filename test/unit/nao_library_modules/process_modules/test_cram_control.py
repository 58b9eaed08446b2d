"""CRAM's control constructs where they meet: ends that meet failures, suspension at every kind of wait, policies."""

from __future__ import annotations

import threading

import pytest

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
    NavigationHighLevelFailure,
    PlanError,
    PlanFailure,
    PlanTimedOut,
    PolicyCheckConditionMet,
    TaskEvaporatedFailure,
    fail,
)
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
    reset_counter,
    retry,
    with_failure_handling,
    with_retry_counters,
)
from nao_library_modules.process_modules.policies import Policy, timeout_policy, with_policy
from nao_library_modules.process_modules.tasks import TaskState, current_task
from nao_library_modules.process_modules.trace import Trace, trace_of
from nao_library_modules.process_modules.waiting import wait_for, whenever

SHORT = 0.02
"""s in which something would happen that must not."""


def forever():
    wait_until(lambda: False)


def seen(fluent, limit=10.0):
    """The value of a fluent once it is something; from a test."""
    answer = top_level(lambda: wait_for(fluent, timeout=limit))
    assert answer, f"{fluent} did not come"
    return answer


def states(root):
    return {task.name: task.state for task in root}


# --- ends and failures ------------------------------------------------------------------------------------------------


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


# --- suspension -------------------------------------------------------------------------------------------------------


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


# --- failures that are handled ----------------------------------------------------------------------------------------


def test_a_handler_may_fail_with_something_else_and_outer_handlers_see_that():
    inner = do(
        with_failure_handling,
        do(fail, NavigationGoalNotReached, "stuck"),
        {NavigationGoalNotReached: lambda failure: fail(NavigationHighLevelFailure, f"for good: {failure}")},
    )
    outer = {
        NavigationGoalNotReached: lambda failure: give("low"),
        NavigationHighLevelFailure: lambda failure: give(str(failure)),
    }
    assert top_level(lambda: with_failure_handling(inner, outer)) == "for good: stuck"


def test_an_inner_retry_does_not_use_up_the_outer_counter():
    tried, counts = [], []

    def inner():
        with with_retry_counters(tries=2):

            def again(failure):
                do_retry("tries")

            return with_failure_handling(attempt, {PlanFailure: again})

    def attempt():
        tried.append(True)
        fail(f"try {len(tried)}")

    def outer_again(failure):
        counts.append(get_counter("tries"))
        do_retry("tries")

    def plan():
        with with_retry_counters(tries=1):
            with_failure_handling(inner, {PlanFailure: outer_again})

    with pytest.raises(PlanFailure, match="try 6"):
        top_level(plan)
    assert counts == [1, 0] and len(tried) == 6


def test_counters_hold_in_the_branches_of_their_block_each_for_itself():
    def branch(number):
        tried = []

        def body():
            tried.append(True)
            fail("again")

        def plan():
            with with_retry_counters(**{f"tries_{number}": number}):
                with_failure_handling(body, {PlanFailure: lambda failure: (do_retry(f"tries_{number}"), give())})

        plan()
        return len(tried)

    assert top_level(lambda: par(*(do(branch, number) for number in range(4)))) == [1, 2, 3, 4]


def test_a_counter_from_outside_counts_in_a_branch():
    def body():
        with with_retry_counters(all=3):

            def branch():
                return with_failure_handling(do(fail, "no"), {PlanFailure: lambda f: (do_retry("all"), give())})

            seq(branch, branch)
            left = get_counter("all")
            reset_counter("all")
            return left, get_counter("all")

    assert top_level(body) == (0, 3)


def test_failures_of_branches_are_handled_around_their_par():
    ended, waiting = [], Fluent("waiting", False)

    def walk():
        try:
            waiting.value = True
            forever()
        finally:
            ended.append("walk")

    def grasp():
        wait_for(waiting)
        waiting.value = False
        fail(ManipulationPoseUnreachable, "too far")

    tries = []

    def again(failure):
        tries.append(type(failure))
        if len(tries) < 3:
            retry()
        give("enough")

    handlers = {ManipulationPoseUnreachable: again}
    assert top_level(lambda: with_failure_handling(do(par, walk, grasp), handlers)) == "enough"
    assert ended == ["walk"] * 3 and len(tries) == 3


def test_thousands_of_retries_need_no_deeper_stack():
    tries = [0]

    def body():
        tries[0] += 1
        if tries[0] < 3000:
            raise NavigationGoalNotReached("again")
        return "there"

    assert top_level(lambda: with_failure_handling(body, {PlanFailure: lambda failure: retry()})) == "there"


def test_the_end_of_a_task_is_no_failure_that_its_handlers_see(beside):
    handled, waiting = [], Fluent("waiting", False)

    def body():
        waiting.value = True
        forever()

    plan = beside(lambda: with_failure_handling(body, {PlanFailure: lambda failure: handled.append(failure) or give()}))
    seen(waiting)
    plan.root.evaporate("over")
    with pytest.raises(TaskEvaporatedFailure):
        plan.ended()
    assert handled == []


def test_retry_and_give_outside_of_handlers_are_mistakes_or_answers_of_nobody():
    for wrong in (retry, give):
        with pytest.raises(PlanError):
            top_level(lambda wrong=wrong: seq(wrong))


# --- policies ---------------------------------------------------------------------------------------------------------


def test_policies_nest_and_the_one_that_is_met_counts():
    fallen = Fluent("fallen", False)

    def body():
        fallen.value = True
        forever()

    upright = Policy("upright", fallen)
    with pytest.raises(PolicyCheckConditionMet, match="upright"):
        top_level(lambda: with_policy(timeout_policy(1000.0), lambda: with_policy(upright, body)))
    fallen.value = False
    with pytest.raises(PolicyCheckConditionMet, match="upright"):
        top_level(lambda: with_policy(upright, lambda: with_policy(timeout_policy(1000.0), body)))


def test_a_policy_is_a_failure_that_can_be_handled_and_the_body_tried_again():
    tries = []

    def body():
        tries.append(True)
        if len(tries) < 3:
            sleep(1000.0)
        return "in time"

    def plan():
        return with_failure_handling(
            lambda: with_policy(timeout_policy(0.01), body), {PlanTimedOut: lambda failure: retry()}
        )

    assert top_level(plan) == "in time" and len(tries) == 3


def test_cleaning_up_waits_and_happens_when_the_plan_is_ended(beside):
    waiting, cleaned = Fluent("waiting", False), []

    def body():
        waiting.value = True
        forever()

    policy = Policy("clean", Fluent("never", False), clean_up=lambda: cleaned.append(True))
    plan = beside(lambda: with_policy(policy, body))
    seen(waiting)
    plan.root.evaporate("over")
    with pytest.raises(TaskEvaporatedFailure):
        plan.ended()
    assert cleaned == [True]


def test_a_check_that_is_broken_breaks_the_plan():
    with pytest.raises(ZeroDivisionError):
        top_level(lambda: with_policy(Policy("broken", lambda: 1 / 0, period=0.001), forever))


# --- what is left ----------------------------------------------------------------------------------------------------


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
