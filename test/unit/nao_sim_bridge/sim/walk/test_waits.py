"""Tasks of callers that wait for a walk."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim.tasks import TaskIds
from nao_sim_bridge.sim.walk.waits import WalkWaits


@pytest.fixture
def dropped():
    return []


@pytest.fixture
def waits(dropped):
    return WalkWaits(TaskIds(), lambda: dropped.append(True))


@pytest.mark.parametrize("reached", [True, False])
def test_who_waits_for_the_goal_is_told_once_whether_it_is_reached(waits, reached):
    goal = waits.goal = waits.make_goal("moveTo")
    waits.end_goal(reached)
    waits.end_all(not reached)
    assert goal.finished and goal.value is reached and waits.goal is None


def test_without_a_walk_nobody_waits_for_its_end(waits):
    assert waits.for_the_end("waitUntilMoveIsFinished", walks=False).finished


def test_all_who_wait_are_told_of_the_end(waits):
    goal = waits.goal = waits.make_goal("moveTo")
    others = [waits.for_the_end("waitUntilMoveIsFinished", walks=True) for _ in range(2)]
    assert not any(task.finished for task in (goal, *others))
    waits.end_all(True)
    assert all(task.finished for task in (goal, *others))


def test_a_goal_that_is_cancelled_is_dropped_one_that_never_began_is_not(waits, dropped):
    waits.goal = waits.make_goal("moveTo")
    waits.make_goal("moveTo").kill()
    assert dropped == [] and waits.goal is not None
    waits.goal.kill()
    assert dropped == [True] and waits.goal is None
