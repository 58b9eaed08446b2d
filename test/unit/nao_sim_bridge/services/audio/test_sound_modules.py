"""ALSoundDetection, ALSoundLocalization and ALAudioSourceLocalization over the network, with sounds in the world."""

from __future__ import annotations

import math

import numpy as np
import pytest

from nao_sim_bridge.sim.sound.samples import RATE, Sound
from nao_sim_bridge.sim.sound.sources import SoundSource

LOCATED, ALL_LOCATED = "ALSoundLocalization/SoundLocated", "ALSoundLocalization/SoundsLocated"
DETECTED = "SoundDetected"
MODULES = ["ALSoundDetection", "ALSoundLocalization", "ALAudioSourceLocalization"]


class Room:
    """The robot, sounds around it, and the events that it raises."""

    def __init__(self, robot):
        self.robot = robot
        self.sound = robot.server.simulation.sound
        self.chance = np.random.default_rng(2)

    def place(self, bearing, seconds=0.6, distance=1.5, height=0.5, level_db=65.0):
        """A burst of noise at a bearing in degrees, to the left of where the robot looks at its start."""
        angle = math.radians(bearing)
        noise = Sound(self.chance.standard_normal(round(seconds * RATE)).astype(np.float32) * 0.1)
        place = (distance * math.cos(angle), distance * math.sin(angle), height)
        source = SoundSource("noise", place, noise, level_db)
        self.robot.server.runner.call(lambda: self.sound.sources.add(source))

    def advance(self, seconds):
        self.robot.advance(seconds)
        self.sound.ears.catch_up()

    def events(self, name, since):
        """Values of an event that was raised after a simulated time."""
        return [value for value, time in self.robot.server.memory.history(name) if time > since]


@pytest.fixture
def room(stiff_robot):
    room = Room(stiff_robot)
    for module in MODULES:
        stiff_robot.post(module, "subscribe", "Test").value()
    yield room
    for module in MODULES:
        getattr(stiff_robot, module).pause(False)
        stiff_robot.post(module, "unsubscribe", "Test").value()


@pytest.mark.parametrize("bearing", [0, 45, 100, 170, -20, -90, -140])
def test_a_sound_is_located(room, bearing):
    room.advance(0.3)
    begun = room.robot.now.time
    room.place(bearing)
    room.advance(1.0)
    located = room.events(LOCATED, begun)
    assert 3 <= len(located) <= 5
    assert room.events(ALL_LOCATED, begun) == [[sound] for sound in located]
    for (seconds, micros), (azimuth, _, confidence, energy), _, _ in located:
        assert begun - 0.2 < seconds + 1e-6 * micros < begun + 0.7
        assert (math.degrees(azimuth) - bearing + 180) % 360 - 180 == pytest.approx(0.0, abs=10.0)
        assert 0.5 < confidence <= 1.0
        assert energy == 0.0


def test_the_older_module_says_the_same(room):
    begun = room.robot.now.time
    room.place(-40)
    room.advance(0.8)
    assert room.events("ALAudioSourceLocalization/SoundLocated", begun) == room.events(LOCATED, begun)


def test_angles_are_in_the_frame_of_the_head_wherever_it_looks(room):
    room.robot.finish("ALMotion", "setAngles", ["HeadYaw", "HeadPitch"], [0.8, 0.1], 0.5, after=1.5)
    begun = room.robot.now.time
    room.place(60)
    room.advance(0.8)
    (_, (azimuth, elevation, _, _), in_torso, in_robot) = room.events(LOCATED, begun)[-1]
    head = room.robot.ALMotion.getPosition("Head", 0, True)
    assert in_torso == pytest.approx(head, abs=1e-3)
    assert in_robot == pytest.approx(room.robot.ALMotion.getPosition("Head", 2, True), abs=2e-3)
    assert math.degrees(azimuth + head[5]) == pytest.approx(60.0, abs=6.0)


def test_energy_is_there_when_it_is_asked_for(room):
    room.robot.ALSoundLocalization.setParameter("EnergyComputation", True)
    energies = []
    for level in (60.0, 66.0):
        begun = room.robot.now.time
        room.place(20, level_db=level)
        room.advance(1.0)
        energies.append(room.events(LOCATED, begun)[1][1][3])
    room.robot.ALSoundLocalization.setParameter("EnergyComputation", False)
    assert energies[1] == pytest.approx(2.0 * energies[0], rel=0.1)


def test_the_own_voice_is_detected_and_not_located(room):
    room.advance(0.3)
    begun = room.robot.now.time
    noise = Sound(room.chance.standard_normal(RATE // 2).astype(np.float32) * 0.1)
    room.robot.server.runner.call(lambda: room.sound.loudspeakers.play(noise, "own voice"))
    room.advance(1.0)
    assert room.events(LOCATED, begun) == []
    assert [edge[1] for edges in room.events(DETECTED, begun) for edge in edges] == [1, 0]


def test_a_sound_is_detected_when_it_begins_and_ends(room):
    room.advance(1.0)
    begun = room.robot.now.time
    room.place(0, seconds=0.5)
    room.advance(1.5)
    start, end = [edge for edges in room.events(DETECTED, begun) for edge in edges]
    assert (start[1], end[1]) == (1, 0)
    travel = 1.5 / 343.0
    assert 1e-6 * start[3] == pytest.approx(begun + travel, abs=0.03)
    assert 1e-6 * end[3] == pytest.approx(begun + 0.5 + travel, abs=0.05)
    assert 0 <= start[0] < 8160 and 0.5 <= start[2] <= 1.0


def test_a_quiet_room_is_no_event(room):
    room.advance(0.5)
    begun = room.robot.now.time
    room.advance(10.0)
    assert room.events(DETECTED, begun) == []
    assert room.events(LOCATED, begun) == []


@pytest.mark.parametrize("module", MODULES)
def test_a_paused_module_hears_nothing(room, module):
    service = getattr(room.robot, module)
    event = DETECTED if module == "ALSoundDetection" else f"{module}/SoundLocated"
    assert (service.isPaused(), service.isProcessing()) == (False, True)
    service.pause(True)
    assert (service.isPaused(), service.isProcessing()) == (True, False)
    begun = room.robot.now.time
    room.place(0)
    room.advance(1.0)
    assert room.events(event, begun) == []
    service.pause(False)
    room.advance(0.3)
    room.place(0)
    room.advance(1.0)
    assert room.events(event, begun) != []


@pytest.mark.parametrize("module", MODULES)
def test_sensitivity_counts(room, module):
    service = getattr(room.robot, module)
    event = DETECTED if module == "ALSoundDetection" else f"{module}/SoundLocated"
    room.advance(0.5)
    for name, sensitivity, heard in (("Sensitivity", 0.1, False), ("Sensibility", 0.9, True)):
        service.setParameter(name, sensitivity)
        begun = room.robot.now.time
        room.place(0, level_db=50.0)
        room.advance(1.2)
        assert bool(room.events(event, begun)) is heard


@pytest.mark.parametrize("module", MODULES)
@pytest.mark.parametrize(
    "name, value, message",
    [
        ("Volume", 1.0, "unknown parameter 'Volume'; there are Sensitivity, Sensibility"),
        ("Sensitivity", 1.5, "Sensitivity is 1.5, allowed is 0 to 1"),
        ("Sensitivity", "high", "Sensitivity is 'high', allowed is a finite number"),
    ],
)
def test_wrong_parameters_are_refused(robot, module, name, value, message):
    with pytest.raises(RuntimeError, match=f"{module}::setParameter {message}"):
        getattr(robot, module).setParameter(name, value)


def test_energy_computation_is_a_switch(robot):
    with pytest.raises(RuntimeError, match="EnergyComputation is 'loud', allowed is true or false"):
        robot.ALSoundLocalization.setParameter("EnergyComputation", "loud")


@pytest.mark.parametrize("module", MODULES)
def test_events_are_known(robot, module):
    events = [DETECTED] if module == "ALSoundDetection" else [f"{module}/SoundLocated", f"{module}/SoundsLocated"]
    assert getattr(robot, module).getEventList() == events
    assert robot.ALMemory.getExtractorEvent(module) == events


def test_the_ears_are_closed_when_nobody_is_subscribed(robot):
    sound = robot.server.simulation.sound
    assert sound.ears.listening is False
    robot.post("ALSoundDetection", "subscribe", "Somebody", 100, 0.5).value()
    assert sound.ears.listening is True
    assert robot.ALSoundDetection.getSubscribersInfo() == [["Somebody", 100, 0.5]]
    robot.ALSoundDetection.unsubscribe("Somebody")
    assert sound.ears.listening is False
