"""ALAnimatedSpeech: speech with gestures that are real motions."""

from __future__ import annotations

import json
import logging

import numpy as np
import pytest
from sounds import until

from nao_sim_bridge.services.audio.annotated_text import ANIMATION, CALL, MODE, TAG, Instruction, method_call, read

HEY = "animations/Stand/Gestures/Hey_1"
TEXT = "Hello, my name is Nao. Yes, I explain everything."
QUIET = {"bodyLanguageMode": "disabled"}
END = "ALAnimatedSpeech/EndOfAnimatedSpeech"
MOVED = 0.1
"""From this on, in rad, a joint has moved."""


class Motion:
    """What the joints did while a text was said.

    Attributes:
        ranges: Name of a joint -> (smallest, largest) command, rad, for those that moved.
        difference: Largest difference between commands after and before, rad.
        duration: Of the call, s.
        measured: Name of a joint -> its angles, rad.
    """

    def __init__(self, names, trace, before, after, began):
        commands = np.array([snapshot.commands for snapshot in trace])
        self.times = np.array([snapshot.time for snapshot in trace]) - began
        self.commands = dict(zip(names, commands.T))
        self.measured = dict(zip(names, np.array([snapshot.positions for snapshot in trace]).T))
        self.ranges = {n: (c.min(), c.max()) for n, c in self.commands.items() if np.ptp(c) > MOVED}
        self.difference = np.abs(np.array(after) - before).max()
        self.duration = self.times[-1]

    def moving(self, joint="RShoulderPitch"):
        """First and last time that a joint moves, s."""
        moves = np.flatnonzero(np.abs(np.diff(self.commands[joint])) > 1e-4)
        return self.times[moves[0]], self.times[moves[-1]]


@pytest.fixture
def speech(stiff_robot):
    return stiff_robot.ALAnimatedSpeech


@pytest.fixture
def say(robot, speech):
    """Says a text and watches the joints."""
    simulation, names = robot.server.simulation, robot.ALMotion.getBodyNames("Body")

    def run(*arguments):
        trace, before, began = [], np.array(robot.now.commands), robot.now.time
        robot.server.runner.call(lambda: simulation.after_tick.append(trace.append))
        future = robot.post("ALAnimatedSpeech", "say", *arguments)
        robot.handed_over("ALAnimatedSpeech")
        until(robot, future)
        robot.server.runner.call(lambda: simulation.after_tick.remove(trace.append))
        return Motion(names, trace, before, robot.now.commands, began)

    return run


@pytest.fixture
def sentences(robot):
    """(sentence, time) of what is said."""
    found = []
    robot.server.memory.listen(
        "ALTextToSpeech/CurrentSentence", lambda value: found.append((value, robot.now.time)) if value else None
    )
    return found


def test_arms_and_head_move_along_in_the_time_of_the_speech_and_end_where_they_began(robot, say):
    alone = say(TEXT, QUIET)
    assert alone.ranges == {}
    motion = say(TEXT)
    assert motion.duration == pytest.approx(alone.duration, abs=0.12) and motion.difference < 1e-6
    assert motion.ranges["RShoulderPitch"][0] < -0.5 and any(name.startswith("Head") for name in motion.ranges)
    assert not [name for name in motion.ranges if any(leg in name for leg in ("Hip", "Knee", "Ankle"))]
    measured = motion.measured["RShoulderPitch"]  # the arms themselves follow
    assert measured.min() < -0.4 and np.abs(measured - motion.commands["RShoulderPitch"]).max() < 0.3
    assert robot.ALRobotPosture.getPosture() == "Stand"


@pytest.mark.parametrize("mode", [1, "random"])
def test_at_random_arms_move_whatever_is_said(say, mode):
    assert "ShoulderPitch" in " ".join(say("Tables are made of wood.", {"bodyLanguageMode": mode}).ranges)


def test_limp_arms_stay_where_they_are_and_it_is_told(robot, say, caplog):
    caplog.set_level(logging.INFO, logger="nao_sim.speech")
    robot.ALMotion.setStiffnesses(["LArm", "RArm", "Head"], 0.0)
    motion = say("Hello, my name is Nao.")
    assert not [name for name in motion.ranges if any(part in name for part in ("Elbow", "Shoulder", "Head"))]
    assert "speaks without gestures" in caplog.text and motion.duration > 1.0


def test_an_animation_starts_at_its_place_and_is_broken_off_at_the_end(say):
    motion = say(f"This is the first part of a text, and now ^start({HEY}) hello.", QUIET)
    begin, end = motion.moving()
    assert 1.5 < begin < motion.duration - 0.5
    assert motion.difference < 1e-6 and end == pytest.approx(motion.duration, abs=0.1)


def test_wait_lets_an_animation_run_to_its_end(say):
    motion = say(f"^start({HEY}) Hi. ^wait({HEY}) Done.", QUIET)
    begin, end = motion.moving()
    assert end - begin == pytest.approx(2.5, abs=0.1)
    assert motion.duration > end + 0.2 and motion.ranges["RShoulderPitch"][0] < -0.55


def test_run_suspends_the_speech(robot, say, sentences):
    began = robot.now.time
    begin, end = say(f"One. ^run({HEY}) Two.", QUIET).moving()
    assert [text for text, _ in sentences] == ["One.", "Two."]
    assert sentences[0][1] - began < begin < end <= sentences[1][1] - began + 0.05
    assert end - begin == pytest.approx(2.5, abs=0.1)


def test_stop_brings_the_arms_back_while_it_speaks(say):
    text = f"^start({HEY}) One two ^stop({HEY}) three four five six seven eight nine ten eleven."
    motion = say(text, QUIET)
    assert motion.moving()[1] < motion.duration - 1.0 and motion.difference < 1e-6


def test_a_tag_stands_for_an_animation_and_words_have_tags(speech, say):
    speech.declareTagForAnimations({"ahoy": [HEY]})
    assert say("^runTag(ahoy) Ship.", QUIET).ranges["RShoulderPitch"][0] < -0.5
    speech.addTagsToWords({"ahoy": ["ship"]})
    assert say("Look at the ship, which sails the sea all day.").ranges["RShoulderPitch"][0] < -0.5


def test_the_mode_changes_within_a_text(robot, say, sentences):
    began = robot.now.time
    motion = say(f"{TEXT} ^mode(disabled) Tables and chairs are made of wood.")
    assert max(motion.moving(name)[1] for name in motion.ranges) < sentences[-1][1] - began + 0.5


def test_methods_can_be_called_from_a_text_and_what_is_unknown_is_left_out(robot, say, sentences, caplog):
    robot.ALLeds.on("FaceLeds")
    say('One ^call(ALLeds.setIntensity("FaceLeds", 0.25)) two.', QUIET)
    assert set(robot.ALLeds.getIntensity("FaceLeds")) == {0.25}
    say("One ^start(animations/Stand/Gestures/Somersault_1) two ^dance(salsa) three ^call(x) four.", QUIET)
    assert sentences[-1][0] == "One two three four."
    assert "Somersault_1" in caplog.text and "^dance" in caplog.text and "'x' is no call" in caplog.text


def test_a_stop_is_silence_at_once_and_the_arms_go_back(robot, speech):
    before = np.array(robot.now.commands)
    future = robot.post("ALAnimatedSpeech", "say", TEXT)
    robot.handed_over("ALAnimatedSpeech")
    robot.advance(1.2)
    assert np.abs(np.array(robot.now.commands) - before).max() > 0.3
    future.cancel()
    future.wait(int(1000 * robot.patience))
    assert not future.isRunning() and not robot.server.speech.speaker.speaking
    robot.advance(2.0)
    assert np.abs(np.array(robot.now.commands) - before).max() < 1e-6


def test_a_motion_of_somebody_else_goes_first(robot, say):
    robot.post("ALMotion", "angleInterpolation", "RShoulderPitch", [0.0, 1.4], [1.0, 8.0], True)
    robot.handed_over("ALMotion")
    assert "RElbowYaw" not in say(TEXT).ranges


def test_the_end_is_an_event_with_the_number_of_the_text(robot, say):
    say("One.", QUIET)
    first = robot.ALMemory.getData(END)
    say("Two.", QUIET)
    assert robot.ALMemory.getData(END) > first > 0


def test_body_language_has_three_modes(speech):
    for number, name in enumerate(["disabled", "random", "contextual"]):
        speech.setBodyLanguageMode(number)
        assert (speech.getBodyLanguageMode(), speech.getBodyLanguageModeToStr()) == (number, name)
        assert speech.isBodyLanguageEnabled() == speech.isBodyTalkEnabled() == (number > 0)
    speech.setBodyTalkEnabled(False)
    assert speech.getBodyLanguageModeToStr() == "disabled"
    speech.setBodyLanguageEnabled(True)
    assert speech.getBodyLanguageModeToStr() == "contextual"


def test_animations_of_a_client_are_a_file(robot, speech, say):
    wave = {"length": 2.0, "joints": {"LShoulderPitch": {"times": [1.0], "angles": [0.0]}}}
    path = robot.server.files.folder / "mine.json"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps({"animations": {"mine/Lift": wave}}))
    speech.declareAnimationsPackage("mine")
    assert say("^run(mine/Lift) Done.", QUIET).ranges["LShoulderPitch"][0] == pytest.approx(0.0, abs=0.02)


def test_errors_name_what_is_wrong_and_what_is_allowed(speech, refused):
    rows = [
        ("setBodyLanguageMode", (3,), r"bodyLanguageMode is 3, allowed is one of 0 \(disabled\), 1 \(random\)"),
        ("setBodyLanguageModeFromStr", ("wild",), "bodyLanguageMode is 'wild'"),
        ("say", ("x", {"bodyLanguageMode": "wild"}), "bodyLanguageMode is 'wild'"),
        ("say", ("x", {"mode": "random"}), "configuration is .*mode.*, allowed is a map like"),
        ("say", ("x", 1), "configuration is 1, allowed is a map like"),
        ("declareTagForAnimations", ({"x": ["nothing"]},), f"animation is 'nothing', allowed is one of .*{HEY}"),
        ("declareTagForAnimations", (["x"],), "a map of tags to lists"),
        ("addTagsToWords", ({"x": 1},), "is 1, allowed is a list of texts"),
        ("declareAnimationsPackage", ("none",), "no file 'none.json'"),
    ]
    refused("ALAnimatedSpeech", rows)
    assert speech.getBodyLanguageModeToStr() == "contextual"


# --- annotated text, read ---------------------------------------------------------------------------------------------


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
def test_each_instruction_is_read_at_its_place(written, expected):
    assert read(written) == [expected]
    assert read(f"before{written}behind ^wait(x) ") == [
        "before",
        expected,
        "behind ",
        Instruction("wait", ANIMATION, "x"),
        " ",
    ]


@pytest.mark.parametrize("text", ["2 ^ 3 is 8", "^ (a)", "^start", "^start(never closed", "a^(b)", ""])
def test_what_is_no_instruction_is_text(text):
    assert read(text) == ([text] if text else [])


def test_a_call_is_taken_apart_and_what_is_none_is_refused():
    assert method_call('ALLeds.fadeRGB("FaceLeds", "red", 0.5)') == ("ALLeds", "fadeRGB", ["FaceLeds", "red", 0.5])
    assert method_call("ALTextToSpeech.stopAll()") == ("ALTextToSpeech", "stopAll", [])
    assert method_call("ALMotion.setAngles(['HeadYaw'], [0.1], 0.2)")[2] == [["HeadYaw"], [0.1], 0.2]
    for text in ("ALLeds", "ALLeds.on", "on()", "ALLeds.on(open('x'))", "ALLeds.on(1", "A.b(__import__('os'))"):
        with pytest.raises(ValueError, match="call|arguments"):
            method_call(text)
