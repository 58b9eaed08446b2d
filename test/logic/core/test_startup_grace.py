"""Goals that come before the robot has ever been there, and a robot that goes away: the connection is the test's."""

from __future__ import annotations

import threading
from types import SimpleNamespace

import pytest
from genpy import Duration
from recorded_node import RecordedNode

from nao_library_actions.msg import NaoLedAction, NaoLedGoal
from nao_library_modules import nao_basic
from nao_library_modules.core import robot
from nao_library_modules.core.robot import require_start_patience
from nao_library_modules.nao_basic import NaoBasic
from nao_library_msgs.msg import LedFunction
from nao_library_msgs.srv import DescribeFunctionsRequest
from naoqi.errors import NaoError, RobotUnreachable

LIMIT = 60.0
ADDRESS = "10.0.0.7:9559"
AWAITED = f"the robot at {ADDRESS}"


class Connection:
    """A connection of the proxy layer, in the state that the test says."""

    latency, silent = 0.001, 0.0

    def __init__(self, state, generation):
        self.state, self.generation, self.last_error = state, generation, None
        self.listeners = []

    def add_listener(self, listener):
        self.listeners.append(listener)

    def remove_listener(self, listener):
        self.listeners.remove(listener)

    def become(self, state, last_error=None):
        self.state, self.last_error = state, last_error
        self.generation += state == "connected"
        for listener in list(self.listeners):
            listener(state)


class Module(NaoBasic):
    """A module with one function, which needs the robot."""

    def __init__(self, connection, **options):
        robot = SimpleNamespace(address=ADDRESS, connection=connection, proxy=lambda name: None)
        self.node = RecordedNode()
        super().__init__("10.0.0.7", 9559, robot=robot, node=self.node, **options)
        self.chains = 0
        self.function_table["look"] = self.look
        self.serve("Module", NaoLedAction)
        self.told = threading.Event()
        tell = self.server.publish_feedback
        self.server.publish_feedback = lambda feedback: (tell(feedback), self.told.set())

    def begin_chain(self):
        """Count the chains for which the wait is over."""
        self.chains += 1

    def look(self):
        if self.robot.connection.state != "connected":
            raise RobotUnreachable("10.0.0.7", 9559, "not reached yet")
        return "nao"

    def play(self, *functions, wait=0.0):
        messages = [LedFunction(function=name, str_param="a", time=Duration.from_sec(wait)) for name in functions]
        self.server.execute(NaoLedGoal(messages))
        return self.server

    def start(self, *functions, **fields):
        """Play in the background; what ends the wait for its end."""
        thread = threading.Thread(target=self.play, args=functions, kwargs=fields, daemon=True)
        thread.start()
        assert self.told.wait(LIMIT)

        def end():
            thread.join(LIMIT)
            return self.server

        return end

    def feedback(self):
        told, self.server.feedback = self.server.feedback, []
        return [(f.waiting, f.index, f.function, f.count) for f in told]


@pytest.fixture
def absent():
    """A robot that has never been reached."""
    return Connection("connecting", 0)


def test_the_first_goal_waits_for_the_robot_and_says_so(absent, caplog):
    caplog.set_level("INFO")
    module = Module(absent, start_patience=LIMIT)
    end = module.start("look")
    assert (module.chains, module.server.end) == (0, None)
    told = module.node.descriptions["Module"](DescribeFunctionsRequest())
    assert (list(told.running), told.connected) == (["look"], False)
    assert f"a goal waits for {AWAITED}, which was not reached yet" in caplog.text
    absent.become("connected")
    server = end()
    assert (server.end, server.result.memList) == ("succeeded", ["nao"])
    assert module.feedback() == [(AWAITED, 0, "", 1), ("", 0, "look", 1)]
    assert len(absent.listeners) == 1, "who waited listens no more"


@pytest.fixture
def now(monkeypatch):
    """The time of the computer as the grace sees it, s: what is set here."""
    time = [0.0]
    monkeypatch.setattr(robot, "time", SimpleNamespace(monotonic=lambda: time[0]))
    return time


def test_the_start_patience_is_counted_from_the_start_of_the_module(absent, now):
    module = Module(absent, start_patience=0.2)
    assert module.play("look").text.endswith("not reached yet.")
    assert module.feedback() == [(AWAITED, 0, "", 1), ("", 0, "look", 1)]
    now[0] = 0.2
    assert module.play("look").end == "aborted"
    assert module.feedback() == [("", 0, "look", 1)], "the second goal did not wait"


def test_preemption_ends_the_wait(absent):
    module = Module(absent, start_patience=60.0)
    end = module.start("look")
    module.server.preempt()
    assert end().end == "preempted"


@pytest.mark.parametrize("state", ["lost", "closed", "connecting"])
def test_nobody_waits_for_a_robot_that_went_away(state):
    module = Module(Connection(state, 1), start_patience=0.2)
    assert module.play("look").end == "aborted" and module.feedback() == [("", 0, "look", 1)]


def test_functions_that_need_no_robot_do_not_wait_unless_one_does(absent, now):
    module = Module(absent, start_patience=0.3)
    module.without_robot = frozenset({"look"})
    module.play("look")
    assert module.feedback() == [("", 0, "look", 1)]
    module.play("look", "getData")
    assert module.feedback()[0] == (AWAITED, 0, "", 2)


def test_a_launch_file_is_started_at_once_or_when_asked_for_and_stopped_with_the_node(monkeypatch):
    made, done = [], []
    supervisor = SimpleNamespace(start=lambda: done.append("start"), stop=lambda: done.append("stop"))
    monkeypatch.setattr(nao_basic, "launch_supervisor", lambda *arguments: made.append(arguments) or supervisor)
    path = ("nao_library", "nao.launch")
    module = Module(Connection("connected", 1), autostart=True, launchpath=path)
    assert (made, done) == ([(path, "10.0.0.7", 9559, "/robot1/")], ["start"])
    assert set(module.node.reports) == {"Module robot", "Module NAO", "Module goals", "Module launch file"}
    for action in module.node.shutdown_actions:
        action()
    assert done == ["start", "stop"]
    module = Module(Connection("connected", 1), launchpath=path)
    module.stop_launch()
    assert len(made) == 1, "it is left alone until asked for"
    module.start_launch()
    assert done == ["start", "stop", "start"]
    module.launchpath = ("usb_cam", "usb_cam-test.launch")
    assert len(made) == 2, "what runs goes on until another start is asked for"
    module.start_launch()
    assert made[-1][0] == module.launchpath and done[-2:] == ["stop", "start"]


def test_a_start_patience_is_a_time():
    assert [require_start_patience(value) for value in (0, 12.5)] == [0, 12.5]
    for value in (-1.0, float("inf"), float("nan"), True, "30"):
        with pytest.raises(NaoError, match="0 to 86400 s"):
            require_start_patience(value)
