"""Text with instructions, read."""

from __future__ import annotations

import pytest

from nao_sim_bridge.services.audio.annotated_text import ANIMATION, CALL, MODE, TAG, Instruction, method_call, read

HEY = "animations/Stand/Gestures/Hey_1"


def test_text_and_instructions_stay_in_their_order():
    assert read(f"Hello! ^start({HEY}) Nice to meet you ^wait({HEY})") == [
        "Hello! ",
        Instruction("start", ANIMATION, HEY),
        " Nice to meet you ",
        Instruction("wait", ANIMATION, HEY),
    ]


@pytest.mark.parametrize(
    "written, expected",
    [
        ("^run( a )", Instruction("run", ANIMATION, "a")),
        ("^stop(a)", Instruction("stop", ANIMATION, "a")),
        ("^startTag(hello)", Instruction("start", TAG, "hello")),
        ("^runTag(i don't know)", Instruction("run", TAG, "i don't know")),
        ("^mode(disabled)", Instruction("mode", MODE, "disabled")),
        ('^call(ALLeds.fade("a)", 1, (2)))', Instruction("call", CALL, 'ALLeds.fade("a)", 1, (2))')),
        ("^pCall(ALLeds.rasta(1.0))", Instruction("post", CALL, "ALLeds.rasta(1.0)")),
    ],
)
def test_each_instruction_is_read(written, expected):
    assert read(written) == [expected]
    assert read(f"before{written}behind") == ["before", expected, "behind"]


@pytest.mark.parametrize("text", ["2 ^ 3 is 8", "^ (a)", "^start", "^start(never closed", "a^(b)", ""])
def test_what_is_no_instruction_is_text(text):
    assert read(text) == ([text] if text else [])


def test_an_unknown_instruction_is_not_spoken(caplog):
    assert read("one ^dance(salsa) two") == ["one ", " two"]
    assert "^dance(salsa)" in caplog.text and "^start" in caplog.text


def test_a_call_is_taken_apart():
    assert method_call('ALLeds.fadeRGB("FaceLeds", "red", 0.5)') == ("ALLeds", "fadeRGB", ["FaceLeds", "red", 0.5])
    assert method_call("ALTextToSpeech.stopAll()") == ("ALTextToSpeech", "stopAll", [])
    assert method_call("ALMotion.setAngles(['HeadYaw'], [0.1], 0.2)")[2] == [["HeadYaw"], [0.1], 0.2]


@pytest.mark.parametrize(
    "text", ["ALLeds", "ALLeds.on", "on()", "ALLeds.on(open('x'))", "ALLeds.on(1", "A.b(__import__('os'))"]
)
def test_what_is_no_call_is_refused(text):
    with pytest.raises(ValueError, match="call|arguments"):
        method_call(text)
