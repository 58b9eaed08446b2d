"""Behaviours of the robot run to their end, or until they are stopped."""

from __future__ import annotations

import fake_sound
import pytest

from nao_library_modules.driver.behaviors import Behaviors
from nao_library_modules.errors import BadGoal, Preempted
from nao_library_modules.interrupt import Interrupt
from naoqi.errors import ConnectionLost, RobotError

HEY = "animations/Stand/Gestures/Hey_1"


class Manager:
    """ALBehaviorManager; a behaviour runs until the test ends it."""

    def __init__(self, make_call):
        self._make_call = make_call
        self.running = {}
        self.stopped = []
        self.refuses = False

    def getInstalledBehaviors(self):
        return [HEY, "dance"]

    def isBehaviorInstalled(self, name):
        return name in self.getInstalledBehaviors()

    def isBehaviorRunning(self, name):
        return name in self.running

    def runBehavior(self, name):
        if self.refuses:
            raise RobotError("ALBehaviorManager", "runBehavior", "no stiffness")
        self.running[name] = self._make_call(f"ALBehaviorManager.runBehavior({name})")
        return self.running[name]

    def stopBehavior(self, name):
        self.stopped.append(name)
        self.running.pop(name).end()


@pytest.fixture
def manager(make_call):
    return Manager(make_call)


@pytest.fixture
def robot(make_call, manager):
    return fake_sound.Robot(make_call, ALBehaviorManager=manager)


@pytest.fixture
def behaviors(robot):
    return Behaviors(robot)


def test_a_behaviour_runs_to_its_end(behaviors, manager, in_thread, eventually):
    thread, outcome = in_thread(behaviors.run, HEY, Interrupt())
    eventually(lambda: manager.running)
    assert not outcome
    manager.running.pop(HEY).end()
    thread.join(5.0)
    assert outcome == [None] and manager.stopped == []


def test_an_interrupt_stops_it(behaviors, manager, in_thread, eventually):
    interrupt = Interrupt()
    results = []

    def run():
        try:
            behaviors.run(HEY, interrupt)
        except Preempted:
            results.append("preempted")

    thread, _ = in_thread(run)
    eventually(lambda: manager.running)
    interrupt.trigger()
    thread.join(5.0)
    assert results == ["preempted"] and manager.stopped == [HEY]


def test_what_is_not_installed_is_told_with_what_is(behaviors):
    with pytest.raises(BadGoal, match=r"'dence' is not installed: did you mean 'dance'\?.*animations"):
        behaviors.run("dence", Interrupt())
    assert behaviors.installed() == [HEY, "dance"]


def test_a_refusal_and_a_loss_are_told(behaviors, manager, robot, in_thread, eventually):
    manager.refuses = True
    with pytest.raises(RobotError, match="no stiffness"):
        behaviors.run(HEY, Interrupt())
    manager.refuses = False
    thread, outcome = in_thread(behaviors.run, HEY, Interrupt())
    eventually(lambda: manager.running)
    robot.lose()
    thread.join(5.0)
    assert isinstance(outcome[0], ConnectionLost)
