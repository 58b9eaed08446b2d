"""ALAnimatedSpeech: speech with gestures that are real motions."""

from __future__ import annotations

import logging

import numpy as np
import pytest
from sounds import tone, until, write

from nao_sim_bridge.naoqi.speech.annotated_text import ANIMATION, CALL, MODE, TAG, Instruction, method_call, read

HEY = "animations/Stand/Gestures/Hey_1"
TEXT = "Hello, my name is Nao. Yes, I explain everything."
SOUND = "nao_library/chime"
QUIET = {"bodyLanguageMode": "disabled"}
END = "ALAnimatedSpeech/EndOfAnimatedSpeech"
MOVED = 0.1
"""From this on, in rad, a joint has moved."""


class Motion:
    """What the joints did while a text was said, rad; `difference` is the largest between after and before."""

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
    assert alone.ranges == {} and robot.ALMemory.getData(END) > 0
    motion = say(TEXT)
    assert motion.duration == pytest.approx(alone.duration, abs=0.12) and motion.difference < 1e-6
    arm = next(name for name in ("RShoulderPitch", "LShoulderPitch") if name in motion.ranges)
    assert motion.ranges[arm][0] < 0.6 and any(name.startswith("Head") for name in motion.ranges)
    assert not [name for name in motion.ranges if any(leg in name for leg in ("Hip", "Knee", "Ankle"))]
    measured = motion.measured[arm]  # the arms themselves follow
    assert measured.min() < 0.7 and np.abs(measured - motion.commands[arm]).max() < 0.3
    assert robot.ALRobotPosture.getPosture() == "Stand"


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


def test_wait_and_run_let_an_animation_come_to_its_end_and_stop_brings_the_arms_back(robot, speech, say, sentences):
    motion = say(f"^start({HEY}) One two ^stop({HEY}) three four five six seven eight nine ten eleven.", QUIET)
    assert motion.moving()[1] < motion.duration - 1.0 and motion.difference < 1e-6
    motion = say(f"^start({HEY}) Hi. ^wait({HEY}) Done.", QUIET)
    begin, end = motion.moving()
    assert end - begin == pytest.approx(2.5, abs=0.1)
    assert motion.duration > end + 0.2 and motion.ranges["RShoulderPitch"][0] < -0.55
    sentences.clear()
    speech.declareTagForAnimations({"ahoy": [HEY]})
    assert say("^runTag(ahoy) Ship.", QUIET).ranges["RShoulderPitch"][0] < -0.5
    sentences.clear()
    began = robot.now.time
    begin, end = say(f"One. ^run({HEY}) Two.", QUIET).moving()
    assert [text for text, _ in sentences] == ["One.", "Two."]
    assert sentences[0][1] - began < begin < end <= sentences[1][1] - began + 0.05
    assert end - begin == pytest.approx(2.5, abs=0.1)


def test_a_tag_may_have_a_path_and_a_leaning_gesture_leans_only_by_instruction(robot, say):
    assert say("^runTag(animations/Stand/Gestures, bow) Welcome.", QUIET).ranges["LHipPitch"][0] < -0.15
    robot.ALAnimatedSpeech.declareTagForAnimations({"ahoy": ["animations/Stand/Gestures/BowShort_1"]})
    robot.ALAnimatedSpeech.addTagsToWords({"ahoy": ["ship"]})
    ranges = say("Ship. The rest of this sentence is long enough for a bow.").ranges
    assert "LShoulderPitch" in ranges and "LHipPitch" not in ranges


def test_sounds_are_played_from_a_text_and_the_voice_waits_where_it_is_told_to(robot, say, sentences, caplog):
    times = lambda: robot.ALMemory.getData("NaoSimulation/SoundTimes")  # noqa: E731
    say(f"One. ^runSound({SOUND}) Two.", QUIET)
    onset, end = times()
    assert sentences[0][1] < onset < end <= sentences[1][1] + 0.2
    sentences.clear()
    say(f"^startSound({SOUND}, 40) One. ^waitSound({SOUND}) Two.", QUIET)
    assert sentences[0][1] < times()[1] <= sentences[1][1] + 0.2
    write(robot, "soundsets/mine/long.wav", tone(440.0, 20.0))
    robot.answer(robot.ALAudioPlayer.loadSoundSet("mine", _async=True))
    say("One. ^startSound(mine/long) Two and some more. ^stopSound(mine/long) Three.", QUIET)
    onset, end = times()
    assert sentences[-3][1] < onset < end <= sentences[-1][1] + 0.2
    say("One. ^runSound(nao_library/nothing) Two.", QUIET)
    assert sentences[-1][0] == "Two." and "is not played: " in caplog.text and "nothing" in caplog.text


def test_methods_can_be_called_from_a_text_and_what_is_unknown_is_left_out(robot, say, sentences, caplog):
    robot.ALLeds.on("FaceLeds")
    say('One ^call(ALLeds.setIntensity("FaceLeds", 0.25)) two.', QUIET)
    assert set(robot.ALLeds.getIntensity("FaceLeds")) == {0.25}
    say("One ^start(animations/Stand/Gestures/Somersault_1) two ^dance(salsa) three ^call(x) four.", QUIET)
    assert sentences[-1][0] == "One two three four."
    assert "Somersault_1" in caplog.text and "^dance" in caplog.text and "'x' is no call" in caplog.text


def test_body_language_has_three_modes(speech):
    for number, name in enumerate(["disabled", "random", "contextual"]):
        speech.setBodyLanguageMode(number)
        assert (speech.getBodyLanguageMode(), speech.getBodyLanguageModeToStr()) == (number, name)
        assert speech.isBodyLanguageEnabled() == speech.isBodyTalkEnabled() == (number > 0)
    speech.setBodyTalkEnabled(False)
    assert speech.getBodyLanguageModeToStr() == "disabled"
    speech.setBodyLanguageEnabled(True)
    assert speech.getBodyLanguageModeToStr() == "contextual"


def test_errors_name_what_is_wrong_and_what_is_allowed(speech, refused):
    rows = [
        ("setBodyLanguageMode", (3,), r"bodyLanguageMode is 3, allowed is one of 0 \(disabled\), 1 \(random\)"),
        ("say", ("x", {"bodyLanguageMode": "wild"}), "bodyLanguageMode is 'wild'"),
        ("say", ("x", {"mode": "random"}), "configuration is .*mode.*, allowed is a map like"),
        ("declareTagForAnimations", ({"x": [HEY.replace("y", "i")]},), f"unknown animation .* did you mean '{HEY}'"),
        ("addTagsToWords", ({"x": 1},), "is 1, allowed is a list of texts"),
        ("declareAnimationsPackage", ("none",), "no file 'none.json'"),
    ]
    refused("ALAnimatedSpeech", rows)
    assert speech.getBodyLanguageModeToStr() == "contextual"


def test_annotated_text_is_read():
    for written, expected in (
        ("^run( a )", Instruction("run", ANIMATION, "a")), ("^runTag(i don't)", Instruction("run", TAG, "i don't")),
        ("^mode(disabled)", Instruction("mode", MODE, "disabled")),
        ('^call(ALLeds.fade("a)", 1, (2)))', Instruction("call", CALL, 'ALLeds.fade("a)", 1, (2))')),
        ("^pCall(ALLeds.rasta(1.0))", Instruction("post", CALL, "ALLeds.rasta(1.0)")),
    ):  # fmt: skip
        assert read(f"before{written}behind ^wait(x) ") == [
            "before", expected, "behind ", Instruction("wait", ANIMATION, "x"), " "
        ]  # fmt: skip
    for text in ("2 ^ 3 is 8", "^start(never closed", "a^(b)"):
        assert read(text) == [text]
    assert method_call("ALMotion.setAngles(['HeadYaw'], [0.1], 0.2)") == (
        "ALMotion",
        "setAngles",
        [["HeadYaw"], [0.1], 0.2],
    )
    for text in ("ALLeds.on", "on()", "A.b(__import__('os'))"):
        with pytest.raises(ValueError, match="call|arguments"):
            method_call(text)
