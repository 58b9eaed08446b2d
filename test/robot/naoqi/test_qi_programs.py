"""Programs that use the package qi as the robot maker's Python SDK teaches it, with the simulator as their robot."""

import signal
import subprocess
import sys
import threading
from pathlib import Path

import pytest
import qi
from simulator import PATIENCE, connected

PROGRAM = Path(__file__).parents[2] / "scripts" / "qi_program.py"
MS = int(PATIENCE * 1000)


@pytest.fixture
def program(robot):
    """Connects a program that others can call."""
    sessions = []

    def make():
        session = connected(robot.port)
        session.listen("tcp://127.0.0.1:0")
        sessions.append(session)
        return session

    yield make
    for session in sessions:
        session.close()


def test_an_application_with_a_service_a_periodic_task_and_an_async_call_runs_to_its_end(robot):
    command = [sys.executable, str(PROGRAM), "--qi-url", f"tcp://127.0.0.1:{robot.port}"]
    ended = subprocess.run(command, capture_output=True, text=True, timeout=60)
    assert ended.stdout.strip() == "3 True ['HeadYaw', 'HeadPitch']", ended.stderr
    # libqi itself may crash while the interpreter ends.
    assert ended.returncode in (0, -signal.SIGSEGV, -signal.SIGABRT), ended.stderr


class Greeter:
    """A service with a method, a signal and a property."""

    def __init__(self):
        self.greeted, self.mood = qi.Signal("(s)"), qi.Property("s")
        self.mood.setValue("fine")

    @qi.bind(qi.String, [qi.String])
    def greet(self, name):
        self.greeted(name)
        return f"Hello {name}"


def test_a_service_of_one_program_is_called_and_heard_by_another(program):
    program().registerService("Greeter", Greeter())
    greeter, heard, moods = program().service("Greeter"), qi.Promise(), qi.Promise()
    greeter.greeted.connect(heard.setValue)
    greeter.mood.connect(moods.setValue)
    assert greeter.greet("Nao", _async=True).value(MS) == "Hello Nao" and heard.future().value(MS) == "Nao"
    assert greeter.mood.value() == "fine"
    greeter.mood.setValue("tired")
    assert (greeter.mood.value(), moods.future().value(MS)) == ("tired", "tired")


class Door:
    """Who enters waits until somebody opens."""

    def __init__(self):
        self.opened, self.entered = threading.Event(), threading.Event()

    def enter(self):
        self.entered.set()
        return self.opened.wait(PATIENCE)

    def open(self):
        self.opened.set()


def test_a_multi_threaded_service_is_called_again_before_it_has_answered(program):
    door = qi.multiThreaded()(Door)()
    program().registerService("Door", door)
    remote = program().service("Door")
    entering = remote.enter(_async=True)
    assert door.entered.wait(PATIENCE) and entering.isRunning()
    remote.open()
    assert entering.value(MS) is True


def test_a_single_threaded_service_takes_one_call_at_a_time(program):
    door = qi.singleThreaded()(Door)()
    program().registerService("Door", door)
    remote = program().service("Door")
    entering = remote.enter(_async=True)
    assert door.entered.wait(PATIENCE)
    opening = remote.open(_async=True)
    assert remote.metaObject() and opening.isRunning() and not door.opened.is_set()
    door.opened.set()
    assert entering.value(MS) is True and opening.hasValue(MS)


def test_futures_of_the_robot_follow_each_other_and_are_awaited_together(robot, program):
    session = program()
    motion, memory = session.service("ALMotion"), session.service("ALMemory")
    names = motion.getBodyNames("Head", _async=True).then(lambda future: future.value()[::-1])
    written = memory.insertData("Test/Head", 1, _async=True).andThen(lambda _: memory.getData("Test/Head"))
    assert [future.value() for future in qi.futureBarrier([names, written]).value(MS)] == [["HeadPitch", "HeadYaw"], 1]


def test_an_event_of_the_robot_comes_by_the_signal_of_its_subscriber(robot, program):
    memory, heard = program().service("ALMemory"), qi.Promise()
    subscriber = memory.subscriber("FrontTactilTouched")
    subscriber.signal.connect(lambda value: heard.setValue(value) if value else None)
    robot.NaoSimulation.press(["Head/Touch/Front"])
    robot.advance(0.1)
    assert heard.future().value(MS) == 1.0


def test_a_program_has_a_directory_of_its_own_beside_the_robot(robot):
    alone = qi.Session()
    alone.listenStandalone("tcp://127.0.0.1:0")
    alone.registerService("Greeter", Greeter())
    client = qi.Session()
    client.connect(alone.endpoints()[0])
    assert client.service("Greeter").greet("you") == "Hello you"
    assert "ALMotion" not in {each["name"] for each in client.services()}
    assert "Greeter" not in {each["name"] for each in connected(robot.port).services()}
    client.close()
    alone.close()
