"""`nao naoqi`: what qicli does, against the simulated robot, without a master."""

import json
import re
import threading
from contextlib import contextmanager

import pytest
import qi
from simulator import PATIENCE, connected

from nao_library_modules.cli.app import main


@pytest.fixture
def nao(robot, capsys):
    """Runs `nao naoqi ...` on the robot; its status and what it printed."""

    def run(*words):
        status = main(["naoqi", *words, "--qi-url", f"tcp://127.0.0.1:{robot.port}"])
        told = capsys.readouterr()
        return status, told.out.strip() or told.err.strip()

    return run


class Counter:
    """A service of a program."""

    def __init__(self):
        self.counted, self.step = qi.Signal("(i)"), qi.Property("i")
        self.step.setValue(2)

    @qi.bind(qi.Int32, [qi.Int32])
    def add(self, number):
        return number + self.step.value()


@pytest.fixture
def counter(robot):
    session = connected(robot.port)
    session.listen("tcp://127.0.0.1:0")
    service = Counter()
    session.registerService("Counter", service)
    yield service
    session.close()


def test_it_lists_services_and_what_one_has(nao, counter):
    status, names = nao("info")
    assert status == 0 and {"ALMotion", "ALMemory", "Counter"} <= set(names.splitlines())
    status, told = nao("info", "Counter", "--json")
    assert status == 0 and json.loads(told) == {
        "Counter": {"methods": ["add(int) -> int"], "signals": ["counted(int)"], "properties": ["step: int"]}
    }
    status, told = nao("info", "ALMotion.stepTo")
    assert status == 0 and re.search(r"stepTo\(string, float, float, float\) -> nothing: one step beside", told)


def test_it_calls_methods_and_reads_and_writes_properties(nao, robot, counter):
    assert json.loads(nao("call", "ALMotion.getBodyNames", "Head", "--json")[1]) == {"answer": ["HeadYaw", "HeadPitch"]}
    assert nao("call", "Counter.add", "5") == (0, "7")
    assert nao("call", "Counter.step", "10")[0] == 0
    assert nao("call", "Counter.step") == (0, "10") and nao("call", "Counter.add", "-5") == (0, "5")
    assert nao("call", "ALMemory.insertData", "Test/Key", "[1, 2.5]")[0] == 0
    assert robot.ALMemory.getData("Test/Key") == [1, 2.5]


def test_it_posts_calls_and_raises_and_watches_signals(nao, robot, counter):
    task = json.loads(nao("post", "ALMotion.wakeUp", "--json")[1])["task"]
    assert robot.ALMotion.isRunning(task)
    heard = threading.Event()
    link = counter.counted.connect(lambda value: heard.set())
    assert nao("post", "Counter.counted", "3")[0] == 0 and heard.wait(PATIENCE)
    counter.counted.disconnect(link)
    with raised_again_and_again(counter.counted, 4):
        assert nao("watch", "Counter.counted", "--count", "1") == (0, "Counter.counted: 4")


@contextmanager
def raised_again_and_again(signal, value):
    """Nobody tells who raises a signal that it is listened to."""
    ended = threading.Event()

    def run():
        while not ended.wait(0.05):
            signal(value)

    thread = threading.Thread(target=run)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()


@pytest.mark.parametrize(
    "words, said",
    [
        ("info ALMotoin", "there is no service ALMotoin: did you mean 'ALMotion'"),
        ("info ALMotion.stepto", "ALMotion has no stepto: did you mean 'stepTo'"),
        ("call getAngles", "MEMBER is 'getAngles', allowed is SERVICE.NAME"),
        ("call ALMotion.getAngels Head true", "getAngels"),
        ("watch ALMotion.getAngles", "ALMotion has no signal and no property getAngles"),
        ("post Counter.step 5", "Counter.step is a property, which nao naoqi call Counter.step VALUE sets"),
        (
            "post Counter.add 5",
            "Counter cannot post calls, it has no pCall: nao naoqi call Counter.add calls and waits",
        ),
    ],
)
def test_what_cannot_be_is_told(nao, counter, words, said):
    status, told = nao(*words.split())
    assert status in (1, 2) and said in told
