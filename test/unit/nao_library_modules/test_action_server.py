"""The loop that carries out goals, without a master: actionlib's server around it is not built."""

from __future__ import annotations

import threading

import pytest

from nao_library_modules import action_server
from nao_library_modules.action_server import PromptActionServer


class Server(PromptActionServer):
    """The loop with goals that lie ready from the start; ends when it would wait."""

    def __init__(self, goals, execute):
        self.lock = threading.RLock()
        self.execute_condition = threading.Condition(self.lock)
        self.terminate_mutex = threading.RLock()
        self.need_to_terminate = False
        self.execute_callback = execute
        self.goals = list(goals)
        self.aborted = []
        self.active = False
        self.execute_condition.wait = self.wait

    def __del__(self):
        """There is no thread to be joined."""

    def wait(self, timeout):
        self.need_to_terminate = True

    def is_new_goal_available(self):
        return bool(self.goals)

    def accept_new_goal(self):
        self.active = True
        return self.goals.pop(0)

    def is_active(self):
        return self.active

    def set_aborted(self, result, text):
        self.active = False
        self.aborted.append(text)

    def set_succeeded(self):
        self.active = False


@pytest.fixture(autouse=True)
def _node_runs(monkeypatch):
    monkeypatch.setattr(action_server.rospy, "is_shutdown", lambda: False)


def test_a_goal_that_came_while_another_ran_is_taken_up_without_a_wait():
    done = []

    def execute(goal):
        done.append(goal)
        assert not server.need_to_terminate, "it waited between the goals"
        if goal == "first":
            server.goals.append("second")
        server.set_succeeded()

    server = Server(["first"], execute)
    server.executeLoop()
    assert done == ["first", "second"]
    assert server.aborted == []


def test_an_error_aborts_its_goal_and_the_next_one_runs():
    def execute(goal):
        if goal == "bad":
            raise ValueError("no such thing")
        server.set_succeeded()

    server = Server(["bad", "good"], execute)
    server.executeLoop()
    assert server.goals == []
    assert len(server.aborted) == 1 and "no such thing" in server.aborted[0]


def test_a_goal_left_without_an_end_state_is_aborted():
    server = Server(["forgotten"], lambda goal: None)
    server.executeLoop()
    assert server.aborted == ["no end state was set"]


def test_the_loop_ends_with_the_node(monkeypatch):
    monkeypatch.setattr(action_server.rospy, "is_shutdown", lambda: True)
    server = Server(["never"], None)
    server.executeLoop()
    assert server.goals == ["never"]
