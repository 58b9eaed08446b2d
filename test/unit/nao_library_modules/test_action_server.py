"""The loop that carries out goals, without a master: actionlib's server around it is not built."""

from __future__ import annotations

import threading
import weakref
from types import SimpleNamespace

import pytest
import rospy
from actionlib.server_goal_handle import ServerGoalHandle
from actionlib_msgs.msg import GoalID

from nao_library_actions.msg import NaoLedAction, NaoLedActionGoal, NaoLedGoal
from nao_library_modules import action_server
from nao_library_modules.action_server import PromptActionServer

LIMIT = 5.0


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
        self.tidied = 0
        self._heap = SimpleNamespace(tidy=self.count_tidying)
        self.action_server = SimpleNamespace(lock=threading.RLock(), status_list=[])
        self.current_goal = self.next_goal = ServerGoalHandle()

    def __del__(self):
        """There is no thread to be joined."""

    def wait(self, timeout):
        self.need_to_terminate = True

    def count_tidying(self):
        self.tidied += 1

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
    assert server.tidied == 2


def test_a_goal_left_without_an_end_state_is_aborted():
    server = Server(["forgotten"], lambda goal: None)
    server.executeLoop()
    assert server.aborted == ["no end state was set"]


def test_the_loop_ends_with_the_node(monkeypatch):
    monkeypatch.setattr(action_server.rospy, "is_shutdown", lambda: True)
    server = Server(["never"], None)
    server.executeLoop()
    assert server.goals == ["never"]


class BigGoal(NaoLedGoal):
    """A goal that can be watched."""


class Actionlib:
    """A server with all of actionlib in it but the topics."""

    def __init__(self, execute):
        self.server = PromptActionServer("NaoLights", NaoLedAction, execute_cb=execute, auto_start=False)
        self.inside = self.server.action_server
        self.inside.status_pub = self.inside.result_pub = SimpleNamespace(publish=lambda message: None)
        self.inside.status_list_timeout = rospy.Duration(5.0)
        self.inside.started = True

    def send(self, name):
        """Have a goal arrive; a weak reference to it."""
        goal = BigGoal()
        self.inside.internal_goal_callback(NaoLedActionGoal(goal_id=GoalID(id=name), goal=goal))
        return weakref.ref(goal)

    def told(self):
        """Ids of the goals whose states are told."""
        return [tracker.status.goal_id.id for tracker in self.inside.status_list]

    def end(self):
        self.server.need_to_terminate = True
        self.server.execute_thread.join(LIMIT)


@pytest.fixture
def actionlib_server(monkeypatch):
    monkeypatch.setattr(rospy.Time, "now", lambda: rospy.Time(1))
    servers = []

    def make(execute):
        servers.append(Actionlib(execute))
        return servers[-1]

    yield make
    for server in servers:
        server.end()


def test_what_was_in_a_goal_is_gone_when_it_is_over_and_its_state_is_told_on(actionlib_server, no_ring_collector):
    taken_up = threading.Event()
    actionlib = actionlib_server(lambda _: (actionlib.server.set_succeeded(), taken_up.set()))
    goal = actionlib.send("first")
    assert taken_up.wait(LIMIT)
    actionlib.end()
    assert goal() is None
    assert actionlib.told() == ["first"]


def test_a_goal_that_was_never_taken_up_is_let_go_of_when_another_takes_its_place(actionlib_server, no_ring_collector):
    busy, go_on = threading.Event(), threading.Event()
    actionlib = actionlib_server(lambda _: (busy.set(), go_on.wait(LIMIT), actionlib.server.set_preempted()))
    running = actionlib.send("first")
    assert busy.wait(LIMIT)
    waiting = actionlib.send("second")
    assert None not in (running(), waiting())
    actionlib.send("third")
    assert waiting() is None, "it was kept although it is over"
    assert running() is not None, "it was let go of before its end"
    go_on.set()
    actionlib.end()
    assert actionlib.told() == ["first", "second", "third"]


def test_a_cancel_that_comes_after_the_end_of_its_goal_changes_nothing(actionlib_server):
    taken_up = threading.Event()
    actionlib = actionlib_server(lambda _: (actionlib.server.set_succeeded(), taken_up.set()))
    actionlib.send("first")
    assert taken_up.wait(LIMIT)
    actionlib.end()
    actionlib.inside.internal_cancel_callback(GoalID(id="first"))
    assert not actionlib.server.is_preempt_requested()
    assert actionlib.told() == ["first"]
