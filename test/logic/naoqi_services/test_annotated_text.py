"""Texts with instructions, before a voice and a robot have them."""

from __future__ import annotations

import random
import time

import pytest

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.naoqi.speech.animated_talk import AnimatedTalk
from nao_sim_bridge.naoqi.speech.annotated_text import (
    Instruction,
    method_call,
    path_and_tag,
    read,
    sound_and_volume,
)
from nao_sim_bridge.speech.animations import load_animations
from nao_sim_bridge.speech.clips import Style
from nao_sim_bridge.speech.sentences import Sentence
from nao_sim_bridge.speech.studio import Studio

SHUTDOWN = "Good ^call(ALSystem.shutdown()) night ^pCall(ALSystem.reboot())."


def items_of(text, call=None):
    studio, posture = Studio(object()), lambda: "Stand"
    return AnimatedTalk(
        text, Style(None), "disabled", studio, load_animations(), random.Random(0), call, lambda *_: None, posture
    )._items


def test_a_behaviour_calls_no_methods_and_who_calls_the_robot_does():
    assert [type(item) for item in items_of(SHUTDOWN)] == [Sentence]
    assert len(items_of(SHUTDOWN, call=lambda *_: None)) == 3  # a sentence, a gate at which it waits, a sentence


def test_tags_may_have_a_path_and_sounds_a_volume():
    assert path_and_tag("hello") == (None, "hello")
    assert path_and_tag("animations/Stand , hello") == ("animations/Stand", "hello")
    assert sound_and_volume("mine/bell") == ("mine/bell", 1.0) and sound_and_volume("bell, 50") == ("bell", 0.5)
    for text in ("bell, loud", "bell, 101", "bell, -1"):
        with pytest.raises(ValueError, match="no volume, which is 0 to 100"):
            sound_and_volume(text)


@pytest.mark.parametrize(
    "text, told", [("word " * 2001, "10005 characters"), (r"a \pau=60000\ " * 20, "1200 s of pauses")]
)
def test_a_text_with_gestures_is_bounded_as_one_without(text, told):
    with pytest.raises(BadValue, match=told):
        items_of(text)


def test_instructions_that_never_end_are_text_and_take_no_time():
    began = time.process_time()
    (text,) = read("^a(" * 8000)
    assert len(text) == 24000 and time.process_time() - began < 1.0
    assert Instruction("mode", "mode", "x") in read("2 ^a( ^b( ^mode(x)")


def test_arguments_that_are_none_are_refused_however_deep_they_nest():
    for arguments in ("(" * 5000, "[" * 900 + "]" * 900, "-" * 1900 + "1", "{[]: 1}", "1 +"):
        with pytest.raises(ValueError, match="arguments"):
            method_call(f"A.b({arguments})")
