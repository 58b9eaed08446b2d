"""Control constructs: what counts, what is ended, in which order."""

from __future__ import annotations

import threading

import pytest

from nao_library_modules.process_modules.control import (
    do,
    par,
    par_loop,
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
    ObjectUnreachable,
    PlanError,
    PlanFailure,
    SimplePlanFailure,
    TaskEvaporatedFailure,
    fail,
)
from nao_library_modules.process_modules.flow import wait_until
from nao_library_modules.process_modules.fluents import Fluent
from nao_library_modules.process_modules.tasks import TaskState
from nao_library_modules.process_modules.waiting import wait_for


class Branches:
    """Branches that wait for ever, and tell how they ended."""

    def __init__(self):
        self.cleaned = []
        self.waiting = Fluent("waiting", 0)

    def forever(self, name):
        def body():
            try:
                self.waiting.update(lambda count: count + 1)
                wait_until(lambda: False)
            finally:
                self.cleaned.append(name)

        return do(body, name=name)

    def once_waiting(self, count, then):
        """A branch that acts when so many wait."""

        def body():
            wait_for(self.waiting >= count)
            return then()

        return do(body, name="actor")


@pytest.fixture
def branches():
    return Branches()


def no_ball():
    fail(ObjectUnreachable, "no ball")


def test_seq_goes_in_order_and_answers_the_last():
    done = []
    assert top_level(lambda: seq(do(done.append, 1), do(done.append, 2), lambda: "last")) == "last"
    assert done == [1, 2]


def test_seq_ends_with_the_first_failure():
    done = []
    with pytest.raises(ObjectUnreachable, match="no ball"):
        top_level(lambda: seq(do(done.append, 1), no_ball, do(done.append, 2)))
    assert done == [1]


def test_par_answers_all_in_order_of_the_branches():
    last = Fluent("last", False)

    def first():
        wait_for(last)
        return 1

    def second():
        last.value = True
        return 2

    assert top_level(lambda: par(first, second)) == [1, 2]


def test_par_ends_its_other_branches_at_the_first_failure_and_waits_for_them(branches):
    plan = do(par, branches.forever("a"), branches.forever("b"), branches.once_waiting(2, no_ball))
    with pytest.raises(ObjectUnreachable, match="no ball"):
        top_level(plan)
    assert sorted(branches.cleaned) == ["a", "b"]


def test_a_bug_in_a_branch_is_raised_as_it_is(branches):
    def bug():
        return {}["missing"]

    with pytest.raises(KeyError, match="missing"):
        top_level(lambda: par(branches.forever("a"), branches.once_waiting(1, bug)))
    with pytest.raises(KeyError, match="missing"):
        top_level(lambda: try_all(branches.forever("b"), bug))
    with pytest.raises(KeyError, match="missing"):
        top_level(lambda: try_in_order(bug, branches.forever("c")))
    assert branches.cleaned == ["a", "b"]


@pytest.mark.parametrize("construct", [pursue, try_all])
def test_the_first_that_succeeds_decides_and_ends_the_others(construct, branches):
    plan = do(construct, branches.forever("a"), branches.once_waiting(1, lambda: "found"))
    assert top_level(plan) == "found"
    assert branches.cleaned == ["a"]


def test_pursue_fails_with_a_failure_that_comes_first(branches):
    with pytest.raises(ObjectUnreachable):
        top_level(lambda: pursue(branches.forever("a"), branches.once_waiting(1, no_ball)))
    assert branches.cleaned == ["a"]


def test_try_all_goes_on_after_a_failure(branches):
    failed = Fluent("failed", False)

    def loser():
        try:
            no_ball()
        finally:
            failed.value = True

    def winner():
        wait_for(failed)
        return "won"

    assert top_level(lambda: try_all(loser, winner)) == "won"


@pytest.mark.parametrize("construct", [try_all, try_in_order])
def test_all_failures_together_are_one(construct):
    with pytest.raises(CompositeFailure) as caught:
        top_level(lambda: construct(no_ball, do(fail, "too dark")))
    assert [type(failure) for failure in caught.value.failures] == [ObjectUnreachable, SimplePlanFailure]
    assert str(caught.value) == "all 2 failed: no ball; too dark"


def test_try_in_order_stops_at_the_first_success():
    tried = []

    def look(where):
        tried.append(where)
        if where != "table":
            fail(f"nothing on the {where}")
        return where

    assert top_level(lambda: try_each_in_order(look, ["shelf", "table", "floor"])) == "table"
    assert tried == ["shelf", "table"]


def test_par_loop_does_all_at_once():
    barrier = threading.Barrier(3)

    def meet(number):
        barrier.wait(10.0)
        return number * number

    assert top_level(lambda: par_loop(meet, [1, 2, 3])) == [1, 4, 9]


def test_partial_order_keeps_the_order_that_is_asked_for():
    done = []

    def step(name):
        return do(done.append, name)

    names = ["serve", "cook", "shop", "lay the table"]
    order = [("shop", "cook", "serve"), ("lay the table", "serve")]
    answers = top_level(lambda: partial_order({name: step(name) for name in names}, order))
    assert list(answers) == names
    assert done.index("shop") < done.index("cook") < done.index("serve") == 3


@pytest.mark.parametrize(
    "order, told",
    [
        ([("a", "b"), ("b", "a")], "a, b wait for each other"),
        ([("a", "c")], "no branch 'c': there are a, b"),
    ],
)
def test_an_order_that_cannot_be_is_an_error(order, told):
    with pytest.raises(PlanError, match=told):
        top_level(lambda: partial_order({"a": no_ball, "b": no_ball}, order))


def test_a_step_that_fails_ends_what_waits_for_it():
    with pytest.raises(ObjectUnreachable):
        top_level(lambda: partial_order({"a": no_ball, "b": no_ball}, [("a", "b")]))


def test_constructs_nest(branches):
    plan = do(
        pursue,
        lambda: par(branches.forever("a"), lambda: seq(branches.forever("b"), branches.forever("never"))),
        branches.once_waiting(2, lambda: try_in_order(no_ball, lambda: "deep")),
    )
    assert top_level(plan) == "deep"
    assert sorted(branches.cleaned) == ["a", "b"]


def test_a_branch_that_somebody_ends_is_a_failure_of_its_construct(beside, branches):
    plan = beside(lambda: par(branches.forever("a"), branches.forever("b")))
    top_level(lambda: wait_for(branches.waiting >= 2))
    plan.root.find("a").evaporate("no time for a")
    with pytest.raises(TaskEvaporatedFailure, match=r"the task .*/par/a was evaporated: no time for a"):
        plan.ended()
    assert sorted(branches.cleaned) == ["a", "b"]


def test_failures_are_not_handled_by_accident():
    caught = []

    def careless():
        try:
            wait_until(lambda: False)
        except Exception as error:
            caught.append(error)

    assert top_level(lambda: pursue(careless, lambda: "over")) == "over"
    assert caught == []


@pytest.mark.parametrize("construct", [seq, par])
def test_nothing_to_do_is_done(construct):
    assert not top_level(construct)


def test_what_is_no_branch_is_an_error():
    with pytest.raises(PlanError, match="'walk' is no branch: give a function"):
        top_level(lambda: seq("walk"))
    with pytest.raises(PlanError, match="pursue needs a branch"):
        top_level(pursue)


def test_plans_begin_with_top_level_once():
    with pytest.raises(PlanError, match="outside of a plan"):
        seq(no_ball)
    with pytest.raises(PlanError, match="top_level inside of a plan"):
        top_level(lambda: top_level(no_ball))


def test_the_tree_tells_what_came_of_everything(run_plan):
    answer, root = run_plan(lambda: par(do(int, "3", name="count"), lambda: subtask(do(len, "abc"))), name="plan")
    assert answer == [3, 3]
    assert [task.path for task in root] == [
        "plan",
        "plan/par",
        "plan/par/count",
        "plan/par/step",
        "plan/par/step/len",
    ]
    assert {task.state for task in root} == {TaskState.SUCCEEDED}
    assert root.find("count").facts == {"arguments": "'3'"}
    assert all(task.created <= task.began <= task.ended for task in root)


def test_a_hundred_branches_fail_with_the_one_that_failed_first():
    gate = Fluent("gate", -1)

    def branch(number):
        wait_until(lambda: gate.value >= number, [gate])
        gate.update(lambda value: max(value, number + 1))
        fail(f"branch {number}")

    def begin():
        gate.value = 0
        wait_until(lambda: False)

    with pytest.raises(PlanFailure, match="branch 0"):
        top_level(lambda: par(begin, *(do(branch, number) for number in range(100))))
