"""How the soak's clients see goals end that they are about to cancel."""

from __future__ import annotations

import actionlib
import pytest
from actionlib_msgs.msg import GoalStatus
from fake_goals import FakeActionClient
from nao_soak.clients import Client


@pytest.fixture
def sensible_end(monkeypatch):
    """Sends a goal for which the client does not wait at all; what it says of its end, and the goal."""

    def run(on_sent):
        fake = FakeActionClient(on_sent)
        monkeypatch.setattr(actionlib, "ActionClient", lambda *_: fake)
        return Client("NaoLights", 1, 0.0).sensible_end(0.0), fake.goals[0]

    return run


def test_a_goal_that_is_over_when_it_is_to_be_cancelled_has_not_hung(sensible_end):
    def on_sent(goal):
        goal.tell(GoalStatus.ACTIVE)
        goal.just_before_the_cancel(lambda: goal.end(GoalStatus.ABORTED, "no such light"))

    end, goal = sensible_end(on_sent)
    assert (end, goal.cancelled) == (("aborted", "no such light"), [])


def test_a_goal_that_goes_on_is_cancelled_and_has_hung(sensible_end):
    (end, _), goal = sensible_end(lambda goal: goal.tell(GoalStatus.ACTIVE))
    assert (end, len(goal.cancelled)) == ("hung", 1)
