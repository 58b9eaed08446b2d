"""Ctrl-C and the time limit while a goal is on its way and while it ends."""

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
from nao_library_modules.command_line.goals import GoalRun
from nao_library_modules.command_line.settings import Settings
from nao_library_msgs.msg import LedFunction


def press():
    """Ctrl-C, as a terminal sends it."""
    os.kill(os.getpid(), signal.SIGINT)


def active(goal):
    goal.tell(GoalStatus.ACTIVE)


@pytest.fixture
def begin(monkeypatch, graph):
    """Sends a goal to a server that does as the test says: a run, what carries it out, and the goals that were sent."""
    graph()
    sent = []

    def make(on_sent, in_cancel=lambda: None, **settings):
        class Client:
            def __init__(self, *_):
                pass

            def wait_for_server(self):
                return True

            def send_goal(self, goal, on_change, _):
                sent.append(FakeGoal(on_change, in_cancel))  # published: the server has it
                on_sent(sent[-1])
                return sent[-1].handle

        monkeypatch.setattr(actionlib, "ActionClient", Client)
        monkeypatch.setattr(goals, "start_node", lambda: None)
        run = GoalRun(Settings(json=True, **settings), "NaoLights")
        return run, lambda: run.run([LedFunction(function="rasta")]), sent

    return make


@pytest.mark.parametrize("late", [False, True])
def test_ctrl_c_while_a_goal_is_sent_cancels_it_as_soon_as_the_server_knows_it(begin, late):
    def on_sent(goal):
        press()
        threading.Timer(0.1, active, [goal]).start() if late else active(goal)

    run, go, sent = begin(on_sent)
    with pytest.raises(Interrupted, match="preempted"):
        go()
    assert run.last.state == "preempted" and sent[0].cancelled == [CommState.ACTIVE]


def test_ctrl_c_when_the_goal_is_over_cancels_nothing(begin):
    run, go, sent = begin(lambda goal: (press(), goal.end(GoalStatus.SUCCEEDED), goal.tell()))
    with pytest.raises(Interrupted, match="the goal was over before: succeeded"):
        go()
    assert (run.last.state, sent[0].cancelled) == ("succeeded", [])
    end = lambda goal: goal.end(GoalStatus.SUCCEEDED)  # noqa: E731
    for on_sent in (end, lambda goal: (active(goal), goal.just_before_the_cancel(lambda: end(goal)))):
        _, go, sent = begin(on_sent, timeout=1e-9)
        assert go().succeeded and sent[-1].cancelled == []


def test_a_goal_that_takes_too_long_is_cancelled_in_spite_of_ctrl_c(begin, capsys):
    run, go, sent = begin(active, timeout=0.01)
    with pytest.raises(CommandFailed, match="not done within 0.01 s: cancelled"):
        go()
    assert (run.last.state, sent[0].cancelled) == ("preempted", [CommState.ACTIVE])
    assert '"state": "preempted"' in capsys.readouterr().out
    _, go, sent = begin(lambda goal: (active(goal), goal.just_before_the_cancel(press)), timeout=1e-9)
    with pytest.raises(KeyboardInterrupt):
        go()
    assert len(sent[1].cancelled) == 1
