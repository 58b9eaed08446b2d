"""Ctrl-C and the time limit while a goal is on its way, and while it ends."""

from __future__ import annotations

import os
import signal
import threading

import actionlib
import pytest
from actionlib import CommState
from actionlib_msgs.msg import GoalStatus
from fake_goals import FakeGoal

from nao_library_modules.command_line import goals
from nao_library_modules.command_line.errors import CommandFailed, Interrupted
from nao_library_modules.command_line.goals import GoalRun, interrupt_held
from nao_library_modules.command_line.progress import Progress
from nao_library_modules.command_line.settings import Settings
from nao_library_msgs.msg import LedFunction

LATE = 0.2
"""s until a slow server tells of a goal."""


def press():
    """Ctrl-C, as a terminal sends it."""
    os.kill(os.getpid(), signal.SIGINT)


def run_goal(**settings):
    run = GoalRun(Settings(json=True, **settings), "NaoLights")
    return run, lambda: run.run([LedFunction(function="rasta")])


@pytest.fixture
def client(monkeypatch):
    """A client whose user presses Ctrl-C in the middle of sending, if a test does not say otherwise."""

    class Client:
        goals = []
        in_cancel = staticmethod(lambda: None)

        def __init__(self, *_):
            pass

        def wait_for_server(self):
            return True

        @staticmethod
        def on_sent(goal):
            press()
            goal.tell(GoalStatus.ACTIVE)

        def send_goal(self, goal, on_change, _):
            self.goals.append(FakeGoal(on_change, self.in_cancel))  # published: the server has it
            self.on_sent(self.goals[-1])
            return self.goals[-1].handle

        @classmethod
        def cancels(cls):
            (goal,) = cls.goals
            return goal.cancelled

    monkeypatch.setattr(actionlib, "ActionClient", Client)
    monkeypatch.setattr(goals, "start_node", lambda: None)
    return Client


def test_ctrl_c_while_a_goal_is_sent_cancels_it(client, graph):
    graph()
    run, go = run_goal()
    with pytest.raises(Interrupted, match="preempted"):
        go()
    assert client.cancels() == [CommState.ACTIVE]
    assert run.last.state == "preempted"


def test_ctrl_c_before_the_server_has_told_of_the_goal_waits_for_its_end(client, graph):
    def on_sent(goal):
        press()
        threading.Timer(LATE, goal.tell, [GoalStatus.ACTIVE]).start()

    graph()
    client.on_sent = staticmethod(on_sent)
    run, go = run_goal()
    with pytest.raises(Interrupted, match="preempted"):
        go()
    assert (run.last.state, client.cancels()) == ("preempted", [CommState.ACTIVE])


def test_ctrl_c_once_more_while_it_is_cancelled_does_not_lose_it(client, graph):
    graph()
    client.in_cancel = staticmethod(press)
    _, go = run_goal()
    with pytest.raises(KeyboardInterrupt):
        go()
    assert len(client.cancels()) == 1


def test_ctrl_c_once_more_while_it_says_that_it_stops_does_not_leave_the_goal_running(client, graph, monkeypatch):
    monkeypatch.setattr(Progress, "note", lambda *_: press())
    graph()
    _, go = run_goal()
    with pytest.raises(KeyboardInterrupt):
        go()
    assert len(client.cancels()) == 1


def test_ctrl_c_when_the_goal_is_over_cancels_nothing(client, graph):
    def on_sent(goal):
        press()
        goal.end(GoalStatus.SUCCEEDED)
        goal.tell()  # told before the goal came to the server

    graph()
    client.on_sent = staticmethod(on_sent)
    run, go = run_goal()
    with pytest.raises(Interrupted, match="the goal was over before: succeeded"):
        go()
    assert (run.last.state, client.cancels()) == ("succeeded", [])


def test_a_goal_that_is_over_when_the_time_is_up_has_its_end(client, graph):
    graph()
    client.on_sent = staticmethod(lambda goal: goal.end(GoalStatus.SUCCEEDED))
    _, go = run_goal(timeout=1e-9)
    assert go().succeeded
    assert client.cancels() == []


def test_a_goal_that_ends_while_it_is_to_be_cancelled_has_its_end(client, graph):
    def on_sent(goal):
        goal.tell(GoalStatus.ACTIVE)
        goal.just_before_the_cancel(lambda: goal.end(GoalStatus.SUCCEEDED))

    graph()
    client.on_sent = staticmethod(on_sent)
    _, go = run_goal(timeout=1e-9)
    assert go().succeeded
    assert client.cancels() == []


def test_ctrl_c_while_a_goal_that_takes_too_long_is_cancelled_does_not_leave_it_running(client, graph):
    graph()
    client.on_sent = staticmethod(lambda goal: goal.just_before_the_cancel(press))
    _, go = run_goal(timeout=1e-9)
    with pytest.raises(KeyboardInterrupt):
        go()
    assert len(client.cancels()) == 1


def test_a_goal_that_takes_too_long_is_cancelled(client, graph, capsys):
    graph()
    client.on_sent = staticmethod(lambda goal: goal.tell(GoalStatus.ACTIVE))
    run, go = run_goal(timeout=0.01)
    with pytest.raises(CommandFailed, match="not done within 0.01 s: cancelled"):
        go()
    assert (run.last.state, client.cancels()) == ("preempted", [CommState.ACTIVE])
    assert '"state": "preempted"' in capsys.readouterr().out


def test_an_interrupt_that_was_held_counts_afterwards_and_the_next_one_at_once():
    done = []
    with pytest.raises(KeyboardInterrupt):
        with interrupt_held():
            press()
            done.append("inside")
        done.append("after")
    assert done == ["inside"]
    with pytest.raises(KeyboardInterrupt):
        press()
