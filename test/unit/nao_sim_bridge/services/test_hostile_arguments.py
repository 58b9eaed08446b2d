"""Every method with arguments that no program should send: answers are in words of ours, and the robot lives on."""

from __future__ import annotations

import random
import re
import zlib

import pytest
from naoqi_calls import CALLS

from nao_sim_bridge.services.api import COMMON, module_methods
from nao_sim_bridge.services.binding import DEFECT, NATIVE, offered
from nao_sim_bridge.services.nao_simulation import NAME as SIMULATION

NAN, INF = float("nan"), float("inf")
HOSTILE = [
    *("", "x", "Body", "HeadYaw", "nan", "\n", "../..", "\u00e9\u4e16", "a" * 3000),
    *(None, True, False, NAN, INF, -INF, -1.0, 1e300, 0, 1, -1, 2**31 - 1, -(2**31), 2**63 - 1),
    *([], [[]], [[[[]]]], [""], [None], [True], [NAN], [{}], [1, "a"], ["HeadYaw", 3], ["HeadYaw", None], [1.0] * 7),
    *([[1, 2], [3]], [[["HeadYaw"]]], [["a", {}]], [[0.1, 0.2], ["a", [None]]], ["a", "b", "c"], [0.1, 0.2, 0.3]),
    *({}, {"a": 1}, {"a": {"b": [1]}}, {1: 2}),
]
# These end what is tested.
ENDS = {"exit", "shutdown"}
ROUNDS = 2
VALID = 0.3
"""Share of arguments that are right: else nothing behind the first check would be reached."""
PYTHON = re.compile(
    r"Traceback|NoneType|object (is not|has no|does not|of type|cannot)|has no attribute|not iterable|unhashable|"
    r"(Key|Type|Value|Index|Attribute|Overflow|Unicode\w*|Recursion)Error|(positional|keyword) argument|"
    r"could not convert|invalid literal|not supported between|unsupported operand|to unpack|out of range|"
    r"must be (real|str|int|a real)|math domain|indices must|not subscriptable|cannot be interpreted|codec can't|"
    r"broadcast|inhomogeneous|\[Errno|" + DEFECT
)


def hostile(chance, depth=0):
    """Something of `HOSTILE`, or a list of such things."""
    if depth < 3 and chance.random() < 0.2:
        return [hostile(chance, depth + 1) for _ in range(chance.randrange(4))]
    return chance.choice(HOSTILE)


def calls_of(robot, module):
    """Method, parameter names and valid arguments, as far as they are known, of each way to call a module."""
    known = CALLS.get(module, {})
    for name in offered(module, robot.server.modules()[module])[0]:
        if name in NATIVE | ENDS or (module != "ALTouch" and name in module_methods(COMMON)):
            continue  # the common methods are the same for all
        for overload in module_methods(module)[name].overloads:
            yield name, len(overload.types), known.get(name, ())


def simulation_calls(robot):
    """As `calls_of`, of the service that is no NAOqi module."""
    for method in robot.NaoSimulation.metaObject()["methods"].values():
        if method["uid"] >= 100 and method["name"] not in ("advance", "setSpeed", "resume"):  # time is the test's own
            letters = re.findall(r"\[?[a-z]\]?", method["parametersSignature"])
            yield method["name"], len(letters), ()


def unfit(robot, module, calls):
    """Calls with answers that are unfit for a client."""
    chance, futures = random.Random(zlib.crc32(module.encode())), []
    for name, count, valid in list(calls) * ROUNDS:
        arguments = [
            valid[i] if i < len(valid) and type(valid[i]) is not object and chance.random() < VALID else hostile(chance)
            for i in range(count)
        ]
        futures.append((name, arguments, robot.post(module, name, *arguments)))
    robot.NaoSimulation.isPaused() if module == SIMULATION else robot.handed_over(module)
    robot.settled()
    robot.advance(0.04)
    found = []
    for name, arguments, future in futures:
        if future.isRunning():
            future.cancel()
        elif future.hasError() and PYTHON.search(future.error()):
            found.append((name, arguments, future.error()))
    assert futures, f"{module} has no methods"
    return found


@pytest.mark.parametrize("module", [module for module, calls in CALLS.items() if calls])
def test_a_module_answers_hostile_arguments_in_words_of_its_own(shared_robot, module):
    assert unfit(shared_robot, module, calls_of(shared_robot, module)) == []
    assert getattr(shared_robot, module).ping() is True


def test_the_simulation_answers_hostile_arguments_in_words_of_its_own(shared_robot):
    assert unfit(shared_robot, SIMULATION, simulation_calls(shared_robot)) == []


def test_time_goes_on_afterwards(shared_robot):
    begin = shared_robot.now.time
    shared_robot.advance(0.1)
    assert shared_robot.now.time == pytest.approx(begin + 0.1)
    assert shared_robot.server.runner.running
