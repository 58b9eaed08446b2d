"""Goals that recognise words: what counts, what goes back, what others see, what outlives a goal."""

from __future__ import annotations

import math

import numpy as np
import pytest
from goal_functions import audio_in as f
from sounds import RATE, noise, put
from spoken_words import RATE as SPEECH_RATE
from spoken_words import spoken

from nao_library_actions.msg import NaoAudioInGoal
from nao_library_modules.audio_in.audio_in_server import NaoAudioInput
from nao_library_modules.core.files import Kept
from nao_sim_bridge.base.samples import Sound

WORDS, STATUS = "WordRecognized", "ALSpeechRecognition/Status"
YES_NO = ["yes", "no"]


LISTEN = f("listen", vocabulary=YES_NO, timeout=5.0)


def says(robot, text):
    """Somebody 1 m in front of the robot speaks; how long, s."""
    words = Sound(spoken(text).astype(np.float32), SPEECH_RATE).at_rate(RATE)
    put(robot, (1.0, 0.0, 0.5), words.samples[:, 0], name=text)
    return words.duration


def told(robot, name, value):
    """Raise an event, and let a moment pass in which it comes."""
    robot.ALMemory.raiseEvent(name, value)
    robot.proxy("ALMemory").ping()
    robot.advance(0.1)


def begun(robot, ears, function, subscribers, after=0.5):
    """A goal that listens."""
    goal = ears.send(function)
    robot.advance_until(subscribers, 5.0)
    robot.advance(after)
    return goal


def test_a_person_is_understood_and_other_programs_have_their_vocabulary_back(robot, ears, subscribers, restored):
    service = robot.ALSpeechRecognition
    service.setVocabulary(["red", "green"], False)
    service.subscribe("another program")
    function = f("listen", vocabulary=[" stand  up", "sit down"], timeout=20.0)
    goal = ears.send(function)
    robot.advance_until(lambda: len(subscribers()) == 2, 5.0)
    robot.advance(1.0)
    said = robot.now.time + says(robot, "stand up")
    goal.finish()
    assert goal.state == "succeeded" and goal.result.words == ["stand up"] and robot.now.time - said < 2.0
    assert 0.3 < goal.result.confidences[0] <= 1.0
    assert goal.result.results[0].values[0] == "stand up" and goal.result.memList == []
    assert "SpeechDetected" in [told.status for told in goal.feedback]
    assert ["stand up"] in [list(told.words) for told in goal.feedback]
    assert {(told.index, told.function, told.count) for told in goal.feedback} == {(0, "listen", 1)}
    robot.advance(0.5)
    robot.advance(says(robot, "green") + 1.5)
    assert robot.value("LastWordRecognized")[0] == "green" and subscribers() == ["another program"]
    service.unsubscribe("another program")
    restored()


def test_words_with_too_little_confidence_are_told_but_do_not_count(robot, ears, subscribers, restored):
    goal = begun(robot, ears, f("listen", vocabulary=YES_NO, confidence=0.5, timeout=30.0), subscribers)
    (name,) = subscribers()
    assert name.startswith("nao_audio_in_") and name.endswith("robot1_listen")
    for event, value in [
        (WORDS, "nonsense"),
        (WORDS, ["no", 0.2]),
        (STATUS, "SpeechDetected"),
        (WORDS, ["", -3.0]),
        (WORDS, ["<...> yes <...>", 0.7, "no", 0.6]),
    ]:
        told(robot, event, value)
    goal.finish()
    assert (goal.state, goal.result.words, goal.result.memList) == ("succeeded", ["yes", "no"], [])
    assert goal.result.confidences == pytest.approx([0.7, 0.6])
    assert goal.result.results[0].values == ["yes", "0.7", "no", "0.6"]
    heard = [(told.status, list(told.words)) for told in goal.feedback if told.words or told.status == "SpeechDetected"]
    assert heard == [(WORDS, ["no"]), ("SpeechDetected", []), (WORDS, ["yes", "no"])]
    restored()


def test_nothing_in_time_is_no_failure(robot, ears, restored):
    put(robot, (1.0, 0.5, 0.5), noise(2.0), 50.0, loop=True)  # noise is no word either
    for timeout, lasts in ((2.0, 2.0), (0.0, 10.0)):
        began = robot.now.time
        result = ears.succeed(f("listen", vocabulary=YES_NO, timeout=timeout, str_param="English"))
        assert (result.words, result.confidences, result.results[0].values) == ([], [], [])
        assert robot.now.time - began == pytest.approx(lasts, abs=0.3)
    text = ears.refused(f("listen", vocabulary=["yes", "привет"]))
    assert text.startswith("function 1 (listen): ALSpeechRecognition.setVocabulary failed: ") and "'привет'" in text
    restored()


@pytest.mark.parametrize("function", ["listen", "detectSound", "localizeSound", "getEnergy", "record", "getLanguage"])
def test_every_function_that_takes_time_is_preempted_and_leaves_nothing_behind(robot, ears, restored, function):
    file = {"str_param": "a.wav"} if function == "record" else {}
    long = f(function, vocabulary=YES_NO, duration=1000.0, timeout=1000.0, time=1000.0, **file)
    goal = ears.send(long, f("ping"))
    robot.advance(1.0)
    goal.cancel()
    assert goal.state == "preempted" and f"function 1 ({function})" in goal.text
    restored()
    device = robot.ALAudioDevice
    robot.advance(0.3)
    assert device.getFrontMicEnergy() == 0.0
    ears.succeed(f("record", str_param="after.wav", duration=0.2))


def test_recognition_outlives_its_goal_and_its_words_are_published(robot, ears, subscribers, restored):
    ears.succeed(f("startRecognition", vocabulary=YES_NO))
    assert len(subscribers()) == 1
    robot.advance(1.0)
    robot.advance(says(robot, "yes") + 1.5)
    robot.proxy("ALMemory").ping()
    assert [name for name, value in ears.node.events if value[:1] == ["yes"]] == [WORDS]
    assert "the recognition is paused: resume comes first" in ears.refused(f("pause"), LISTEN)
    assert robot.value("ALSpeechRecognition/IsRunning") is True
    ears.succeed(f("startRecognition", vocabulary=["stop"], word_spotting=True))
    assert len(subscribers()) == 1
    goal = ears.send(LISTEN)  # in the middle of it
    robot.advance_until(lambda: len(subscribers()) == 2, 5.0)
    robot.advance(0.3)
    told(robot, WORDS, ["no", 0.7])
    assert goal.finish().result.words == ["no"] and len(subscribers()) == 1
    ears.succeed(f("stopRecognition"), f("stopRecognition"))
    restored()
    ears.succeed(f("setVocabulary", vocabulary=["R2 D2", "now!"]))
    goal = begun(robot, ears, f("listen", timeout=5.0), subscribers)
    told(robot, WORDS, ["now!", 0.7])
    assert goal.finish().result.words == ["now!"]
    published = len(ears.node.events)
    told(robot, WORDS, ["yes", 0.6])
    assert len(ears.node.events) == published


def test_the_end_of_the_server_ends_what_goals_have_left_and_so_does_the_next_of_its_name(
    robot, ears, goals_to, restored, subscribers
):
    robot.ALSpeechRecognition.setVocabulary(["theirs"], False)
    ears.succeed(
        f("startRecording", str_param="left.wav"),
        f("startRecognition", vocabulary=YES_NO),
        f("enableEnergyComputation"),
        f("pause"),
    )
    robot.ALSpeechRecognition.subscribe("another program")
    ears.close()
    with pytest.raises(RuntimeError, match="while the engine runs"):  # it is not paused any more
        robot.ALSpeechRecognition.setVocabulary(["new"], False)
    robot.ALSpeechRecognition.unsubscribe("another program")
    restored()
    robot.advance(0.3)
    assert robot.ALAudioDevice.getFrontMicEnergy() == 0.0
    robot.ALAudioRecorder.startMicrophonesRecording("free.wav", "wav", 16000, [0, 0, 1, 0])
    robot.ALAudioRecorder.stopMicrophonesRecording()
    killed = ears.module.hearing.subscriber_for("listen")
    for name in (killed, "another program"):
        robot.ALSpeechRecognition.subscribe(name)
    robot.ALSoundLocalization.subscribe(ears.module.hearing.subscriber_for("localize"))
    goals_to(NaoAudioInput, NaoAudioInGoal).succeed(f("ping"))
    assert subscribers() == ["another program"]
    robot.ALSpeechRecognition.unsubscribe("another program")


def test_what_goals_left_going_goes_on_in_the_next_server_when_theirs_died(robot, goals_to, restored, tmp_path):
    def server():
        return goals_to(
            NaoAudioInput,
            NaoAudioInGoal,
            robot_home=str(robot.server.files.folder),
            kept=Kept(tmp_path / "kept", "run"),
        )

    died = server()
    died.succeed(
        f("startRecording", str_param="left.wav", rate=48000),
        f("startRecognition", vocabulary=YES_NO),
        f("enableEnergyComputation"),
        f("pause"),
    )
    robot.advance(0.5)
    ears = server()
    assert "the recognition is paused: resume comes first" in ears.refused(LISTEN)
    robot.advance(1.0)
    (file,) = ears.succeed(f("stopRecording"), f("resume"), f("disableEnergyComputation")).files
    assert (file.path, file.rate) == ("left-2.wav", 48000) and file.duration == pytest.approx(1.0, abs=0.1)
    robot.advance(says(robot, "yes") + 1.5)
    robot.proxy("ALMemory").ping()
    assert [value[0] for name, value in ears.node.events if name == WORDS] == ["yes"]
    ears.succeed(f("stopRecognition"))
    restored()


NAN, INF = math.nan, math.inf
FILE, YES = {"str_param": "a.wav", "duration": 1.0}, {"vocabulary": YES_NO}
TIMEOUT = ("timeout", [NAN, -1.0, INF, 1e7], "is not allowed: up to 3600 s")
SURE = ("confidence", [1.5, -0.1, NAN], "is not allowed: 0..1")
PHRASES = [
    ("vocabulary", [["yes", " "]], "there is an empty phrase in it"),
    ("vocabulary", [["yes|no"]], "'|' in 'yes|no' cannot be said"),
    ("vocabulary", [["..."]], "nothing to say in '...'"),
    ("vocabulary", [["word " * 50]], "is too long"),
    ("vocabulary", [["word"] * 1001], "1001 are too many: at most 1000"),
]
# Function, its fields, and for each of some fields: values that are refused, and the words of the text.
REFUSED = [
    ("lisen", YES, [("timeout", [0.0], "did you mean 'listen'")]),
    ("record", FILE, [("duration", [0.0, NAN, -1.0, 1e9], "is not allowed: 0.001..3600 s")]),
    ("record", FILE, [("str_param", [""], "field str_param: it is empty"), ("str_param", ["a.mp3"], "ends in .wav, ")]),
    ("record", FILE, [("str_param", ["../a.wav", "/etc/a.wav"], "leads out of the folder")]),
    (
        "record",
        FILE,
        [("file_type", ["ogg"], "field file_type"), ("rate", [44100, -1], "is not allowed: 16000, 48000")],
    ),
    ("record", FILE, [("channels", [["fornt"]], "did you mean 'front'")]),
    ("record", FILE, [("channels", [["left", "left"]], "each microphone once")]),
    ("record", FILE, [("channels", [["left", "rear"]], "2 channel(s): one of left, right")]),
    ("startRecording", {**FILE, "rate": 48000}, [("channels", [["left"]], "1 channel(s) at 48000 Hz")]),
    ("listen", {}, [("vocabulary", [[]], "it is empty: at least one word or phrase, here or by setVocabulary before")]),
    ("listen", YES, [*PHRASES, TIMEOUT, SURE, ("str_param", ["Klingon"], "no language that the robot recognises: ")]),
    ("setVocabulary", {}, [("vocabulary", [[]], "at least one word or phrase")]),
    ("setLanguage", {}, [("str_param", [""], "a language by NAOqi's name"), ("str_param", ["Klingon"], "no language")]),
    ("localizeSound", {}, [TIMEOUT, SURE, ("duration", [NAN, -1.0], "field duration")]),
    ("getEnergy", {}, [("duration", [-1.0, NAN, 4000.0], "is not allowed: 0..3600 s")]),
    ("setSensitivity", {}, [("sensitivity", [0.0, 2.0, -0.1, NAN], "is not allowed: above 0 to 1")]),
    ("setSensitivity", {"sensitivity": 0.5}, [("str_param", ["smell"], "one of speech, detection, localization")]),
    (
        "setParameter",
        {"str_param": "Sensitivity"},
        [("values", [[], [1.0, 2.0]], "is not allowed: one number"), ("values", [[NAN]], "nan is not allowed")],
    ),
    ("getParameter", {}, [("str_param", ["", " "], "the name of a parameter")]),
    ("setFileAsInput", {}, [("str_param", ["a.txt"], "not a file of a known kind")]),
]


def test_a_bad_function_moves_nothing_of_its_chain(robot, ears, restored):
    volume = robot.ALAudioDevice.getOutputVolume()
    for name, fields, wrong in REFUSED:
        for field, values, words in wrong:
            for value in values:
                text = ears.refused(f("setOutputVolume", volume=10), f(name, **{**fields, field: value}))
                assert text.startswith(f"function 2 ({name}): ") and words in text, (name, field, value, text)
    assert robot.ALAudioDevice.getOutputVolume() == volume
    restored()
    ears.succeed(f("ping"))
