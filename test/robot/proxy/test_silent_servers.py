"""A robot that is silent for a while as servers and the driver's parts see it: they go on, and tell."""

from __future__ import annotations

import threading

import pytest
from genpy import Duration
from recorded_node import RecordedNode

from nao_library_actions.msg import NaoLedAction, NaoLedGoal
from nao_library_modules.core.health import Level
from nao_library_modules.core.waiting import WallClock
from nao_library_modules.driver.base.lazy_subscription import LazySubscription
from nao_library_modules.driver.base.polling import Polling
from nao_library_modules.nao_basic import NaoBasic
from nao_library_msgs.msg import LedFunction
from naoqi.limits import Timing

SOON = 60.0


class Module(NaoBasic):
    """A module with a function that lasts until the robot ends it, one that only waits, and a quick one."""

    def __init__(self, robot, **options):
        self.node = RecordedNode()
        super().__init__(*robot.address, node=self.node, **options)
        self.function_table.update(begin=lambda: self.call(self.test, "begin"), rest=self.rest, add=self.add)
        self.test = self.robot.proxy("ALTest")
        self.under_way = threading.Event()
        self.serve("Module", NaoLedAction)

    def rest(self):
        self.under_way.set()
        self.wait(SOON)

    def add(self):
        return self.call_now(self.test, "add", 1, 2)  # which has a limit

    def play(self, name):
        """Play a goal in the background; what waits for its end."""
        goal = NaoLedGoal([LedFunction(function=name, time=Duration(0))])
        thread = threading.Thread(target=self.server.execute, args=[goal], daemon=True)
        thread.start()

        def end():
            thread.join(SOON)
            return self.server.end, self.server.text

        return end


@pytest.fixture
def robot(fragile_robot):
    return fragile_robot


@pytest.fixture
def module(robot):
    made = Module(robot)
    made.robot.connection.timing = Timing(heartbeat_period=0.05, silence=0.1, patience=3600.0)
    assert made.robot.connection.wait_connected(SOON)
    yield made
    for action in made.node.shutdown_actions:
        action()


@pytest.fixture
def silence(robot, module, eventually):
    """Silences the robot until that is known; then what makes it speak."""

    def silence():
        robot.silence()
        eventually(lambda: module.robot.connection.silent, "silence")
        return robot.speak

    return silence


def test_a_goal_under_way_and_a_new_one_go_on_when_the_robot_speaks_again(module, begun, silence, proxy):
    end = module.play("begin")
    begun()
    speak = silence()
    report = module.node.reports["Module robot"]()
    assert (report.level, report.values["state"]) == (Level.WARN, "silent") and "goals and calls wait" in report.message
    speak()
    proxy.finish(1)
    assert end()[0] == "succeeded"
    module.server.end, speak = None, silence()
    end = module.play("add")
    module.under_way.wait(0.3)
    assert module.server.end is None, "the new goal waits"
    speak()
    assert end()[0] == "succeeded" and module.robot.connection.generation == 1


@pytest.mark.parametrize("function", ["begin", "rest"])
def test_a_goal_fails_at_once_with_a_robot_that_is_gone(module, robot, begun, function):
    end = module.play(function)
    begun() if function == "begin" else module.under_way.wait(SOON)
    robot.kill()
    state, text = end()  # long before the patience is over
    assert state == "aborted" and f"127.0.0.1:{robot.port}" in text


def test_the_patience_of_a_module_is_that_of_its_connection(robot, module):
    other = Module(robot, patience=3.0)
    assert other.robot.connection is module.robot.connection and other.robot.connection.timing == Timing(patience=3.0)


def test_what_runs_on_the_robot_for_the_driver_is_not_begun_again_after_a_silence(module, silence, eventually):
    readings, starts, stops = [], [], []
    robot, wall = module.robot, WallClock()
    runs = LazySubscription(robot, "sound", lambda: starts.append(1), lambda: stops.append(1))
    polling = Polling(robot, "sum", 50.0, wall, lambda: readings.append(module.call_now(module.test, "add", 1, 2)))
    runs.want(True)
    polling.want(True)
    eventually(lambda: readings and starts, "readings")
    speak = silence()
    count = len(readings)
    speak()
    eventually(lambda: len(readings) > count + 1, "readings go on")
    assert (starts, stops) == ([1], []) and polling.report().level is Level.OK
    runs.close()
    polling.close()
    assert stops == [1]
