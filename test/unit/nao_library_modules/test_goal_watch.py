"""Goals that are cancelled while they begin or end, with actionlib's own client but its topics."""

from __future__ import annotations

import threading

import pytest
from actionlib import CommState
from actionlib_msgs.msg import GoalStatus
from fake_goals import FakeGoal

from nao_library_modules.goal_watch import GoalWatch


class Acknowledged(threading.Event):
    """The server tells of the goal as soon as somebody waits for that."""

    goal = None

    def wait(self, timeout=None):
        self.goal.tell(GoalStatus.ACTIVE)
        return super().wait(timeout)


@pytest.fixture
def watch():
    return GoalWatch()


@pytest.fixture
def goal(watch):
    return FakeGoal(watch.look)


def test_a_goal_that_goes_on_is_cancelled(watch, goal):
    goal.tell(GoalStatus.ACTIVE)
    assert watch.cancel(goal.handle)
    assert goal.cancelled == [CommState.ACTIVE]
    assert watch.over.wait(10.0)
    assert goal.handle.get_terminal_state() == GoalStatus.PREEMPTED


def test_a_goal_that_is_over_is_neither_cancelled_nor_lost(watch, goal):
    goal.end(GoalStatus.ABORTED, "no such light")
    assert not watch.cancel(goal.handle)
    goal.tell()  # told before the goal came to the server
    assert goal.cancelled == []
    assert goal.handle.get_terminal_state() == GoalStatus.ABORTED


def test_a_goal_that_ends_while_it_is_to_be_cancelled_is_not_cancelled(watch, goal):
    goal.tell(GoalStatus.ACTIVE)
    goal.just_before_the_cancel(lambda: goal.end(GoalStatus.SUCCEEDED))
    assert not watch.cancel(goal.handle)
    assert (goal.cancelled, goal.handle.get_terminal_state()) == ([], GoalStatus.SUCCEEDED)


def test_a_goal_of_which_the_server_has_not_told_yet_is_cancelled_when_it_has(watch, goal):
    watch.acknowledged = Acknowledged()
    watch.acknowledged.goal = goal
    assert watch.cancel(goal.handle)
    assert goal.cancelled == [CommState.ACTIVE]
    assert watch.over.wait(10.0)
    assert goal.handle.get_terminal_state() == GoalStatus.PREEMPTED


def test_a_goal_of_which_the_server_never_tells_is_cancelled_all_the_same(watch, goal):
    assert watch.cancel(goal.handle, limit=0.01)
    assert goal.cancelled == [CommState.WAITING_FOR_GOAL_ACK]


def test_the_end_is_passed_on_once(goal):
    ends = []
    watch = GoalWatch(lambda: ends.append("over"))
    goal = FakeGoal(watch.look)
    goal.tell(GoalStatus.ACTIVE)
    assert watch.acknowledged.is_set() and not ends
    goal.end(GoalStatus.SUCCEEDED)
    assert ends == ["over"]
