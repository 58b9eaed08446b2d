"""Texts are said one after the other, each once, in the voice that was asked for; and it is told when they are not."""

from __future__ import annotations

from dataclasses import replace

import fake_sound
import pytest
from set_clock import SetClock

from nao_library_modules.driver import speech as speech_module
from nao_library_modules.driver.speech import LONGEST_QUEUE, QUIET_LIMIT, NothingSaid, Speech
from nao_library_modules.driver.speech_settings import SpeechSettings
from nao_library_modules.errors import Preempted, RobotLost
from naoqi.errors import NaoError, RobotError, RobotUnreachable

LIMIT = 5.0
STARTED, WORD = "ALTextToSpeech/TextStarted", "ALTextToSpeech/CurrentWord"


@pytest.fixture
def voice(make_call):
    return fake_sound.Voice(make_call)


@pytest.fixture
def robot(make_call, voice):
    return fake_sound.Robot(make_call, ALTextToSpeech=voice, ALMemory=fake_sound.Memory())


@pytest.fixture
def clock():
    return SetClock()


@pytest.fixture
def settings():
    return [SpeechSettings()]


@pytest.fixture
def speech(robot, clock, settings):
    speech = Speech(robot, clock, lambda: settings[0])
    yield speech
    speech.close()


@pytest.fixture
def begin(voice):
    """Waits until the robot begins a text; gives its call."""

    def wait():
        assert voice.begun.acquire(timeout=LIMIT), "no text was begun"
        return voice.pending[-1]

    return wait


def ended(utterance):
    assert utterance.ended.wait(LIMIT), f"{utterance.text} has not ended"
    return utterance.error


def said(voice):
    return [text for text, *_ in voice.texts]


def test_texts_wait_for_each_other_and_are_said_once(speech, voice, begin):
    first, second = speech.say("one"), speech.say("two")
    call = begin()
    assert not second.ended.is_set() and said(voice) == ["one"]
    call.end()
    assert ended(first) is None
    begin().end()
    assert ended(second) is None
    assert said(voice) == ["one", "two"]
    assert speech.report().values["said"] == "2"


def test_the_start_is_told_once_when_the_robot_begins_to_talk(speech, robot, begin):
    starts = []
    utterance = speech.say("hello", on_start=lambda: starts.append("started"))
    call = begin()
    assert starts == []
    robot.services["ALMemory"].raise_event(STARTED, False)
    assert starts == []
    robot.services["ALMemory"].raise_event(STARTED, True)
    robot.services["ALMemory"].raise_event(STARTED, True)
    assert starts == ["started"]
    call.end()
    ended(utterance)
    assert starts == ["started"]


def test_a_robot_without_events_starts_at_the_latest_when_it_ends(speech, robot, begin):
    del robot.services["ALMemory"]
    starts = []
    utterance = speech.say("hello", on_start=lambda: starts.append("started"))
    begin().end()
    assert ended(utterance) is None
    assert starts == ["started"]


def test_voice_language_and_volume_are_used_for_the_text_and_put_back(speech, voice, settings, begin):
    settings[0] = SpeechSettings(voice="slt", language="French", volume=0.9)
    utterance = speech.say("bonjour")
    begin().end()
    assert ended(utterance) is None
    assert voice.texts == [("bonjour", "French", "slt", 0.9)]
    assert (voice.language, voice.voice, voice.volume) == ("English", "naoenu", 0.5)


def test_a_voice_of_its_own_survives_another_language(speech, voice, settings, begin):
    voice.voice = "slt"
    settings[0] = SpeechSettings(language="French")
    utterance = speech.say("bonjour")
    begin().end()
    ended(utterance)
    assert voice.texts[0][1:3] == ("French", "naofrf")
    assert (voice.language, voice.voice) == ("English", "slt")


def test_what_somebody_changes_meanwhile_is_left_alone(speech, voice, settings, begin):
    settings[0] = SpeechSettings(voice="slt", volume=0.9)
    utterance = speech.say("hello")
    call = begin()
    voice.volume = 0.1
    call.end()
    ended(utterance)
    assert (voice.voice, voice.volume) == ("naoenu", 0.1)


def test_settings_that_the_robot_refuses_are_an_error_and_change_nothing(speech, voice, settings, begin):
    settings[0] = SpeechSettings(language="French", voice="nobody")
    failures = []
    error = ended(speech.say("hello", on_failure=failures.append))
    assert isinstance(error, RobotError) and failures == [error]
    assert (voice.language, voice.voice, voice.texts) == ("English", "naoenu", [])
    settings[0] = SpeechSettings()
    utterance = speech.say("hello again")
    begin().end()
    assert ended(utterance) is None


def test_a_text_is_silenced_at_once(speech, voice, begin, settings):
    settings[0] = SpeechSettings(volume=0.9)
    first, second = speech.say("one"), speech.say("two")
    call = begin()
    speech.silence(first)
    assert isinstance(ended(first), Preempted)
    assert call.canceled
    begin().end()
    assert ended(second) is None
    assert voice.volume == pytest.approx(0.5)
    assert speech.report().values["interrupted"] == "1"


def test_a_robot_whose_calls_cannot_be_cancelled_is_stopped(speech, voice, begin):
    utterance = speech.say("one")
    begin().cancel = lambda: None
    speech.silence(utterance)
    assert isinstance(ended(utterance), Preempted)


def test_a_text_that_waits_is_never_begun_when_it_is_silenced(speech, voice, begin):
    first, second = speech.say("one"), speech.say("two")
    call = begin()
    speech.silence(second)
    assert isinstance(ended(second), Preempted)
    call.end()
    assert ended(first) is None
    third = speech.say("three")
    begin().end()
    ended(third)
    assert said(voice) == ["one", "three"]


def test_a_robot_that_says_nothing_for_two_minutes_is_given_up(speech, clock, begin):
    utterance = speech.say("one")
    call = begin()
    clock.somebody_waits(QUIET_LIMIT)
    clock.advance(QUIET_LIMIT + 1.0)
    assert isinstance(ended(utterance), NothingSaid)
    assert call.canceled


def test_a_long_text_may_take_its_time_while_words_come(speech, robot, clock, begin):
    utterance = speech.say("a very long story")
    call = begin()
    last_word = 0.0
    for _ in range(5):
        clock.somebody_waits(last_word + QUIET_LIMIT)
        last_word = clock.time = clock.time + 0.9 * QUIET_LIMIT
        robot.services["ALMemory"].raise_event(WORD, "word")
        clock.advance(0.2 * QUIET_LIMIT)
    assert not utterance.ended.is_set()
    call.end()
    assert ended(utterance) is None


def test_texts_for_a_lost_robot_are_told_and_later_ones_are_said(speech, robot, voice, begin):
    failures = []
    first = speech.say("one", on_failure=failures.append)
    begin()
    second = speech.say("two", on_failure=failures.append)
    robot.connection.become("lost", "cable pulled")
    robot.lose()
    assert isinstance(ended(first), RobotUnreachable)
    assert isinstance(ended(second), RobotLost)
    assert failures == [first.error, second.error]
    assert "cable pulled" in speech.report().values["last error"]
    robot.come_back()
    third = speech.say("three")
    begin().end()
    assert ended(third) is None
    assert said(voice) == ["one", "three"]


def test_a_voice_that_is_owed_is_put_back_when_the_robot_is_back(speech, robot, voice, settings, begin, eventually):
    settings[0] = SpeechSettings(volume=0.9)
    utterance = speech.say("one")
    begin()
    robot.connection.state = "lost"
    robot.lose()
    ended(utterance)
    assert voice.volume == pytest.approx(0.9)
    robot.come_back()
    speech.robot_is_back()
    eventually(lambda: voice.volume == pytest.approx(0.5))


def test_a_text_waits_a_moment_for_a_robot_that_was_never_there(robot, clock, voice, begin):
    robot.connection.state = "connecting"

    def arrive(limit):
        robot.connection.state = "connected"
        return True

    robot.connection.wait_connected = arrive
    speech = Speech(robot, clock, SpeechSettings)
    utterance = speech.say("Walker online")
    begin().end()
    assert ended(utterance) is None
    speech.close()


def test_but_not_for_ever(robot, clock, monkeypatch):
    monkeypatch.setattr(speech_module, "PATIENCE", 0.0)
    robot.connection.state = "connecting"
    speech = Speech(robot, clock, SpeechSettings)
    assert isinstance(ended(speech.say("hello")), RobotUnreachable)
    speech.close()


def test_there_is_an_end_to_the_queue(speech, begin):
    speech.say("first")
    begin()
    for n in range(LONGEST_QUEUE):
        speech.say(str(n))
    with pytest.raises(NaoError, match="100 texts are waiting"):
        speech.say("one too many")


def test_the_end_of_the_node_silences_everything(robot, clock, settings, voice, begin):
    settings[0] = replace(settings[0], volume=0.9)
    speech = Speech(robot, clock, lambda: settings[0])
    first, second = speech.say("one"), speech.say("two")
    call = begin()
    speech.close()
    assert isinstance(ended(first), Preempted) and isinstance(ended(second), Preempted)
    assert call.canceled and voice.volume == pytest.approx(0.5)
    assert isinstance(ended(speech.say("three")), Preempted)
    assert said(voice) == ["one"]
