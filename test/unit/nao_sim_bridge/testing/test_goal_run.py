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


def feedback(function, of="goal"):
    message = NaoLedActionFeedback(status=GoalStatus(goal_id=GoalID(id=of)))
    message.feedback.function = function
    return message


def tell_feedback(run, message):
    run.goal.handle.comm_state_machine.update_feedback(message)


def test_feedback_that_comes_after_the_result_is_kept_and_that_of_others_is_not(run):
    tell_feedback(run, feedback("on"))
    run.goal.end(GoalStatus.SUCCEEDED)
    tell_feedback(run, feedback("off"))
    tell_feedback(run, feedback("blink", of="another goal"))
    assert [(time, told.function) for time, told in run.wait(LIMIT).feedback] == [(100.0, "on"), (100.0, "off")]


def test_a_cancel_waits_until_the_server_has_the_goal(run):
    thread = threading.Thread(target=run.cancel, daemon=True)
    thread.start()
    thread.join(0.05)
    assert thread.is_alive() and run.goal.cancelled == []
    run.goal.tell(GoalStatus.ACTIVE)
    assert run.wait(LIMIT).state == GoalStatus.PREEMPTED
    assert run.goal.cancelled == [CommState.ACTIVE]


def test_a_goal_that_is_over_is_not_cancelled(run):
    run.goal.end(GoalStatus.ABORTED, "no such light")
    run.cancel()
    assert (run.goal.cancelled, run.wait(LIMIT).text) == ([], "no such light")


def test_how_it_ended_is_not_known_before_the_end(run):
    with pytest.raises(StackNotReady, match="call wait"):
        _ = run.state
    with pytest.raises(StackNotReady, match="result of the goal"):
        run.wait(0.01)
