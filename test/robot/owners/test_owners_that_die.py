"""What a process has set going on the robot is stopped when the process is killed; another one stops it."""

from __future__ import annotations

import json
import logging
import queue
import signal
import subprocess
import sys

import pytest
from simulator import PATIENCE

from nao_library_modules.core.process_owners import OwnerWatch, Stops
from nao_library_modules.core.robot import Robot

OWNER = """
import json, sys
from nao_library_modules.core.robot import Robot
sys.argv[0] = "owner"
robot = Robot("127.0.0.1", int(sys.argv[1]))
robot.connection.wait_connected(20)
for line in sys.stdin:
    module, method, *arguments = json.loads(line)
    call = robot.proxy(module).call_async(method, *arguments)
    robot.proxy(module).ping()
    print("called", flush=True)
"""
LATE = 1.0
"""s of the robot within which it is to stand."""


class Watched:
    """A robot with a watch, and owners that can be killed."""

    def __init__(self, robot):
        self.robot = robot
        self.address = f"127.0.0.1:{robot.port}"
        self.stopped = queue.Queue()
        self._stops = Stops(Robot(*robot.address), {})
        self._owners = []
        self.watches = [self.watch()]

    def watch(self):
        def stop(owned):
            self._stops.stop(owned)
            self.stopped.put(owned)

        return OwnerWatch(self.address, stop)

    def owner(self):
        process = subprocess.Popen(
            [sys.executable, "-c", OWNER, str(self.robot.port)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        self._owners.append(process)
        return process

    def calls(self, owner, *call):
        owner.stdin.write(json.dumps(call) + "\n")
        owner.stdin.flush()
        assert owner.stdout.readline() == "called\n"
        self.robot.settled()

    def close(self):
        for owner in self._owners:
            owner.kill()
            owner.communicate()
        for watch in self.watches:
            watch.close()


@pytest.fixture
def watched(robot):
    robot.finish("ALMotion", "wakeUp", after=3.0)
    watched = Watched(robot)
    yield watched
    watched.close()


def kill(owner):
    owner.send_signal(signal.SIGKILL)
    owner.wait(PATIENCE)


def place(robot):
    return robot.ALMotion.getRobotPosition(True)


def joints(robot):
    return robot.ALMotion.getAngles("Body", False)


def spoken(robot):
    return [float(robot.server.speech.speaker.speaking)]


GOING = {
    "a walk to a place": (("ALMotion", "moveTo", 1.0, 0.0, 0.0), "stopMove", place),
    "a walk at a speed": (("ALMotion", "moveToward", 1.0, 0.0, 0.0), "stopMove", place),
    "a trajectory": (("ALMotion", "angleInterpolation", "HeadYaw", 1.0, 8.0, True), "killTasks", joints),
    "a target": (("ALMotion", "setAngles", "Head", [1.0, 0.2], 0.02), "setAngles", joints),
    "a posture": (("ALRobotPosture", "goToPosture", "Crouch", 0.2), "stopMove", joints),
    "speech": (("ALTextToSpeech", "say", "one two three four five six seven eight nine ten"), "stopAll", spoken),
}


def goes_on(robot, what):
    """Whether something changes; of speech, whether there is any."""
    before = what(robot)
    robot.advance(0.2)
    if what is spoken:
        return bool(before[0])
    return max(abs(a - b) for a, b in zip(before, what(robot))) > 0.002


@pytest.mark.parametrize("going", GOING)
def test_what_lost_its_owner_is_stopped(watched, going):
    robot, (call, cure, what) = watched.robot, GOING[going]
    owner = watched.owner()
    watched.calls(owner, *call)
    robot.advance(2.0)
    assert goes_on(robot, what), "nothing goes on that could be stopped"
    kill(owner)
    assert cure in watched.stopped.get(timeout=PATIENCE).cure
    robot.advance(LATE)
    assert not goes_on(robot, what)


def test_another_watch_takes_over_with_what_is_owned(watched, caplog, eventually):
    caplog.set_level(logging.DEBUG, "nao_library_modules.core.process_owners")
    owner = watched.owner()
    watched.calls(owner, "ALMotion", "moveToward", 1.0, 0.0, 0.0)
    watched.watches.append(watched.watch())
    watched.watches[0].close()
    heard = "owner may own something"
    eventually(lambda: caplog.messages.count(heard) == 2, f"{heard!r} a second time")
    kill(owner)
    assert "stopMove" in watched.stopped.get(timeout=PATIENCE).cure


def test_a_call_that_has_ended_is_not_stopped_when_its_owner_dies(watched):
    owner = watched.owner()
    watched.calls(owner, "ALMotion", "angleInterpolation", "HeadYaw", 0.1, 0.5, True)
    watched.robot.advance(1.0)
    watched.calls(owner, "ALMotion", "moveToward", 1.0, 0.0, 0.0)
    kill(owner)
    assert "stopMove" in watched.stopped.get(timeout=PATIENCE).cure
    watched.robot.advance(LATE)
    assert watched.stopped.empty()
