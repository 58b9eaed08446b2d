"""Listening for words: start, stop, other listeners, a new vocabulary, and what was heard."""

from __future__ import annotations

from dataclasses import replace

import fake_sound
import pytest

from nao_library_modules.driver import demand
from nao_library_modules.driver.speech_recognition import Heard, Recognition, RecognitionInUse, read_heard
from nao_library_modules.driver.speech_settings import SpeechSettings
from naoqi.errors import NaoError, RobotError, RobotUnreachable


@pytest.fixture
def words():
    return fake_sound.Words()


@pytest.fixture
def robot(make_call, words, monkeypatch):
    monkeypatch.setattr(demand, "RETRY", 0.01)
    monkeypatch.setattr(demand, "FIRST_RETRY", 0.01)
    return fake_sound.Robot(make_call, ALSpeechRecognition=words, ALMemory=fake_sound.Memory())


@pytest.fixture
def settings():
    return [SpeechSettings(vocabulary=("yes", "no"))]


@pytest.fixture
def heard():
    return []


@pytest.fixture
def recognition(robot, settings, heard):
    recognition = Recognition(robot, "ros_nao_speech", lambda: settings[0], heard.append)
    yield recognition
    recognition.close()


def test_it_listens_for_the_vocabulary_until_it_is_stopped(recognition, words, settings):
    settings[0] = replace(settings[0], word_spotting=True, audio_expression=False)
    recognition.start()
    assert words.calls == [("setVocabulary", ("yes", "no"), True), "subscribe"]
    assert words.subscribers == ["ros_nao_speech"] and not words.beeps
    recognition.start()
    assert words.calls.count("subscribe") == 1
    assert recognition.report().message == "listens"
    recognition.stop()
    recognition.stop()
    assert words.subscribers == [] and words.beeps
    assert words.calls.count("unsubscribe") == 1


def test_without_a_vocabulary_it_does_not_start(recognition, words, settings):
    settings[0] = SpeechSettings()
    with pytest.raises(NaoError, match="no vocabulary"):
        recognition.start()
    assert not recognition.running and words.subscribers == []


def test_it_does_not_take_the_vocabulary_from_others(recognition, words):
    words.subscribers.append("Dialog")
    with pytest.raises(RecognitionInUse, match="in use by Dialog"):
        recognition.start()
    assert words.calls == []


def test_what_a_killed_run_has_left_is_no_hindrance(recognition, words):
    words.subscribers.append("ros_nao_speech")
    recognition.start()
    assert words.subscribers == ["ros_nao_speech"]


def test_a_new_vocabulary_is_used_at_once(recognition, words, settings):
    recognition.start()
    settings[0] = replace(settings[0], vocabulary=("stop",))
    recognition.apply()
    assert words.vocabulary == ("stop",) and not words.paused


def test_a_vocabulary_that_the_robot_refuses_leaves_the_old_one_running(recognition, words, settings):
    words.unknown.add("xyzzy")
    recognition.start()
    settings[0] = replace(settings[0], vocabulary=("xyzzy",))
    with pytest.raises(RobotError, match="xyzzy"):
        recognition.apply()
    assert words.vocabulary == ("yes", "no") and not words.paused


def test_while_it_does_not_listen_a_vocabulary_waits(recognition, words, settings):
    recognition.apply()
    assert words.calls == []


def test_it_goes_on_when_a_lost_robot_is_back(recognition, robot, words, eventually):
    recognition.start()
    robot.lose()
    words.subscribers.clear()
    assert "cannot listen" in recognition.report().message
    with pytest.raises(RobotUnreachable):
        recognition._ask("pause", True)
    robot.come_back()
    eventually(lambda: words.subscribers == ["ros_nao_speech"])
    eventually(lambda: recognition.report().message == "listens")


def test_stopped_while_the_robot_is_lost_it_stays_stopped(recognition, robot, words):
    recognition.start()
    robot.lose()
    words.subscribers.clear()
    recognition.stop()
    robot.come_back()
    recognition.stop()
    assert words.subscribers == []


def test_words_are_passed_on_whoever_listens_and_once_after_a_loss(recognition, robot, heard, eventually):
    memory = robot.services["ALMemory"]
    eventually(lambda: len(memory.signals.get("WordRecognized", ())) == 1)
    memory.raise_event("WordRecognized", ["yes", 0.7, "no", 0.1])
    memory.raise_event("WordRecognized", ["", 0.0])
    assert heard == [Heard(("yes", "no"), (0.7, 0.1))]
    robot.lose()
    memory.signals.clear()
    robot.come_back()
    eventually(lambda: len(memory.signals.get("WordRecognized", ())) == 1)
    memory.raise_event("WordRecognized", ["no", 0.5])
    assert heard[1:] == [Heard(("no",), (0.5,))]


@pytest.mark.parametrize(
    "value, words",
    [
        (["<...> good morning <...>", 0.5], ("good morning",)),
        (["yes", 0.5, "", 0.0], ("yes",)),
        (["yes"], None),
        ([], None),
        (None, None),
        ("", None),
        (["<...> <...>", 0.5], None),
    ],
)
def test_events_are_read(value, words):
    heard = read_heard(value)
    assert (heard.words if heard else None) == words
