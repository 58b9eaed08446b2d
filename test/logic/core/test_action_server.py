"""The loop that carries out goals, with all of actionlib around it but the topics."""

from __future__ import annotations

import threading
from types import SimpleNamespace

import pytest
import rospy
from actionlib_msgs.msg import GoalID, GoalStatus

from nao_library_actions.msg import NaoLedAction, NaoLedActionGoal
from nao_library_modules import action_server
from nao_library_modules.action_server import PromptActionServer

LIMIT = 15.0


class Actionlib:
    """A server and what it publishes: ends of goals by their names."""

    def __init__(self, execute):
        self.ends = {}
        self.news = threading.Condition()
        self.server = PromptActionServer("NaoLights", NaoLedAction, execute_cb=execute, auto_start=False)
        self.inside = self.server.action_server
        self.inside.status_pub = SimpleNamespace(publish=lambda message: None)
        self.inside.result_pub = SimpleNamespace(publish=self.ended)
        self.inside.status_list_timeout = rospy.Duration(5.0)
        self.inside.started = True

    def ended(self, result):
        with self.news:
            self.ends[result.status.goal_id.id] = result.status
            self.news.notify_all()

    def send(self, name):
        """Have a goal arrive."""
        self.inside.internal_goal_callback(NaoLedActionGoal(goal_id=GoalID(id=name)))

    def wait(self, *names):
        with self.news:
            assert self.news.wait_for(lambda: all(name in self.ends for name in names), LIMIT), self.ends

    def end(self):
        self.server.need_to_terminate = True
        self.server.execute_thread.join(LIMIT)
        assert not self.server.execute_thread.is_alive()


@pytest.fixture
def serve(monkeypatch):
    monkeypatch.setattr(rospy.Time, "now", lambda: rospy.Time(1))
    monkeypatch.setattr(action_server.rospy, "is_shutdown", lambda: False)
    made = []

    def make(execute):
        made.append(Actionlib(execute))
        return made[-1]

    yield make
    for one in made:
        one.end()


def test_goals_are_carried_out_one_after_the_other_without_a_wait_between(serve, monkeypatch):
    monkeypatch.setattr(action_server, "SHUTDOWN_POLL", 60.0)
    done = []

    def execute(goal):
        done.append(len(done))
        if len(done) == 1:
            one.send("second")  # announced to nobody: the loop does not wait now
        one.server.set_succeeded()

    one = serve(execute)
    one.send("first")
    one.wait("first", "second")
    assert done == [0, 1]
    one.server.need_to_terminate = True
    one.send("last")


def test_a_goal_with_an_error_or_without_an_end_is_aborted_and_the_next_one_runs(serve):
    def execute(goal):
        name = one.server.current_goal.get_goal_id().id
        if name == "bad":
            raise ValueError("no such thing")
        if name == "good":
            one.server.set_succeeded()

    one = serve(execute)
    for name in ("bad", "forgotten", "good"):
        one.send(name)
        one.wait(name)
    ends = [(one.ends[name].status, one.ends[name].text) for name in ("bad", "forgotten", "good")]
    assert ends[0][0] == ends[1][0] == GoalStatus.ABORTED and ends[2][0] == GoalStatus.SUCCEEDED
    assert "no such thing" in ends[0][1] and ends[1][1] == "no end state was set"


def test_the_loop_ends_with_the_node(serve, monkeypatch):
    monkeypatch.setattr(action_server.rospy, "is_shutdown", lambda: True)
    one = serve(lambda goal: pytest.fail("the node has ended"))
    one.server.execute_thread.join(LIMIT)
    assert not one.server.execute_thread.is_alive()
