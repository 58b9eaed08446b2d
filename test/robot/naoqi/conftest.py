"""What the modules of the robot are asked with: calls that take time, calls that are refused, modules of clients."""

import math  # noqa: F401  for the arguments of refused calls
import queue
import re

import pytest
import qi
from simulator import PATIENCE, connected

PREFIX = "Device/SubDeviceList/"


@pytest.fixture
def begin(robot):
    """Makes a call that takes simulated time, and lets some pass; the future of its answer."""

    def call(module, method, *arguments, after=0.0):
        future = robot.post(module, method, *arguments)
        robot.handed_over(module)
        robot.advance(after)
        return future

    return call


@pytest.fixture
def read(robot):
    """What ALMemory has of a device, or under any other key."""

    def value(key):
        device = key.endswith(("/Value", "/Status")) and not key.startswith(PREFIX)
        return robot.ALMemory.getData(PREFIX + key if device else key)

    return value


@pytest.fixture
def refuses(robot):
    """Checks that calls of a module are refused with the right words, and that nothing has come of them.

    Rows are "method(arguments) -> regular expression"; the module and the method stand in front of each text.
    """

    def state():
        motion = robot.ALMotion
        return motion.getAngles("Body", False), robot.ALLeds.getIntensity("AllLeds"), motion.getTaskList()

    def check(module, rows):
        before, wrong = state(), {}
        for row in rows.strip().splitlines():
            call, words = row.strip().split(" -> ")
            method, arguments = call.split("(", 1)
            try:
                arguments = eval(f"({arguments[:-1]},)" if arguments != ")" else "()")
                answer = getattr(robot, module).call(method, *arguments)
                wrong[call] = f"answered {answer!r}"
            except RuntimeError as error:
                if not re.match(f"{module}::{method} .*{words}", str(error), re.DOTALL):
                    wrong[call] = str(error)
        assert wrong == {}
        robot.advance(0.05)
        angles, *rest = state()
        assert angles == pytest.approx(before[0], abs=0.02) and rest == list(before[1:])

    return check


class Listener:
    """A module of a client that events call back, and that has signals."""

    def __init__(self):
        self.heard, self.conflicts = queue.Queue(), queue.Queue()
        self.touched, self.moved = qi.Signal("(i)"), qi.Signal("(ii)")

    @qi.bind(qi.Void, [qi.String, qi.Dynamic, qi.String])
    def onEvent(self, name, value, message):
        self.heard.put((name, value, message))

    @qi.bind(qi.Void, [qi.String, qi.String])
    def onConflict(self, resource, owner):
        self.conflicts.put((resource, owner))

    def next(self):
        """Name, value and message of the next call."""
        return self.heard.get(timeout=PATIENCE)

    def until(self, last):
        """Value by name of the calls up to the event `last`: one connection keeps their order."""
        found = {}
        while last not in found:
            name, value, _ = self.next()
            found[name] = value
        del found[last]
        return found


@pytest.fixture(scope="session")
def shared_listener(shared_robot):
    """Registered as the module "Listener" once for all: libqi takes its time to forget a module of the same name."""
    session = connected(shared_robot.port)
    session.listen("tcp://127.0.0.1:0")
    module = Listener()
    session.registerService("Listener", module)
    yield module
    session.close()


@pytest.fixture
def listener(robot, shared_listener):
    """The module "Listener", which nobody calls yet."""
    shared_listener.heard = queue.Queue()
    return shared_listener
