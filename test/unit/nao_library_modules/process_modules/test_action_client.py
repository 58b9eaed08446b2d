"""Goals of plans that are cancelled while they begin or end."""

from __future__ import annotations

import threading

import actionlib
import pytest
from actionlib import CommState
from actionlib_msgs.msg import GoalStatus
from fake_goals import FakeActionClient

from nao_library_modules.process_modules.action_client import PlanActionClient
from nao_library_modules.process_modules.failures import ActionlibActionTimedOut

LATE = 0.2
"""s until a slow server tells of a goal."""


@pytest.fixture
def call(monkeypatch, run_plan):
    """Sends a goal that may take no time at all, to a server that does as the test says; its end and the goal."""

    def run(on_sent):
        client = FakeActionClient(on_sent)
        monkeypatch.setattr(actionlib, "ActionClient", lambda *_: client)
        ends = []
        plan = PlanActionClient("NaoLights", None)
        try:
            end, _ = run_plan(lambda: plan.call(None, timeout=0.01, on_end=ends.append))
        except ActionlibActionTimedOut:
            end = None
        return end, ends[0], client.goals[0]

    return run


def test_a_goal_that_ends_while_it_is_to_be_cancelled_has_its_end(call):
    def on_sent(goal):
        goal.tell(GoalStatus.ACTIVE)
        goal.just_before_the_cancel(lambda: goal.end(GoalStatus.SUCCEEDED))

    end, told, goal = call(on_sent)
    assert (goal.cancelled, end, told.succeeded) == ([], told, True)


def test_a_goal_of_which_the_server_has_not_told_yet_is_not_lost(call):
    def on_sent(goal):
        threading.Timer(LATE, goal.tell, [GoalStatus.ACTIVE]).start()

    end, told, goal = call(on_sent)
    assert end is None  # it took too long
    assert (goal.cancelled, told.status) == ([CommState.ACTIVE], GoalStatus.PREEMPTED)
