"""Servers that answer before `send_goal` has returned."""

from __future__ import annotations

import threading

import pytest
from actionlib import simple_action_client as of_actionlib
from actionlib_msgs.msg import GoalStatus
from fake_goals import FakeGoal

from nao_library_modules.simple_action_client import SimpleActionClient

SENDING = 0.05
"""s that a busy computer takes from the server's answer to the end of `send_goal`."""
LIMIT = 10.0


class Hasty:
    """Stands for actionlib's ActionClient: the news of the server come while a goal is still being sent."""

    def __init__(self, name, action):
        self.ns = name
        self.threads = []

    def send_goal(self, number, on_transition, on_feedback):
        goal = FakeGoal(on_transition, name=f"goal {number}")

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


def test_the_end_of_a_goal_that_is_over_at_once_is_not_lost(client):
    ends = []
    client.send_goal(1, done_cb=lambda state, _: ends.append(state))
    client.action_client.join()
    assert client.simple_state == of_actionlib.SimpleGoalState.DONE
    assert client.get_state() == GoalStatus.SUCCEEDED and client.get_goal_status_text() == "goal 1"
    assert ends == [GoalStatus.SUCCEEDED]


def test_what_comes_before_is_not_lost_either(client):
    news = []
    client.send_goal(1, active_cb=lambda: news.append("active"), feedback_cb=news.append)
    client.action_client.join()
    assert news == ["active", "feedback 1"]


def test_news_of_the_goal_before_are_neither_taken_for_those_of_this_one_nor_told(client, caplog):
    news = []
    client.send_goal(1)
    client.action_client.join()
    former = client.gh
    client.send_goal(2, feedback_cb=news.append)
    client.action_client.join()
    client._handle_feedback(former, "feedback 1, late")
    client._handle_transition(former)
    assert news == ["feedback 2"]
    assert client.get_goal_status_text() == "goal 2"
    assert not caplog.records


def test_a_callback_may_wait_for_the_one_who_sends(client):
    sent, seen = threading.Event(), threading.Event()

    def done(*_):
        if sent.wait(LIMIT):
            seen.set()

    client.send_goal(1, done_cb=done)
    sent.set()
    assert seen.wait(LIMIT)
    client.action_client.join()
