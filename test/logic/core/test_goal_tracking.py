"""Goals whose servers are quick or late, with actionlib's own client but its topics."""

from __future__ import annotations

import threading

import pytest
from actionlib import simple_action_client as of_actionlib
from actionlib_msgs.msg import GoalStatus
from fake_goals import FakeGoal

from nao_library_modules.simple_action_client import SimpleActionClient

SENDING = 0.05
"""s that a busy computer takes from the server's answer to the end of `send_goal`."""
LIMIT = 15.0


class Hasty:
    """Stands for actionlib's ActionClient: the news of the server come while a goal is still being sent."""

    def __init__(self, name, action):
        self.ns = name
        self.threads, self.callbacks = [], []

    def send_goal(self, number, on_transition, on_feedback):
        goal = FakeGoal(on_transition, name=f"goal {number}")
        self.callbacks.append((on_transition, on_feedback))

        def answer():
            goal.tell(GoalStatus.ACTIVE)
            on_feedback(goal.handle, f"feedback {number}")
            goal.end(GoalStatus.SUCCEEDED, f"goal {number}")

        self.threads.append(threading.Thread(target=answer, daemon=True))
        self.threads[-1].start()
        self.threads[-1].join(SENDING)
        return goal.handle

    def join(self):
        for thread in self.threads:
            thread.join(LIMIT)
            assert not thread.is_alive()


@pytest.fixture
def client(monkeypatch):
    monkeypatch.setattr(of_actionlib, "ActionClient", Hasty)
    monkeypatch.setattr(of_actionlib.rospy, "resolve_name", lambda name: name)
    return SimpleActionClient("NaoLights", None)


def test_nothing_of_a_goal_that_is_over_at_once_is_lost(client):
    ends, news = [], []
    client.send_goal(
        1, lambda state, _: ends.append(state), lambda: news.append("active"), lambda text: news.append(text)
    )
    client.action_client.join()
    assert client.simple_state == of_actionlib.SimpleGoalState.DONE
    assert client.get_state() == GoalStatus.SUCCEEDED and client.get_goal_status_text() == "goal 1"
    assert (ends, news) == ([GoalStatus.SUCCEEDED], ["active", "feedback 1"])


def test_news_of_the_goal_before_are_neither_taken_for_those_of_this_one_nor_told(client, caplog):
    news = []
    client.send_goal(1)
    client.action_client.join()
    former = client.gh
    client.send_goal(2, feedback_cb=news.append)
    client.action_client.join()
    on_transition, on_feedback = client.action_client.callbacks[0]
    on_feedback(former, "feedback 1, late")
    on_transition(former)
    assert news == ["feedback 2"] and client.get_goal_status_text() == "goal 2"
    assert not caplog.records
