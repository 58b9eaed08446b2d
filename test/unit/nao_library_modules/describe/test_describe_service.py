"""The service beside every action server."""

import threading

import pytest

from nao_library_actions.msg import NaoLedGoal
from nao_library_msgs.msg import LedFunction
from nao_library_msgs.srv import DescribeFunctionsRequest


@pytest.fixture
def ask(lights, edge):
    def ask(*functions, **fields):
        return edge.descriptions["NaoLights"](DescribeFunctionsRequest(functions=list(functions), **fields))

    return ask


def test_it_tells_all_functions_and_what_they_are_for(ask, lights):
    answer = ask()
    assert [function.name for function in answer.functions] == list(lights.function_table)
    assert (answer.action, answer.message) == ("nao_library_actions/NaoLed", "nao_library_msgs/LedFunction")
    assert answer.help.startswith("LED goals")
    assert [argument.name for argument in answer.common] == ["time", "on_error"]


def test_it_tells_those_that_are_asked_for_and_which_are_unknown(ask):
    answer = ask("setColor", "setColour")
    assert [function.name for function in answer.functions] == ["setColor"]
    assert answer.unknown == ["setColour"]


def test_names_alone_come_without_arguments(ask):
    answer = ask("setColor", without_arguments=True)
    assert answer.functions[0].help and not answer.functions[0].arguments


def test_about_itself_it_tells_no_functions(ask, robot):
    answer = ask(without_functions=True)
    assert not answer.functions
    assert answer.robot == robot.address


def test_lights_are_those_of_the_robot(ask, robot):
    robot.connection.state = "connected"
    (function,) = ask("on").functions
    lights = next(argument for argument in function.arguments if argument.name == "lights")
    assert "FaceLeds" in lights.choices


def test_a_robot_that_is_not_there_is_not_asked(ask, robot):
    robot.connection.state = "lost"
    answer = ask("on")
    assert not answer.connected
    assert not answer.functions[0].arguments[0].choices


def test_it_tells_the_goal_that_runs(ask, lights, edge):
    wait = LedFunction(function="listLEDs")
    wait.time.secs = 100
    thread = lights.server.play_in_background(NaoLedGoal([LedFunction(function="listGroups"), wait]))
    assert edge.clock.waiting.wait(5.0)
    edge.clock.waiting.clear()
    answer = ask(without_functions=True)
    assert (answer.running, answer.index) == (["listGroups", "listLEDs"], 1)
    lights.server.preempt()
    thread.join(5.0)
    assert ask(without_functions=True).running == []


def test_a_function_that_is_put_into_the_table_later_is_told(ask, lights):
    def wink(lights: list) -> None:
        """Close one eye."""

    lights.function_table["wink"] = wink
    (function,) = ask("wink").functions
    assert (function.help, [a.name for a in function.arguments]) == ("Close one eye.", ["lights"])


def test_several_clients_may_ask_at_once(ask):
    answers = []
    threads = [threading.Thread(target=lambda: answers.append(len(ask().functions))) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(10.0)
    assert len(answers) == 4 and len(set(answers)) == 1
