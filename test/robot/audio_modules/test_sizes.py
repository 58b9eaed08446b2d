"""Texts, lists and buffers that clients send are bounded, each with what is allowed in the refusal."""

from __future__ import annotations

from dataclasses import replace

import pytest

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.naoqi.binding.limits import check_sizes
from nao_sim_bridge.speech import studio


def nested(levels):
    value = 1
    for _ in range(levels):
        value = [value]
    return value


@pytest.mark.parametrize(
    "argument, told",
    [
        ("x" * 1_000_001, "a text of the arguments is '1000001 characters', allowed is 1000000 characters at most"),
        ({"key": ["x" * 1_000_001]}, "a text of the arguments"),
        (bytes(67_108_865), "a buffer of the arguments"),
        ([[0.0] * 500_000] * 2, "a call of the arguments is '1000003 items', allowed is 1000000 items at most"),
        (nested(52), "a list of the arguments is '51 levels', allowed is 50 levels at most"),
    ],
    ids=["text", "inner text", "buffer", "items", "levels"],
)
def test_arguments_are_bounded_together(argument, told):
    with pytest.raises(BadValue, match=told):
        check_sizes((argument,))


def test_what_clients_need_is_within_the_bounds():
    check_sizes(("say", "x" * 1_000_000, bytes(15_000_000), [[0.1] * 1000] * 26, {"a": [1, (2.0, None)]}, nested(40)))


def test_calls_over_the_network_are_bounded(robot):
    with pytest.raises(RuntimeError, match="ALMemory::insertData a text of the arguments is '1000001 characters'"):
        robot.ALMemory.insertData("Mine", "x" * 1_000_001)
    assert "Mine" not in robot.ALMemory.getDataListName()


def test_speech_and_what_is_listened_for_are_bounded(robot, refused):
    refused("ALTextToSpeech", [("say", ("word " * 2001,), r"text is 'word word .*10005 characters', allowed is 10000")])
    refused("ALTextToSpeech", [("sayToFile", ("word " * 2001, "a.wav"), "allowed is 10000 characters at most")])
    refused(
        "ALTextToSpeech",
        [("sayToFile", (r"a \pau=60000\ b" * 20, "a.wav"), "with 1200 s of pauses', allowed is 600 s")],
    )
    refused(
        "ALSpeechRecognition",
        [
            ("setVocabulary", ([f"word {i}" for i in range(1001)], False), "'1001 phrases', allowed is 1000 at most"),
            ("setVocabulary", (["x" * 201], False), "200 characters at most"),
        ],
    )


def test_speech_for_a_file_ends_at_its_length(robot, refused, monkeypatch):
    speech = replace(load_sizes().speech, file_s=0.5)
    monkeypatch.setattr(studio, "load_sizes", lambda: replace(load_sizes(), speech=speech))
    refused("ALTextToSpeech", [("sayToFile", ("One. Two. Three.", "a.wav"), "takes more than 0.5 s to say")])


def test_contexts_are_put_aside_and_words_learnt_up_to_a_number(robot, refused):
    for _ in range(32):
        robot.ALSpeechRecognition.pushContexts()
    refused("ALSpeechRecognition", [("pushContexts", (), "put aside 32 times, .*; popContexts first")])
    for number in range(1000):
        robot.ALTextToSpeech.addToDictionary(f"word{number}", "other")
    refused("ALTextToSpeech", [("addToDictionary", ("more", "other"), "has 1000 words, .*deleteFromDictionary")])
    assert robot.ALTextToSpeech.addToDictionary("word0", "another")
