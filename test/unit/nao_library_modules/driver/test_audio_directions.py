"""Directions of sounds while somebody wants to know, on old and new robots."""

from __future__ import annotations

import fake_sound
import pytest

from nao_library_modules.driver import demand
from nao_library_modules.driver.audio_directions import SoundDirections, read_direction

EVENT = [[12, 500000], [0.5, -0.1, 0.9, 0.04], [0.0, 0.0, 0.1265, 0.0, 0.1, 0.2], [0.0] * 6]


class Localisation:
    def __init__(self):
        self.parameters = {}
        self.subscribers = []

    def setParameter(self, name, value):
        self.parameters[name] = value

    def subscribe(self, name):
        self.subscribers.append(name)

    def unsubscribe(self, name):
        self.subscribers.remove(name)


@pytest.fixture(params=["ALSoundLocalization", "ALAudioSourceLocalization"])
def module(request):
    return request.param


@pytest.fixture
def robot(make_call, module, monkeypatch):
    monkeypatch.setattr(demand, "RETRY", 0.01)
    monkeypatch.setattr(demand, "FIRST_RETRY", 0.01)
    return fake_sound.Robot(make_call, **{module: Localisation(), "ALMemory": fake_sound.Memory()})


@pytest.fixture
def found():
    return []


@pytest.fixture
def directions(robot, found):
    directions = SoundDirections(robot, "ros_nao_audio", 0.8, found.append)
    yield directions
    directions.close()


def test_sounds_are_located_only_while_somebody_listens(directions, robot, module, found, eventually):
    service, memory = robot.services[module], robot.services["ALMemory"]
    memory.raise_event(f"{module}/SoundLocated", EVENT)
    assert service.subscribers == [] and found == []
    directions.want(True)
    eventually(lambda: directions.report().message == "sounds are located")
    assert service.subscribers == ["ros_nao_audio"]
    assert service.parameters == {"EnergyComputation": True, "Sensitivity": 0.8}
    memory.raise_event(f"{module}/SoundLocated", EVENT)
    directions.want(False)
    eventually(lambda: service.subscribers == [])
    memory.raise_event(f"{module}/SoundLocated", EVENT)
    assert [each.azimuth for each in found] == [0.5]


def test_it_goes_on_after_a_loss_without_hearing_twice(directions, robot, module, found, eventually):
    service, memory = robot.services[module], robot.services["ALMemory"]
    directions.want(True)
    eventually(lambda: service.subscribers == ["ros_nao_audio"])
    robot.lose()
    service.subscribers.clear()
    robot.come_back()
    eventually(lambda: service.subscribers == ["ros_nao_audio"])
    memory.raise_event(f"{module}/SoundLocated", EVENT)
    assert len(found) == 1


def test_a_robot_that_cannot_is_told(make_call, monkeypatch, eventually):
    monkeypatch.setattr(demand, "RETRY", 0.01)
    monkeypatch.setattr(demand, "FIRST_RETRY", 0.01)
    robot = fake_sound.Robot(make_call, ALMemory=fake_sound.Memory())
    directions = SoundDirections(robot, "ros_nao_audio", -1.0, lambda direction: None)
    directions.want(True)
    eventually(lambda: "no module 'ALSoundLocalization'" in directions.report().message)
    directions.close()


def test_an_event_is_read():
    direction = read_direction(EVENT)
    assert direction.time == pytest.approx(12.5)
    assert (direction.azimuth, direction.elevation, direction.confidence, direction.energy) == (0.5, -0.1, 0.9, 0.04)
    assert direction.head_in_torso == (0.0, 0.0, 0.1265, 0.0, 0.1, 0.2)


@pytest.mark.parametrize("value", [None, [], [[1, 2], [], [0.0] * 6], [[1, 2], [0.1, 0.2, 0.3], [0.0]]])
def test_what_is_no_direction_is_left_out(value):
    assert read_direction(value) is None
