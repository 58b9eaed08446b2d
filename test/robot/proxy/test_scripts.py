"""Whole programs, run as a user runs them: as the maker's SDK has them, and to a clean end."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

SOURCES = Path(__file__).parents[3] / "nao_library_modules" / "src"
ENVIRONMENT = {**os.environ, "PYTHONPATH": str(SOURCES)}

SDK_STYLE = """
import sys
import time
from naoqi import *

memory = None

class HumanGreeter(ALModule):
    def __init__(self, name):
        ALModule.__init__(self, name)
        self.tts = ALProxy("ALTest")
        global memory
        memory = ALProxy("ALMemory")
        memory.subscribeToEvent("FaceDetected", "Greeter", "onFaceDetected")

    def onFaceDetected(self, *_args):
        memory.unsubscribeToEvent("FaceDetected", "Greeter")
        print("hello", self.tts.add("you", "!"), _args[1])
        memory.subscribeToEvent("FaceDetected", "Greeter", "onFaceDetected")

def main(ip, port):
    myBroker = ALBroker("myBroker", "0.0.0.0", 0, ip, port)
    global Greeter
    Greeter = HumanGreeter("Greeter")
    for number in range(2):
        memory.raiseEvent("FaceDetected", number)
    task = ALProxy("ALTest", ip, port).post.add(1, 2)
    ALProxy("ALTest").wait(task, 0)
    try:
        raise KeyboardInterrupt
    except KeyboardInterrupt:
        myBroker.shutdown()
        sys.exit(0)

main("127.0.0.1", int(sys.argv[1]))
"""

USE_AND_LEAVE = """
import contextlib
import sys
import threading
from naoqi import ALBroker, ALModule, ALProxy

def wait_in_background():
    with contextlib.suppress(RuntimeError):
        test.begin()

class Buttons(ALModule):
    def on_touch(self, key, value, message):
        pass

test = ALProxy("ALTest", "127.0.0.1", int(sys.argv[1]))
test.add(1, 2)
{last}
"""

LAST_WISHES = """
import atexit
import sys
from naoqi import ALProxy

class Robot:
    def __init__(self):
        self.test = ALProxy("ALTest", "127.0.0.1", int(sys.argv[1]))

    def __del__(self):
        print("__del__", self.test.add(1, 2))

class App:
    def __init__(self):
        self.robot = Robot()

app, robot = App(), Robot()
atexit.register(lambda: print("atexit", robot.test.add(3, 4)))
"""


def run(script, robot, **options):
    command = [sys.executable, "-c", script, str(robot.port)]
    return subprocess.run(command, env=ENVIRONMENT, capture_output=True, text=True, timeout=60, check=False, **options)


def test_a_program_of_the_sdk_runs_with_python_3_syntax_only(robot):
    result = run(SDK_STYLE, robot)
    assert result.stdout == "hello you! 0\nhello you! 1\n"
    assert (result.returncode, result.stderr) == (0, "")


def test_what_a_program_sends_at_its_end_is_heard(robot):
    result = run(LAST_WISHES, robot)
    assert result.stdout == "atexit 7\n__del__ 3\n__del__ 3\n" and (result.returncode, result.stderr) == (0, "")


@pytest.mark.parametrize(
    "last",
    [
        "broker = ALBroker('b', '', 0, '127.0.0.1', int(sys.argv[1])); buttons = Buttons('LeavingButtons')",
        "threading.Thread(target=wait_in_background, daemon=True).start()",
        "[test.post.begin() for _ in range(20)]",
    ],
)
def test_a_program_ends_quietly_whatever_is_still_open(robot, last):
    result = run(USE_AND_LEAVE.format(last=last), robot)  # libqi, too, says nothing
    assert (result.returncode, result.stderr) == (0, "")
