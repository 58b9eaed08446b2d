"""A module of the robot looks while it is switched on: once, after a lost robot, and not when the node has ended."""

from __future__ import annotations

import fake_sound
import pytest

from nao_library_modules.driver import demand
from nao_library_modules.driver.vision_detection import FACES, MOVEMENT, Detection
from nao_library_modules.health import Level
from naoqi.errors import NaoError, RobotError, RobotUnreachable

NAME = "ros_nao_vision"


class Extractor:
    """A vision module."""

    def __init__(self):
        self.subscribers = []
        self.calls = []
        self.refuses = False

    def subscribe(self, name):
        if self.refuses:
            raise RobotError("module", "subscribe", "no camera")
        self.calls.append("subscribe")
        self.subscribers.append(name)

    def unsubscribe(self, name):
        self.calls.append("unsubscribe")
        self.subscribers.remove(name)

    def learnFace(self, name):
        return name == "ada"


class Memory(fake_sound.Memory):
    def getData(self, name):
        if name not in self.values:
            raise RobotError("ALMemory", "getData", f"no data {name}")
        return self.values[name]


@pytest.fixture
def faces():
    return Extractor()


@pytest.fixture
def movement():
    return Extractor()


@pytest.fixture
def memory():
    return Memory()


@pytest.fixture
def robot(make_call, faces, movement, memory):
    return fake_sound.Robot(make_call, ALFaceDetection=faces, ALMovementDetection=movement, ALMemory=memory)


@pytest.fixture
def seen():
    return []


@pytest.fixture
def make(robot, seen, monkeypatch):
    monkeypatch.setattr(demand, "RETRY", 0.01)
    monkeypatch.setattr(demand, "FIRST_RETRY", 0.01)
    made = []

    def make(kind, **options):
        made.append(Detection(robot, kind, NAME, seen.append, **options))
        return made[-1]

    yield make
    for detection in made:
        detection.close()


def test_events_come_while_it_is_on(make, faces, memory, seen):
    detection = make(FACES)
    memory.raise_event("FaceDetected", ["before"])
    detection.enable()
    memory.raise_event("FaceDetected", ["while"])
    detection.disable()
    memory.raise_event("FaceDetected", ["after"])
    assert seen == [["while"]] and faces.calls == ["subscribe", "unsubscribe"]


def test_switching_on_or_off_twice_changes_nothing(make, faces, memory, seen):
    detection = make(FACES)
    detection.disable()
    for _ in range(2):
        detection.enable()
    memory.raise_event("FaceDetected", ["a face"])
    assert (seen, faces.subscribers) == ([["a face"]], [NAME])
    for _ in range(2):
        detection.disable()
    assert faces.calls == ["subscribe", "unsubscribe"]


def test_an_event_without_a_value_is_read_from_the_memory(make, memory, seen):
    memory.values[MOVEMENT.key] = [[1, 0], ["cluster"]]
    make(MOVEMENT).enable()
    memory.raise_event(MOVEMENT.event, None)
    assert seen == [[[1, 0], ["cluster"]]]
    memory.raise_event(MOVEMENT.event, [[2, 0], ["other"]])
    assert seen[1:] == [[[2, 0], ["other"]]]
    del memory.values[MOVEMENT.key]
    memory.raise_event(MOVEMENT.event, None)
    assert len(seen) == 2


def test_a_lost_robot_looks_again_when_it_comes_back(make, robot, faces, memory, seen, eventually):
    prepared = []
    detection = make(FACES, prepare=lambda: prepared.append(list(faces.calls)))
    detection.enable()
    robot.lose()
    assert detection.report().level is Level.ERROR
    faces.subscribers.clear()
    memory.signals.clear()
    robot.come_back()
    eventually(lambda: faces.subscribers == [NAME])
    eventually(lambda: detection.report().message == "on")
    memory.raise_event("FaceDetected", ["again"])
    assert seen == [["again"]]
    assert prepared == [[], ["subscribe"]]


def test_without_a_robot_it_is_not_switched_on(make, robot, faces, eventually):
    detection = make(FACES)
    robot.lose()
    with pytest.raises(RobotUnreachable):
        detection.enable()
    robot.come_back()
    assert detection.report().message == "off"
    detection.enable()
    assert faces.subscribers == [NAME]


def test_a_module_that_refuses_leaves_nothing_behind(make, faces, memory, seen):
    faces.refuses = True
    detection = make(FACES)
    with pytest.raises(NaoError, match="no camera"):
        detection.enable()
    memory.raise_event("FaceDetected", ["a face"])
    assert seen == [] and detection.report().message == "off"


def test_the_end_of_the_node_switches_off(make, faces):
    detection = make(FACES)
    detection.enable()
    detection.close()
    assert faces.subscribers == []


def test_methods_of_the_module_are_called(make):
    assert make(FACES).call("learnFace", "ada") is True
