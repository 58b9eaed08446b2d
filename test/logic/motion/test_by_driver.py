"""Which calls of ALMotion have words in nao_robot's interface, and which go to NAOqi."""

from __future__ import annotations

import time
from types import SimpleNamespace

import pytest

from nao_library_modules.core.geometry import Place
from nao_library_modules.core.joint_trajectory import KeyFrames
from nao_library_modules.core.process_owners import OwnerLine
from nao_library_modules.motion.motion_server import RobotByDriver

FRAMES = KeyFrames(("HeadYaw", "HeadPitch"), (0.5, 1.25), ((0.1, 0.2), (0.0, -0.1)), ((0.3, 0.0), (-0.2, 0.1)))
YAW = ["HeadYaw"]


class Calls:
    """Keeps what is called, and answers with a call that goes on; `there` says whether it is."""

    def __init__(self, there=True):
        self.calls, self._there = [], there

    def there(self):
        return self._there

    def walk_cure(self):
        return ["service", "/stop_walk_srv", "/NaoMotion"]

    def __getattr__(self, name):
        return lambda *arguments: self.calls.append((name, *arguments)) or Call()


class Call:
    def add_done_callback(self, callback):
        pass


def made_of(proxy, owners):
    """A robot all of whose modules are this proxy."""
    connection = SimpleNamespace(answering_time=time.monotonic)
    return SimpleNamespace(proxy=lambda name: proxy, connection=connection, owners=owners)


@pytest.fixture
def robot():
    return Calls()


def call(robot, driver, method, *arguments, module="ALMotion"):
    proxies = RobotByDriver(made_of(robot, OwnerLine("nobody:0")), driver)
    return proxies.proxy(module).call_async(method, *arguments)


@pytest.mark.parametrize("method, arguments, words", [
    ("angleInterpolation", (YAW, [[0.1, 0.2]], [[1.0, 2.0]], False),
     ("follow", KeyFrames(("HeadYaw",), (1.0, 2.0), ((0.1, 0.2),), None, True))),
    ("angleInterpolationBezier", FRAMES.bezier_arguments(), ("follow", FRAMES)),
    ("angleInterpolationWithSpeed", (YAW, [0.1], 0.2), ("go", YAW, [0.1], 0.2)),
    ("stiffnessInterpolation", (YAW, [[1.0]], [[0.5]]), ("stiffen", KeyFrames(("HeadYaw",), (0.5,), ((1.0,),)))),
    ("moveTo", (0.1, 0.2, 0.3), ("walk_by", Place(0.1, 0.2, 0.3))),
    ("moveToward", (1.0, 0.0, 0.0), ("walk_at", 1.0, 0.0, 0.0)),
])  # fmt: skip
def test_what_has_words_goes_to_the_driver_if_it_is_there(robot, method, arguments, words):
    driver, absent = Calls(), Calls(there=False)
    call(robot, driver, method, *arguments)
    ((name, *told),) = driver.calls
    assert name == words[0] and not robot.calls
    for mine, theirs in zip(told, words[1:]):
        if isinstance(theirs, KeyFrames) and theirs.velocities:
            assert mine.velocities[0] == pytest.approx(theirs.velocities[0]), method
            theirs = KeyFrames(theirs.joints, theirs.times, theirs.values, mine.velocities)
        assert mine == theirs
    call(robot, absent, method, *arguments)
    assert robot.calls == [("call_async", method, *arguments)] and not absent.calls


@pytest.mark.parametrize("method, arguments", [
    ("getAngles", (YAW, True)),
    ("wakeUp", ()),
    ("angleInterpolation", ([*YAW, "LHand"], [[0.1], [0.2]], [[1.0], [2.0]], True)),
    ("angleInterpolationBezier", (YAW, [[1.0]], [[[0.5, [3, -0.5, 0.0], [3, 0.0, 0.0]]]])),
    ("setAngles", (YAW, [0.1], 0.2)),
    ("moveTo", (0.1, 0.2, 0.3, [["MaxStepX", 0.04]])),
    ("moveTo", ([[0.1, 0.0, 0.0], [0.2, 0.0, 0.0]],)),
    ("positionInterpolations", (["LArm"], 0, [], [], [])),
])  # fmt: skip
def test_what_has_no_words_goes_to_the_robot(robot, method, arguments):
    driver = Calls()
    call(robot, driver, method, *arguments)
    assert robot.calls == [("call_async", method, *arguments)] and not driver.calls


def test_a_stop_is_told_to_the_robot_whatever_the_driver_does(robot):
    class Driver(Calls):
        def leave_walk(self):
            self.calls.append("leave_walk")

    driver = Driver()
    call(robot, driver, "stopMove")
    assert driver.calls == ["leave_walk"] and robot.calls == [("call_async", "stopMove")]


def test_a_walk_by_the_driver_is_taken_back_from_it_when_this_process_dies(robot):
    told = []
    owners = SimpleNamespace(sending=lambda *call: told.append(call))
    motion = RobotByDriver(made_of(robot, owners), Calls()).proxy("ALMotion")
    motion.call_async("moveTo", 0.1, 0.2, 0.3)
    motion.call_async("angleInterpolationWithSpeed", YAW, [0.1], 0.2)
    assert told == [
        ("ALMotion", "moveTo", (0.1, 0.2, 0.3), ["service", "/stop_walk_srv", "/NaoMotion"]),
        ("ALMotion", "angleInterpolationWithSpeed", (YAW, [0.1], 0.2), None),
    ]
