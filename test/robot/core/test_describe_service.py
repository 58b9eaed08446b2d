"""The service beside every action server."""

from __future__ import annotations

import pytest
from genpy import Duration

from nao_library_msgs.msg import LedFunction
from nao_library_msgs.srv import DescribeFunctionsRequest


@pytest.fixture
def ask(lights):
    def ask(*functions, **fields):
        return lights.node.descriptions["NaoLights"](DescribeFunctionsRequest(functions=list(functions), **fields))

    return ask


def test_it_tells_all_functions_and_what_they_are_for(ask, lights, robot):
    answer = ask()
    assert [function.name for function in answer.functions] == list(lights.module.function_table)
    assert (answer.action, answer.message) == ("nao_library_actions/NaoLed", "nao_library_msgs/LedFunction")
    assert answer.help.startswith("LED goals") and answer.connected
    assert [argument.name for argument in answer.common] == ["time", "on_error"]
    (on,) = [function for function in answer.functions if function.name == "on"]
    named = next(argument for argument in on.arguments if argument.name == "lights")
    assert {"FaceLeds", "Eyes"} <= set(named.choices), "lights are those of the robot, and plain words for them"
    answer = ask(without_functions=True)
    assert not answer.functions and answer.robot == f"127.0.0.1:{robot.port}"


def test_it_tells_those_that_are_asked_for_and_which_are_unknown(ask, lights):
    answer = ask("setColor", "setColour")
    assert [function.name for function in answer.functions] == ["setColor"] and answer.unknown == ["setColour"]
    (function,) = ask("setColor", without_arguments=True).functions
    assert function.help and not function.arguments


def test_it_tells_the_goal_that_runs(ask, lights, robot):
    goal = lights.send(LedFunction(function="listGroups"), LedFunction(function="listLEDs", time=Duration(100)))
    robot.advance(0.5)
    answer = ask(without_functions=True)
    assert (answer.running, answer.index) == (["listGroups", "listLEDs"], 1)
    goal.cancel()
    assert ask(without_functions=True).running == []
