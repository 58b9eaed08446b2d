"""Goals that come before the robot has ever been there."""

from __future__ import annotations

import threading
import time

import pytest
from genpy import Duration

from nao_library_actions.msg import NaoLedAction, NaoLedGoal
from nao_library_modules.first_contact import require_patience
from nao_library_modules.nao_basic import NaoBasic
from nao_library_msgs.msg import LedFunction
from nao_library_msgs.srv import DescribeFunctionsRequest
from naoqi.errors import NaoError, RobotUnreachable

LIMIT = 5.0
AWAITED = "the robot at 10.0.0.7:9559"


class Module(NaoBasic):
    """A module with one function, which needs the robot."""

    def __init__(self, **options):
        super().__init__("10.0.0.7", 9559, **options)
        self.chains = 0
        self.told = threading.Event()
        self.function_table["look"] = self.look
        self.serve("Module", NaoLedAction)

    def begin_chain(self):
        """Count the chains for which the wait is over."""
        self.chains += 1

    def look(self):
        """Answers what the robot is called."""
        if self.robot.connection.state != "connected":
            raise RobotUnreachable("10.0.0.7", 9559, "not reached yet")
        return self.robot.memory.getData("Name")

    def _tell_wait(self, awaited, count):
        super()._tell_wait(awaited, count)
        self.told.set()


@pytest.fixture
def absent(robot):
    """A robot that has never been reached."""
    robot.connection.state, robot.connection.generation = "connecting", 0
    return robot


def goal(function="look"):
    return NaoLedGoal([LedFunction(function=function, time=Duration(0))])


def test_the_first_goal_waits_for_the_robot_and_says_so(absent, edge):
    module = Module(robot=absent, edge=edge, patience=LIMIT)
    thread = module.server.play_in_background(goal())
    assert module.told.wait(LIMIT)
    assert (module.chains, module.server.end) == (0, None)
    told = edge.descriptions["Module"](DescribeFunctionsRequest())
    assert (list(told.running), told.connected) == (["look"], False)
    absent.connection.become("connected")
    thread.join(LIMIT)
    assert (module.server.end, module.server.result.memList) == ("succeeded", ["nao"])
    told = [(f.waiting, f.index, f.function, f.count) for f in module.server.feedback]
    assert told == [(AWAITED, 0, "", 1), ("", 0, "look", 1)]
    assert absent.connection.listeners == [module._connection_changed]


def test_who_waits_is_told_in_the_log(absent, edge, caplog):
    caplog.set_level("INFO")
    Module(robot=absent, edge=edge, patience=0.05).server.play(goal())
    assert f"a goal waits for {AWAITED}, which was not reached yet" in caplog.text


def test_patience_is_counted_from_the_start_of_the_module(absent, edge):
    module = Module(robot=absent, edge=edge, patience=0.2)
    began = time.monotonic()
    assert module.server.play(goal()).text.endswith("not reached yet.")
    assert time.monotonic() - began >= 0.15
    module.server.feedback.clear()
    assert module.server.play(goal()).end == "aborted"
    assert [f.function for f in module.server.feedback] == ["look"], "the second goal did not wait"


def test_a_goal_that_is_wrong_anyway_is_refused_at_once(absent, edge):
    module = Module(robot=absent, edge=edge, patience=60.0)
    assert module.server.play(goal("lok")).text.startswith("function 1 (lok): unknown function")
    assert module.server.play(NaoLedGoal([])).end == "aborted"
    assert module.server.feedback == []


def test_preemption_ends_the_wait(absent, edge):
    module = Module(robot=absent, edge=edge, patience=60.0)
    thread = module.server.play_in_background(goal())
    assert module.told.wait(LIMIT)
    module.server.preempt()
    thread.join(LIMIT)
    assert module.server.end == "preempted"


@pytest.mark.parametrize("state", ["lost", "closed"])
def test_nobody_waits_for_a_robot_that_went_away(robot, edge, state):
    robot.connection.state = state
    module = Module(robot=robot, edge=edge, patience=60.0)
    assert module.server.play(goal()).end == "aborted"


def test_functions_that_need_no_robot_do_not_wait(absent, edge):
    module = Module(robot=absent, edge=edge, patience=60.0)
    module.without_robot = frozenset({"look"})
    assert [f.function for f in module.server.play(goal()).feedback] == ["look"]


def test_one_function_that_needs_the_robot_makes_the_goal_wait(absent, edge):
    module = Module(robot=absent, edge=edge, patience=0.05)
    module.without_robot = frozenset({"look"})
    run = module.server.play(NaoLedGoal([*goal().functions, LedFunction(function="getData", str_param="a")]))
    assert [f.waiting for f in run.feedback][:1] == [AWAITED]


@pytest.mark.parametrize("value", [0, 12.5])
def test_a_patience_is_a_time(value):
    assert require_patience(value) == value


@pytest.mark.parametrize("value", [-1.0, float("inf"), float("nan"), True, "30"])
def test_other_patiences_are_refused(value):
    with pytest.raises(NaoError, match="0 s or more"):
        require_patience(value)
