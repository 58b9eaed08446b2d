"""ALSpeechRecognition over libqi: a person in the world speaks, and the robot tells the words in simulated time."""

from __future__ import annotations

import pytest
from spoken_words import RATE, spoken

from nao_sim_bridge.sim.sound.samples import RATE as WORLD_RATE
from nao_sim_bridge.sim.sound.samples import Sound
from nao_sim_bridge.sim.sound.sources import SoundSource

GRAMMAR = """#BNF+EM V2.1;
!grammar house;
!start <order>;
!activatable <polite>;
!slot <thing>;
<order>: turn off the <thing> [<polite>];
<polite>: please;
"""


@pytest.fixture
def asr(robot):
    service = robot.ALSpeechRecognition
    service.setAudioExpression(False)
    service.pause(True)
    service.removeAllContext()
    service.setVocabulary(["yes", "Good morning", "red"], False)
    service.setParameter("NbHypotheses", 1.0)
    service.pause(False)
    yield service
    for name, _, _ in service.getSubscribersInfo():
        service.unsubscribe(name)
    service.setAudioExpression(True)


@pytest.fixture
def person_says(robot):
    """A person 1 m in front of the robot says something; returns when it has been heard."""
    simulation, runner = robot.server.simulation, robot.server.runner

    def say(text):
        sound = Sound(spoken(text), RATE).at_rate(WORLD_RATE)
        source = SoundSource("person", (1.0, 0.0, 0.5), sound, 65.0)
        runner.call(lambda: simulation.sound.sources.add(source))
        robot.advance(sound.duration + 1.5)
        simulation.sound.ears.catch_up()
        robot.server._recognition.engine.catch_up()

    return say


def test_a_word_is_recognised_in_simulated_time(robot, asr, person_says):
    asr.subscribe("Test")
    robot.advance(1.0)
    begun = robot.now.time
    person_says("good morning")
    phrase, confidence = robot.ALMemory.getData("WordRecognized")
    assert phrase == "Good morning"
    assert 0.5 < confidence <= 1.0
    assert robot.ALMemory.getData("WordRecognizedAndGrammar") == [phrase, confidence, "modifiable_grammar"]
    assert robot.ALMemory.getData("LastWordRecognized") == [phrase, confidence]
    seconds, microseconds = robot.ALMemory.getTimestamp("WordRecognized")[1:3]
    assert 0.5 < seconds + 1e-6 * microseconds - begun < 2.5
    person_says("the weather in the mountains is nice today")
    assert robot.ALMemory.getData("WordRecognized") == ["", -3.0]
    assert robot.ALMemory.getData("LastWordRecognized") == [phrase, confidence]


def test_nothing_is_recognised_in_silence_nor_while_paused(robot, asr, person_says):
    asr.subscribe("Test")
    robot.advance(5.0)
    asr.pause(True)
    person_says("good morning")
    assert robot.ALMemory.getData("WordRecognized") == ["", -3.0]
    assert robot.ALMemory.getData("ALSpeechRecognition/IsRunning") is False


def test_the_vocabulary_is_changed_in_a_pause_only(asr):
    asr.subscribe("Test")
    with pytest.raises(RuntimeError, match=r"pause\(True\) first"):
        asr.setVocabulary(["no"], False)
    asr.pause(True)
    asr.setVocabulary(["no"], False)


@pytest.mark.parametrize(
    "call, problem",
    [
        (("setVocabulary", ["猫"], False), "猫"),
        (("setVocabulary", ["?"], False), "at least one word"),
        (("setLanguage", "French"), "English"),
        (("setParameter", "Sensibility", 0.5), "Sensitivity"),
        (("setParameter", "Sensitivity", 1.5), "0 to 1"),
        (("setVisualExpressionMode", 7), "0 .none."),
        (("compile", "missing.bnf", "x.lcf", "English"), "missing.bnf"),
        (("addContext", "missing.lcf", "x"), "missing.lcf"),
        (("activateRule", "nothing", "x"), "unknown context"),
        (("popContexts",), "pushed"),
    ],
)
def test_what_cannot_be_is_refused_with_its_reason(asr, call, problem):
    asr.pause(True)
    with pytest.raises(RuntimeError, match=problem):
        asr.call(*call)
    asr.pause(False)


def test_a_grammar_file_is_compiled_and_recognised(robot, asr, person_says):
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
    person_says("turn off the radio")
    phrase, _, grammar = robot.ALMemory.getData("WordRecognizedAndGrammar")
    assert (phrase, grammar) == ("turn off the radio", "house")
    asr.pause(True)
    asr.removeWordListFromSlot("house", "thing")


def test_the_eyes_show_that_it_listens(robot, asr):
    before = robot.ALLeds.getIntensity("FaceLeds")
    asr.subscribe("Test")
    robot.settled()
    assert robot.ALLeds.getIntensity("FaceLeds") != before
    asr.unsubscribe("Test")
    robot.settled()
    assert robot.ALLeds.getIntensity("FaceLeds") == before
