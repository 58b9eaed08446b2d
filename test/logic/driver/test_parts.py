"""The driver in one process: which parts there are, and what becomes of one that cannot be started."""

from __future__ import annotations

import queue
import threading
from types import SimpleNamespace

import pytest

from nao_library_modules.core.health import Level, Report
from nao_library_modules.driver import nao_driver
from nao_library_modules.driver.joints import nao_joint_states
from nao_library_modules.driver.nao_driver import PARTS, Driver, DriverPart, chosen, part_class
from nao_library_modules.driver.sensors import nao_sonar, nao_tactile
from nao_library_modules.driver.walk import naoqi_moveto
from naoqi.errors import NaoError


def test_parts_are_chosen_by_their_words_in_the_order_of_the_table():
    assert chosen("all") == list(PARTS) == chosen(["all"])
    assert chosen("walker joint_states") == ["joint_states", "walker"]
    for words, text in (("", "~parts is empty"), ("wlaker", "part 'wlaker' not found: did you mean 'walker'")):
        with pytest.raises(NaoError, match=text):
            chosen(words)


@pytest.mark.parametrize("word", PARTS)
def test_every_part_has_its_class(word):
    assert {"reports", "close"} <= set(dir(part_class(word)))


class Good:
    def __init__(self, robot, node):
        self.closed = False
        self.node = node

    def reports(self):
        return {"well": lambda: Report(Level.OK, "it runs")}

    def close(self):
        self.closed = True


class Names:
    """Keeps the names that were registered."""

    def __init__(self):
        self.registered = []

    def add(self, name, offered):
        self.registered.append(name)

    def close(self):
        self.registered.clear()


@pytest.fixture
def parts(monkeypatch):
    """Starts parts whose classes are what the test has for them."""
    monkeypatch.setattr(nao_driver, "RETRY", 0.01)
    made = []

    def start(**classes):
        monkeypatch.setattr(nao_driver, "part_class", classes.__getitem__)
        made.append(Driver(None, list(classes), Names()))
        return made[-1]

    yield start
    for driver in made:
        driver.close()


def test_a_part_that_cannot_be_started_is_tried_again_and_told_of_while_the_others_run(parts, caplog):
    mended, tried = threading.Event(), threading.Semaphore(0)

    def broken(robot, node):
        if not mended.is_set():
            tried.release()
            raise NaoError("~cmd_vel_timeout is 'soon': 0 to 3600 s")
        return Good(robot, node)

    driver = parts(walker=broken, leds=Good)
    walker, leds = driver.parts
    assert leds.started.wait(60.0) and all(tried.acquire(timeout=60.0) for _ in range(3))
    report = walker.reports()["nao_walker: part"]()
    assert driver._names.registered == ["/nao_leds"]
    assert report.level == Level.ERROR and report.message == "~cmd_vel_timeout is 'soon': 0 to 3600 s"
    assert leds.reports()["nao_leds: well"]().message == "it runs"
    mended.set()
    assert walker.started.wait(60.0) and list(walker.reports()) == ["nao_walker: part", "nao_walker: well"]
    assert walker.reports()["nao_walker: part"]() == Report(
        Level.OK, "runs", {"failed attempts": str(walker._attempts)}
    )
    told = [record.getMessage() for record in caplog.records if "nao_walker" in record.getMessage()]
    assert told[0] == "nao_walker cannot be started: ~cmd_vel_timeout is 'soon': 0 to 3600 s" and len(told) <= 2, "once"


def test_a_part_has_names_of_its_own_and_what_a_failed_one_has_made_is_taken_back(parts):
    given_back, nodes = queue.Queue(), []

    def half_way(robot, node):
        nodes.append(node)
        node.if_it_fails(lambda: given_back.put("first"))
        node.if_it_fails(lambda: {}["no such thing"])
        node.if_it_fails(lambda: given_back.put("last"))
        raise NaoError("no")

    parts(microphone=half_way)
    assert [given_back.get(timeout=60.0) for _ in range(4)] == ["last", "first"] * 2
    node = nodes[0]
    assert node.name == "/nao_robot/microphone/naoqi_microphone"
    assert [node.resolve(name) for name in ("~audio_raw", "speech", "/other")] == [
        "/nao_robot/microphone/naoqi_microphone/audio_raw", "/nao_robot/microphone/speech", "/other",
    ]  # fmt: skip


def test_a_part_that_runs_is_closed(parts):
    driver = parts(leds=Good)
    (part,) = driver.parts
    assert part.started.wait(60.0)
    driver.close()
    assert part._made.closed


def test_a_part_that_ends_while_it_cannot_be_started_ends(monkeypatch):
    monkeypatch.setattr(nao_driver, "part_class", lambda word: {}[word])
    part = DriverPart("leds", None, Names())
    part.close()
    assert not part.started.is_set()


class FailingNode:
    """Has parameters, and cannot make some topic or name."""

    name, namespace = "/part", "/"

    def __init__(self, broken):
        self.broken, self.ends = broken, []

    def param(self, name, default=None):
        return default

    def resolve(self, name):
        return self.publisher(name)

    def publisher(self, name, *_, **__):
        if name == self.broken:
            raise NaoError(f"{name} cannot be")

    subscriber = publisher

    def offer(self, *_):
        """No caller."""

    def if_it_fails(self, action):
        self.ends.append(action)


@pytest.mark.parametrize(
    "module, reader, broken",
    [
        (nao_sonar, "Sonars", "nao_robot/sonar/right"),
        (nao_tactile, "Polling", "nao_robot/fsr/left"),
        (nao_joint_states, "Polling", "robot_state_publisher"),
        (naoqi_moveto, "MoveToWalk", "move_base_simple/goal"),
    ],
)
def test_a_part_that_fails_half_way_leaves_nothing_running(module, reader, broken, monkeypatch):
    running = []

    class Reader:
        def __init__(self, *_):
            running.append(self)

        def close(self):
            running.remove(self)

    monkeypatch.setattr(module, reader, Reader)
    for name, answer in (("tf_prefix", ""), ("frame_parameter", "base"), ("PlanarFrames", None)):  # they ask ROS
        monkeypatch.setattr(module, name, lambda *_, answer=answer, **__: answer, raising=False)
    robot = SimpleNamespace(connection=SimpleNamespace(answering_time=None))
    (word,) = (each for each in PARTS if part_class(each).__module__ == module.__name__)
    node = FailingNode(broken)
    with pytest.raises(NaoError, match=f"{broken} cannot be"):
        part_class(word)(robot, node)
    assert len(running) == 1
    for end in reversed(node.ends):
        end()
    assert not running
