"""Texts are said, or it is told why not."""

from __future__ import annotations

import logging
from types import SimpleNamespace

import pytest

from nao_library_modules.driver.speaker import Speaker
from naoqi.errors import RobotError, RobotUnreachable, UnknownModule


class Proxy:
    def __init__(self, answer):
        self.answer = answer
        self.said = []

    def call_async(self, method, text):
        if isinstance(self.answer, Exception):
            raise self.answer
        self.said.append((method, text))
        return self.answer


@pytest.fixture
def speaker_with(make_call):
    def make(answer=None):
        proxy = Proxy(make_call() if answer is None else answer)
        return Speaker(SimpleNamespace(proxy={"ALTextToSpeech": proxy}.__getitem__)), proxy

    return make


def test_a_text_is_said_without_waiting_for_its_end(speaker_with):
    speaker, proxy = speaker_with()
    speaker.say("hello")
    assert proxy.said == [("say", "hello")]
    assert not proxy.answer.done()


def test_a_robot_that_cannot_speak_is_no_error(speaker_with, caplog):
    caplog.set_level(logging.INFO)
    speaker, _ = speaker_with(UnknownModule("ALTextToSpeech", "nao:9559", [], []))
    speaker.say("hello")
    assert [(record.levelno, record.getMessage()) for record in caplog.records] == [
        (logging.INFO, "the robot has no ALTextToSpeech, so this is not said: hello")
    ]


def test_what_goes_wrong_is_told(speaker_with, make_call, caplog):
    speaker, _ = speaker_with(RobotUnreachable("nao", 9559, "gone"))
    speaker.say("hello")
    failing = make_call()
    failing.end(error=RobotError("ALTextToSpeech", "say", "no voice"))
    speaker, _ = speaker_with(failing)
    speaker.say("hello")
    assert "gone" in caplog.records[0].getMessage()
    assert "no voice" in caplog.records[1].getMessage()
