"""Sounds and persons in the world, and the modules that hear them: detection, localisation, speech recognition."""

from __future__ import annotations

import math

import numpy as np
import pytest
from sounds import RATE, frequency, noise, put, until
from spoken_words import RATE as SPEECH_RATE
from spoken_words import spoken

from nao_sim_bridge.base.samples import Sound

LOCATED, ALL_LOCATED = "ALSoundLocalization/SoundLocated", "ALSoundLocalization/SoundsLocated"
OLD_LOCATED, DETECTED = "ALAudioSourceLocalization/SoundLocated", "SoundDetected"
EXTRACTORS = {
    "ALSoundDetection": [DETECTED],
    "ALSoundLocalization": [LOCATED, ALL_LOCATED],
    "ALAudioSourceLocalization": [OLD_LOCATED, "ALAudioSourceLocalization/SoundsLocated"],
}
GRAMMAR = """#BNF+EM V2.1;
!grammar house;
!start <order>;
!activatable <polite>;
!slot <thing>;
<order>: turn off the <thing> [<polite>];
<polite>: please;
"""
HERE, THERE = [1.0, 0.0, 0.5], [0.0, 2.0, 0.5]


def level(robot, seconds=0.2):
    """Level at the microphones in the last `seconds`, dB SPL."""
    end = robot.now.time - 0.01
    heard = robot.server.simulation.sound.microphones.heard(end - seconds, end)
    return 20.0 * np.log10(np.sqrt(2.0 * np.mean(heard.astype(float) ** 2))) + 104.0


def test_a_noise_is_placed_moved_and_removed_and_a_tone_has_its_frequency(robot):
    simulation = robot.NaoSimulation
    simulation.addSound("n", "noise:pink", HERE, 70.0, False)
    assert simulation.sounds() == {"n": pytest.approx(HERE)}
    simulation.advance(0.5)
    assert level(robot) == pytest.approx(70.0, abs=1.5)
    simulation.moveSound("n", THERE)
    assert simulation.sounds() == {"n": pytest.approx(THERE)}
    simulation.advance(0.5)
    assert level(robot) == pytest.approx(64.0, abs=1.5)
    simulation.removeSound("n")
    assert simulation.sounds() == {}
    simulation.advance(0.5)
    assert level(robot) == pytest.approx(30.0, abs=1.5)
    simulation.addSound("t", "tone:440", HERE, 65.0, False)
    simulation.advance(0.6)
    heard = robot.server.simulation.sound.microphones.heard(robot.now.time - 0.51, robot.now.time - 0.01)
    assert frequency(heard[:, 0]) == pytest.approx(440.0, abs=2.0)
    simulation.reset()
    assert simulation.sounds() == {}


def test_persons_speak_at_once_and_each_call_ends_when_it_is_said(robot):
    first = robot.post("NaoSimulation", "personSays", "Good morning.", HERE, "slt", 0.0)
    begun, loudest = robot.now.time, []
    robot.advance_until(robot.NaoSimulation.sounds, 5.0, step=0.01)
    while first.isRunning():
        assert len(robot.NaoSimulation.sounds()) <= 1
        robot.advance(0.12)
        loudest.append(level(robot, 0.1))
    robot.answer(first)
    assert 0.6 < robot.now.time - begun < 2.0 and max(loudest) == pytest.approx(65.0, abs=5.0)
    assert robot.NaoSimulation.sounds() == {}
    futures = [robot.post("NaoSimulation", "personSays", "I could go on for ever.", p, "", 60.0) for p in (HERE, THERE)]
    robot.advance(0.2)
    assert sorted(robot.NaoSimulation.sounds().values()) == [pytest.approx(THERE), pytest.approx(HERE)]
    futures[0].cancel()
    robot.settled()
    robot.advance(0.1)
    assert list(robot.NaoSimulation.sounds().values()) == [pytest.approx(THERE)]
    until(robot, futures[1])


def test_what_cannot_sound_is_refused(robot, refused):
    robot.NaoSimulation.addSound("n", "noise:white", HERE, 60.0, True)
    rows = [
        ("m", "noise:blue", HERE, 60.0, "addSound sound is 'noise:blue', allowed is noise:white or noise:pink"),
        ("m", "tone:-1", HERE, 60.0, "frequency is -1.0, allowed is 1 to 20000"),
        ("m", "none.wav", HERE, 60.0, "no file 'none.wav'"),
        ("m", "noise:white", [1.0, 2.0], 60.0, "allowed is .x, y, z. in m, in world"),
        ("m", "noise:white", HERE, 600.0, "level_db is 600.0, allowed is -20 to 140"),
        ("n", "noise:white", HERE, 60.0, "addSound name is 'n'"),
    ]
    refused("NaoSimulation", [("addSound", (*row[:4], False), row[4]) for row in rows])
    others = [
        ("moveSound", ("m", HERE), "unknown sound source 'm'"),
        ("removeSound", ("m",), "unknown sound source 'm'"),
        ("personSays", ("  ", HERE, "", 0.0), "text is '  '"),
        ("personSays", ("Hi", HERE, "bob", 0.0), "voice is 'bob', allowed is"),
    ]
    refused("NaoSimulation", others)
    assert list(robot.NaoSimulation.sounds()) == ["n"]


class Room:
    """The robot, sounds around it, and the events that it raises."""

    def __init__(self, robot):
        self.robot = robot
        self.ears = robot.server.simulation.sound.ears

    def burst(self, bearing, seconds=0.6, level_db=65.0, then=1.0):
        """Noise at a bearing in degrees to the left, 1.5 m away; returns its begin when `then` s have passed."""
        begun, angle = self.robot.now.time, math.radians(bearing)
        put(self.robot, (1.5 * math.cos(angle), 1.5 * math.sin(angle), 0.5), noise(seconds), level_db)
        self.advance(then)
        return begun

    def advance(self, seconds):
        self.robot.advance(seconds)
        self.ears.catch_up()

    def events(self, name, since):
        """Values of an event that was raised after a simulated time."""
        return [value for value, time in self.robot.server.memory.history(name) if time > since]


@pytest.fixture
def room(stiff_robot):
    for module in EXTRACTORS:
        stiff_robot.post(module, "subscribe", "Test").value()
    return Room(stiff_robot)


@pytest.mark.parametrize("bearing", [100, -140])
def test_a_sound_is_located(room, bearing):
    room.advance(0.3)
    begun = room.burst(bearing)
    located = room.events(LOCATED, begun)
    assert 3 <= len(located) <= 5
    assert room.events(ALL_LOCATED, begun) == [[sound] for sound in located]
    assert room.events(OLD_LOCATED, begun) == located
    head = room.robot.ALMotion.getPosition("Head", 0, True)
    for (seconds, micros), (azimuth, _, confidence, energy), in_torso, in_robot in located:
        assert in_torso == pytest.approx(head, abs=1e-3)
        assert in_robot == pytest.approx(room.robot.ALMotion.getPosition("Head", 2, True), abs=2e-3)
        assert begun - 0.2 < seconds + 1e-6 * micros < begun + 0.7
        assert (math.degrees(azimuth) - bearing + 180) % 360 - 180 == pytest.approx(0.0, abs=10.0)
        assert 0.5 < confidence <= 1.0 and energy == 0.0
    room.robot.ALSoundLocalization.setParameter("EnergyComputation", True)
    energies = [room.events(LOCATED, room.burst(bearing, level_db=level_db))[1][1][3] for level_db in (60.0, 66.0)]
    assert energies[1] == pytest.approx(2.0 * energies[0], rel=0.2)


def test_a_sound_is_detected_when_it_begins_and_ends(room):
    room.advance(1.0)
    begun = room.burst(0, seconds=0.5, then=1.5)
    start, end = [edge for edges in room.events(DETECTED, begun) for edge in edges]
    travel = 1.5 / 343.0
    assert (start[1], end[1]) == (1, 0)
    assert 1e-6 * start[3] == pytest.approx(begun + travel, abs=0.03)
    assert 1e-6 * end[3] == pytest.approx(begun + 0.5 + travel, abs=0.05)
    assert 0 <= start[0] < 8160 and 0.5 <= start[2] <= 1.0


@pytest.mark.parametrize("module, events", EXTRACTORS.items())
def test_extractors_tell_their_events_and_refuse_wrong_parameters(robot, refused, module, events):
    assert getattr(robot, module).getEventList() == robot.ALMemory.getExtractorEvent(module) == events
    rows = [
        ("Volume", 1.0, f"{module}::setParameter unknown parameter 'Volume'; there are Sensitivity, Sensibility"),
        ("Sensitivity", 1.5, "Sensitivity is 1.5, allowed is 0 to 1"),
    ]
    refused(module, [("setParameter", row[:2], row[2]) for row in rows])


@pytest.fixture
def asr(robot):
    service = robot.ALSpeechRecognition
    service.setAudioExpression(False)
    service.setVocabulary(["yes", "Good morning", "red"], False)
    return service


def person_says(robot, text):
    """A person 1 m in front of the robot says something; returns when it has been heard."""
    words = Sound(spoken(text).astype(np.float32), SPEECH_RATE).at_rate(RATE)
    put(robot, HERE, words.samples[:, 0], name="person")
    for _ in range(4):  # time waits for the recogniser
        robot.advance((words.duration + 1.5) / 4)


def test_what_cannot_be_listened_for_is_refused_with_its_reason(asr, refused):
    asr.pause(True)
    rows = [
        ("setVocabulary", (["猫"], False), "猫"),
        ("setLanguage", ("French",), "English"),
        ("setParameter", ("Sensitivity", 1.5), "0 to 1"),
        ("setVisualExpressionMode", (7,), "0 .none."),
        ("compile", ("missing.bnf", "x.lcf", "English"), "missing.bnf"),
        ("activateRule", ("nothing", "x"), "unknown context"),
        ("popContexts", (), "pushed"),
    ]
    refused("ALSpeechRecognition", rows)
    asr.pause(False)
    asr.subscribe("Test")
    with pytest.raises(RuntimeError, match=r"pause\(True\) first"):
        asr.setVocabulary(["no"], False)


def test_who_subscribes_to_its_event_has_it_listen(robot, asr):
    asr.setVocabulary(["yes", "no"], False)
    for event in ("WordRecognized", "SpeechDetected"):
        robot.ALMemory.subscribeToEvent(event, "Listener", "onEvent")
        assert [name for name, *_ in asr.getSubscribersInfo()] == ["Listener"]
    robot.ALMemory.unsubscribeToEvent("WordRecognized", "Listener")
    assert [name for name, *_ in asr.getSubscribersInfo()] == ["Listener"]
    robot.ALMemory.unsubscribeToEvent("SpeechDetected", "Listener")
    assert asr.getSubscribersInfo() == []


def test_a_grammar_file_is_compiled_and_recognised(robot, asr):
    folder = robot.server.files.folder
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "house.bnf").write_text(GRAMMAR)
    (folder / "words.txt").write_text("# of a file\nyes\nno\n")
    asr.pause(True)
    asr.loadVocabulary("words.txt")
    asr.compile("house.bnf", "house.lcf", "English")
    asr.addContext("house.lcf", "house")
    asr.addWordListToSlot("house", "thing", ["radio", "light"])
    asr.setContextParam("house", "ConfidenceThreshold", 0.1)
    assert asr.getContextParam("house", "ConfidenceThreshold") == pytest.approx(0.1)
    asr.deactivateAllRules("house")
    assert asr.getRules("house", "active") == []
    asr.activateRule("house", "order")
    asr.activateAllRules("house")
    asr.deactivateRule("house", "polite")
    assert asr.getRules("house", "active") == ["order"]
    asr.saveContextSet("set")
    asr.pushContexts()
    asr.popContexts()
    asr.removeContext("house")
    asr.loadContextSet("set")
    asr.pause(False)
    asr.subscribe("Test")
    robot.advance(1.0)
    person_says(robot, "turn off the radio")
    phrase, _, grammar = robot.ALMemory.getData("WordRecognizedAndGrammar")
    assert (phrase, grammar) == ("turn off the radio", "house")
    history = [value for value, _ in robot.server.memory.history("ALSpeechRecognition/Status")]
    assert history[-3:] == ["SpeechDetected", "EndOfProcess", "ListenOn"]
    person_says(robot, "the weather in the mountains is nice today")
    assert robot.ALMemory.getData("WordRecognized") == ["", -3.0]
    assert robot.ALMemory.getData("LastWordRecognized")[0] == phrase
    asr.pause(True)
    asr.removeWordListFromSlot("house", "thing")
