"""ALAnimatedSpeech over the network: speech with gestures that are real motions."""

from __future__ import annotations

import json
import logging
import time

import numpy as np
import pytest

HEY = "animations/Stand/Gestures/Hey_1"
TEXT = "Hello, my name is Nao. Yes, I explain everything that somebody wants to hear about robots."
END = "ALAnimatedSpeech/EndOfAnimatedSpeech"
MOVED = 0.1
"""From this on, in rad, a joint has moved."""


class Motion:
    """What the joints did while a text was said.

    Attributes:
        times: (n,) s from the beginning of the call.
        ranges: Name of a joint -> (smallest, largest) command, rad, for those that moved.
        difference: Largest difference between commands after and before, rad.
        duration: Of the call, s.
    """

    def __init__(self, names, trace, before, after, began):
        commands = np.array([snapshot.commands for snapshot in trace])
        self.trace = trace
        self.times = np.array([snapshot.time for snapshot in trace]) - began
        self.commands = dict(zip(names, commands.T))
        self.ranges = {n: (c.min(), c.max()) for n, c in self.commands.items() if np.ptp(c) > MOVED}
        self.difference = np.abs(np.array(after) - before).max()
        self.duration = self.times[-1]

    def moving(self, joint):
        """First and last time that a joint moves, s."""
        moves = np.flatnonzero(np.abs(np.diff(self.commands[joint])) > 1e-4)
        return self.times[moves[0]], self.times[moves[-1]]


@pytest.fixture
def speech(stiff_robot):
    stiff_robot.ALAnimatedSpeech.setBodyLanguageModeFromStr("contextual")
    yield stiff_robot.ALAnimatedSpeech
    stiff_robot.ALTextToSpeech.stopAll()


@pytest.fixture
def say(robot):
    """Says a text and watches the joints."""
    simulation, names = robot.server.simulation, robot.ALMotion.getBodyNames("Body")

    def run(*arguments, limit=30.0):
        trace = []
        before, began = np.array(robot.now.commands), robot.now.time
        robot.server.runner.call(lambda: simulation.after_tick.append(trace.append))
        future = robot.post("ALAnimatedSpeech", "say", *arguments)
        robot.handed_over("ALAnimatedSpeech")
        while future.isRunning() and robot.now.time < began + limit:
            robot.advance(0.05)
        robot.answer(future)
        robot.server.runner.call(lambda: simulation.after_tick.remove(trace.append))
        return Motion(names, trace, before, robot.now.commands, began)

    return run


def cancel(robot, future):
    """Cancel a call and return when it is over, without time passing."""
    future.cancel()
    give_up = time.monotonic() + robot.patience
    while future.isRunning() and time.monotonic() < give_up:
        robot.settled()


def sentences(robot, since):
    """(sentence, time from then on) of what was said."""
    history = robot.server.memory.history("ALTextToSpeech/CurrentSentence")
    return [(value, time - since) for value, time in history if time >= since]


def test_arms_and_head_move_along_and_end_where_they_began(robot, speech, say):
    motion = say(TEXT)
    assert motion.difference < 1e-6
    assert motion.ranges["RShoulderPitch"][0] < -0.5
    assert any(name.startswith("Head") for name in motion.ranges)
    assert not [name for name in motion.ranges if any(leg in name for leg in ("Hip", "Knee", "Ankle"))]
    assert robot.ALRobotPosture.getPosture() == "Stand"


def test_the_arms_themselves_follow(robot, speech, say):
    motion = say(TEXT)
    index = robot.server.simulation.model.joint_index["RShoulderPitch"]
    measured = np.array([snapshot.positions[index] for snapshot in motion.trace])
    assert measured.min() < -0.4
    assert np.abs(measured - motion.commands["RShoulderPitch"]).max() < 0.3


def test_gestures_fit_the_length_of_the_speech(robot, speech, say):
    alone = say(TEXT, {"bodyLanguageMode": "disabled"})
    assert alone.ranges == {}
    assert say(TEXT).duration == pytest.approx(alone.duration, abs=0.12)


@pytest.mark.parametrize("mode", [1, "random"])
def test_at_random_arms_move_whatever_is_said(speech, say, mode):
    assert "ShoulderPitch" in " ".join(
        say("Tables and chairs are made of wood or of metal.", {"bodyLanguageMode": mode}).ranges
    )


def test_limp_arms_stay_where_they_are_and_it_is_told(robot, speech, say, caplog):
    caplog.set_level(logging.INFO, logger="nao_sim.speech")
    robot.ALMotion.setStiffnesses(["LArm", "RArm", "Head"], 0.0)
    motion = say(TEXT)
    assert not [name for name in motion.ranges if "Arm" in name or "Shoulder" in name or "Head" in name]
    assert "speaks without gestures" in caplog.text and motion.duration > 3.0


def test_an_animation_starts_at_its_place_and_is_broken_off_at_the_end(speech, say):
    quiet = {"bodyLanguageMode": "disabled"}
    motion = say(f"This is the first part of a text, and now ^start({HEY}) hello.", quiet)
    begin, end = motion.moving("RShoulderPitch")
    assert 1.5 < begin < motion.duration - 0.5
    assert motion.difference < 1e-6 and end == pytest.approx(motion.duration, abs=0.1)


def test_wait_lets_an_animation_run_to_its_end(speech, say):
    quiet = {"bodyLanguageMode": "disabled"}
    motion = say(f"^start({HEY}) Hi. ^wait({HEY}) Done.", quiet)
    begin, end = motion.moving("RShoulderPitch")
    assert end - begin == pytest.approx(2.5, abs=0.1)
    assert motion.duration > end + 0.2 and motion.ranges["RShoulderPitch"][0] < -0.55


def test_run_suspends_the_speech(robot, speech, say):
    began = robot.now.time
    motion = say(f"One. ^run({HEY}) Two.", {"bodyLanguageMode": "disabled"})
    begin, end = motion.moving("RShoulderPitch")
    (first, second) = sentences(robot, began)
    assert first[0] == "One." and second[0] == "Two."
    assert first[1] < begin < end <= second[1] + 0.05
    assert end - begin == pytest.approx(2.5, abs=0.1)


def test_stop_brings_the_arms_back_while_it_speaks(speech, say):
    text = f"^start({HEY}) One two ^stop({HEY}) three four five six seven eight nine ten eleven twelve."
    motion = say(text, {"bodyLanguageMode": "disabled"})
    assert motion.moving("RShoulderPitch")[1] < motion.duration - 1.0
    assert motion.difference < 1e-6


def test_a_tag_stands_for_an_animation_and_words_have_tags(speech, say):
    speech.declareTagForAnimations({"ahoy": [HEY]})
    quiet = {"bodyLanguageMode": "disabled"}
    assert say("^runTag(ahoy) Ship.", quiet).ranges["RShoulderPitch"][0] < -0.5
    speech.addTagsToWords({"ahoy": ["ship"]})
    assert say("Look at the ship, which sails the sea all day.").ranges["RShoulderPitch"][0] < -0.5


def test_the_mode_changes_within_a_text(robot, speech, say):
    began = robot.now.time
    motion = say(f"{TEXT} ^mode(disabled) Tables and chairs are made of wood or of metal.")
    last = sentences(robot, began)[-1][1]
    assert max(motion.moving(name)[1] for name in motion.ranges) < last + 0.5


def test_methods_can_be_called_from_a_text(robot, speech, say):
    robot.ALLeds.on("FaceLeds")
    say('One ^call(ALLeds.setIntensity("FaceLeds", 0.25)) two.')
    assert set(robot.ALLeds.getIntensity("FaceLeds")) == {0.25}


def test_what_is_unknown_is_left_out_and_told(speech, say, caplog, robot):
    began = robot.now.time
    say("One ^start(animations/Stand/Gestures/Somersault_1) two ^dance(salsa) three ^call(x) four.")
    assert [text for text, _ in sentences(robot, began)] == ["One two three four."]
    assert "Somersault_1" in caplog.text and "^dance" in caplog.text and "'x' is no call" in caplog.text


def test_a_stop_is_silence_at_once_and_the_arms_go_back(robot, speech):
    before = np.array(robot.now.commands)
    future = robot.post("ALAnimatedSpeech", "say", TEXT)
    robot.handed_over("ALAnimatedSpeech")
    robot.advance(1.2)
    assert np.abs(np.array(robot.now.commands) - before).max() > 0.3
    cancel(robot, future)
    assert not robot.server.speech.speaker.speaking
    robot.advance(2.0)
    assert np.abs(np.array(robot.now.commands) - before).max() < 1e-6


def test_a_motion_of_somebody_else_goes_first(robot, speech, say):
    robot.post("ALMotion", "angleInterpolation", "RShoulderPitch", [0.0, 1.4], [1.0, 8.0], True)
    robot.handed_over("ALMotion")
    motion = say(TEXT)
    assert "RElbowYaw" not in motion.ranges


def test_the_end_is_an_event_with_the_number_of_the_text(robot, speech, say):
    say("One.", {"bodyLanguageMode": "disabled"})
    first = robot.ALMemory.getData(END)
    say("Two.", {"bodyLanguageMode": "disabled"})
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
    path.write_text(json.dumps({"animations": {"mine/Lift": wave}}))
    speech.declareAnimationsPackage("mine")
    motion = say("^run(mine/Lift) Done.", {"bodyLanguageMode": "disabled"})
    assert motion.ranges["LShoulderPitch"][0] == pytest.approx(0.0, abs=0.02)


@pytest.mark.parametrize(
    "method, arguments, problem",
    [
        ("setBodyLanguageMode", (3,), r"bodyLanguageMode is 3, allowed is one of 0 \(disabled\), 1 \(random\)"),
        ("setBodyLanguageModeFromStr", ("wild",), "bodyLanguageMode is 'wild'"),
        ("say", ("x", {"bodyLanguageMode": "wild"}), "bodyLanguageMode is 'wild'"),
        ("say", ("x", {"mode": "random"}), "configuration is .*mode.*, allowed is a map like"),
        ("say", ("x", 1), "configuration is 1, allowed is a map like"),
        ("declareTagForAnimations", ({"x": ["nothing"]},), f"animation is 'nothing', allowed is one of .*{HEY}"),
        ("declareTagForAnimations", (["x"],), "a map of tags to lists"),
        ("addTagsToWords", ({"x": 1},), "is 1, allowed is a list of texts"),
        ("declareAnimationsPackage", ("none",), "no file 'none.json'"),
    ],
)
def test_errors_name_what_is_wrong_and_what_is_allowed(speech, method, arguments, problem):
    with pytest.raises(RuntimeError, match=problem):
        speech.call(method, *arguments)
