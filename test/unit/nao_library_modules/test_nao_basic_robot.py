"""A module and what is around it: a robot that goes away, events, memory, reports, the launch file of the robot."""

from __future__ import annotations

import threading
import weakref

import pytest
from chain_module import ChainModule, chain

from nao_library_modules.errors import RobotLost
from nao_library_modules.launcher import BadLaunchPath
from nao_library_modules.nao_basic import NaoBasic

LIMIT = 5.0


@pytest.fixture
def module(robot, edge):
    return ChainModule(robot=robot, edge=edge)


def test_a_robot_that_goes_away_ends_a_goal_that_only_waits(module, robot, edge):
    thread = module.server.play_in_background(chain(("say", "one"), time=60.0))
    assert edge.clock.waiting.wait(LIMIT)
    robot.connection.become("lost", "no heartbeat")
    thread.join(LIMIT)
    assert module.server.end == "aborted"
    assert module.server.text == "function 1 (say): the robot at 10.0.0.7:9559 went away: no heartbeat"
    robot.connection.become("connected")
    assert module.server.play(chain(("say", "two"))).end == "succeeded"


@pytest.mark.parametrize("noticed", ["by the call", "by the connection"])
def test_the_function_that_a_robot_left_is_told_whoever_notices_first(module, robot, noticed):
    def leave():
        if noticed == "by the connection":
            robot.connection.become("lost", "no heartbeat")
            module.interrupt.wait(LIMIT)
        raise RobotLost(robot.address, "no heartbeat")

    module.function_table["leave"] = leave
    run = module.server.play(chain(("say", "one"), ("leave", ""), ("say", "two")))
    assert run.end == "aborted"
    text = "the robot at 10.0.0.7:9559 went away: no heartbeat"
    assert run.text == f"function 2 (leave): {text}"
    assert [(done.function, done.error) for done in run.result.results] == [("say", ""), ("leave", text)]


class Text(str):
    """A text that can be watched."""


# Not "crash": the log of the test keeps what is logged with its trace.
@pytest.mark.parametrize("function", ["fail", "sya", "last"])
def test_nothing_of_a_goal_is_kept_when_it_has_failed(module, function, no_ring_collector):
    """Goals may hold megabytes, and thousands of them may fail before Python looks for rings of objects."""
    text = Text("x")
    kept = weakref.ref(text)
    goal = chain((function, text))
    del text
    if function == "last":
        threading.Thread(target=lambda: module.started.wait(LIMIT) and module.server.preempt()).start()
    ends = {"last": "preempted"}
    assert module.server.play(goal).end == ends.get(function, "aborted")
    module.server.result = None
    del goal
    assert kept() is None


def test_events_are_subscribed_again_after_a_reconnection(module, robot, edge):
    module.server.play(chain(("subscribeToEvent", "A")))
    robot.connection.become("connected")  # the first connection
    robot.connection.become("lost", "gone")
    robot.memory.signals.clear()
    renewed = threading.Event()
    module.events.renew = lambda renew=module.events.renew: (renew(), renewed.set())
    robot.connection.become("connected")
    assert renewed.wait(LIMIT)
    robot.memory.signals["A"](1)
    assert edge.events == [("A", 1)]


def test_autostart_needs_a_launch_file(robot, edge):
    with pytest.raises(BadLaunchPath):
        NaoBasic("10.0.0.7", 9559, autostart=True, launchpath=("nao_library", "no.launch"), robot=robot, edge=edge)


def test_reports_are_there_for_the_diagnostics(module, edge):
    module.server.play(chain(("sya", "")))
    reports = {name: report() for name, report in edge.reports.items()}
    assert reports["Module robot"].message == "connected"
    assert reports["Module goals"].values["aborted"] == "1"


class FakeSupervisor:
    def __init__(self, *arguments):
        self.arguments = arguments
        self.done = []

    def start(self):
        self.done.append("start")

    def stop(self):
        self.done.append("stop")


def test_autostart_starts_the_launch_file_for_the_robot_and_the_end_of_the_node_stops_it(robot, edge, monkeypatch):
    monkeypatch.setattr("nao_library_modules.nao_basic.launch_supervisor", FakeSupervisor)
    path = ("nao_library", "nao.launch")
    module = NaoBasic("10.0.0.7", 9560, autostart=True, launchpath=path, robot=robot, edge=edge)
    supervisor = module._launch
    assert supervisor.arguments == (path, "10.0.0.7", 9560, "/robot1/")
    assert supervisor.done == ["start"]
    for action in edge.shutdown_actions:
        action()
    assert supervisor.done == ["start", "stop"]


def test_without_autostart_the_launch_file_is_left_alone_until_asked_for(robot, edge, monkeypatch):
    monkeypatch.setattr("nao_library_modules.nao_basic.launch_supervisor", FakeSupervisor)
    module = NaoBasic("10.0.0.7", 9559, launchpath=("nao_library", "nao.launch"), robot=robot, edge=edge)
    module.stop_launch()
    assert module._launch is None
    module.start_launch()
    module.stop_launch()
    assert module._launch.done == ["start", "stop"]
