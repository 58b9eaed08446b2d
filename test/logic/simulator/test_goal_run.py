"""What a test learns of its goals, in whatever order the server's messages come."""

from __future__ import annotations

import threading
from types import SimpleNamespace

import pytest
from actionlib import CommState
from actionlib_msgs.msg import GoalID, GoalStatus
from fake_goals import FakeActionClient

from nao_library_actions.msg import NaoLedActionFeedback, NaoLedGoal
from nao_sim_bridge.testing import StackNotReady, send

LIMIT = 10.0


@pytest.fixture
def run(monkeypatch):
    monkeypatch.setattr("rospy.get_time", lambda: 100.0)
    actions = FakeActionClient(lambda goal: None)
    run = send(SimpleNamespace(action_client=actions), NaoLedGoal())
    (run.goal,) = actions.goals
    return run


def tell_feedback(run, function, of="goal"):
    message = NaoLedActionFeedback(status=GoalStatus(goal_id=GoalID(id=of)))
    message.feedback.function = function
    run.goal.handle.comm_state_machine.update_feedback(message)


def test_feedback_that_comes_after_the_result_is_kept_and_that_of_others_is_not(run):
    with pytest.raises(StackNotReady, match="call wait"):
        _ = run.state
    with pytest.raises(StackNotReady, match="result of the goal"):
        run.wait(0.01)
    tell_feedback(run, "on")
    run.goal.end(GoalStatus.SUCCEEDED)
    tell_feedback(run, "off")
    tell_feedback(run, "blink", of="another goal")
    run.cancel()  # it is over: nothing to cancel
    assert run.goal.cancelled == []
    assert [(time, told.function) for time, told in run.wait(LIMIT).feedback] == [(100.0, "on"), (100.0, "off")]


def test_a_cancel_waits_until_the_server_has_the_goal(run):
    thread = threading.Thread(target=run.cancel, daemon=True)
    thread.start()
    thread.join(0.05)
    assert thread.is_alive() and run.goal.cancelled == []
    run.goal.tell(GoalStatus.ACTIVE)
    assert run.wait(LIMIT).state == GoalStatus.PREEMPTED and run.goal.cancelled == [CommState.ACTIVE]
