"""Goals that speak: how long, which words, how it is silenced, how it sounds; and gestures that go with it."""

from __future__ import annotations

import numpy as np
import pytest
from goal_functions import audio_out as f
from sounds import loudness, played, span

TEXT = "The quick brown fox jumps over the lazy dog."
WORDS = TEXT.rstrip(".").split()
HEY = "^start(animations/Stand/Gestures/Hey_1)"
MESSAGE = 0.1


def words(goal):
    return [told.word.strip(".") for told in goal.feedback if told.word]


def step(robot, goal, until=lambda: False, limit=20.0):
    """Let time pass in small steps, in which events come, until something holds or the goal is over."""
    end = robot.now.time + limit
    while goal.active and not until():
        assert robot.now.time < end
        robot.advance(0.05)
        for _ in range(3):
            robot.proxy("ALMemory").ping()
    return goal


def sounding(robot, audio, *functions):
    """When the sound of a goal began and ended, and its result, after some silence."""
    begun = robot.now.time
    result = audio.succeed(*functions)
    ended = robot.now.time
    first, last = span(robot, begun)
    assert first - begun < 0.3 and ended - last < 0.6
    robot.advance(0.1)
    return first, last, result


def test_a_goal_lasts_as_long_as_its_texts_which_follow_each_other(robot, audio):
    begun = robot.now.time
    result = audio.succeed(f("say", "One.", time=0.5), f("say", "Two."))
    elapsed = [each.elapsed.to_sec() for each in result.results]
    assert robot.now.time - begun == pytest.approx(sum(elapsed) + 0.5, abs=MESSAGE) and min(elapsed) > 0.3
    second = begun + elapsed[0] + 0.5
    assert not played(robot, second - 0.45, second - 0.05).any()
    for first in (begun, second):
        assert loudness(played(robot, first, first + 0.4)) > 0.01
    assert (result.volume, result.memList, result.files) == (100.0, [], [])


@pytest.mark.parametrize("stiffness, text", [(0.0, "no gestures, as head and arms are limp"), (1.0, "")])
def test_gestures_that_limp_arms_do_not_make_are_told(robot, audio, stiffness, text):
    robot.ALMotion.setStiffnesses("Arms", stiffness)
    goal = audio.send(f("animatedSay", "Yes.")).finish()
    assert goal.state == "succeeded" and goal.text.startswith(text) and bool(goal.text) == bool(text)


def test_words_are_fed_back_as_they_are_spoken_and_those_of_others_are_not(robot, audio):
    goal = step(robot, audio.send(f("getVoice"), f("say", TEXT))).finish()
    assert goal.state == "succeeded" and words(goal) == WORDS
    told = [each for each in goal.feedback if each.word]
    assert {(each.index, each.function, each.count, each.sentence) for each in told} == {(1, "say", 2, TEXT)}
    assert [(each.index, each.function) for each in goal.feedback[:2]] == [(0, "getVoice"), (1, "say")]
    other = robot.post("ALTextToSpeech", "say", "Gossip.")
    quiet = step(robot, audio.send(f("getVoice", time=1.5))).finish()
    robot.answer(other)
    assert words(quiet) == [] and quiet.state == "succeeded"


def test_a_goal_that_is_cancelled_is_silent_at_once_and_nothing_else_is(robot, audio):
    hum = robot.post("ALAudioPlayer", "playSine", 500, 2, 0, 10.0)
    goal = audio.send(f("say", f"{TEXT} {TEXT}", voice="kal", volume=0.5), f("say", "never"))
    step(robot, goal, lambda: "fox" in words(goal))
    speech = robot.ALTextToSpeech
    assert (speech.getVoice(), speech.getVolume()) == ("kal", 0.5)
    goal.cancel()
    assert (goal.state, goal.text) == ("preempted", "preempted in function 1 (say)")
    assert (speech.getVoice(), speech.getVolume()) == ("naoenu", 1.0)
    cancelled = robot.now.time
    robot.advance(1.0)
    before, after = played(robot, cancelled - 0.5, cancelled), played(robot, cancelled + MESSAGE)
    alone = loudness(after)
    assert loudness(before) > 2.0 * alone and hum.isRunning()
    for tenth in np.array_split(after, 10):
        assert loudness(tenth) == pytest.approx(alone, rel=0.03)
    robot.ALAudioPlayer.stopAll()


def test_how_a_text_is_spoken_is_for_this_text_only(robot, audio):
    speech = robot.ALTextToSpeech

    def settings():
        return speech.getLanguage(), speech.getVoice(), speech.getVolume(), speech.getParameter("speed")

    before = settings()
    chains = [{}, {"speed": 200.0}, {"volume": 0.25}, {"voice": "rms"}, {"pitch": 150.0}, {}]
    chains.append({"voice": "rms", "language": "French"})  # the voice says in which language
    spans = [sounding(robot, audio, f("say", "The lazy dog runs away.", **fields))[:2] for fields in chains]
    sounding(robot, audio, f("say", "Bonjour.", language="French"))
    assert settings() == before
    lengths, heard = [last - first for first, last in spans], [loudness(played(robot, *each)) for each in spans]
    crossings = [np.mean(np.diff(np.sign(played(robot, *each)), axis=0) != 0) for each in spans]  # of zero: its pitch
    assert lengths[1] / lengths[0] == pytest.approx(0.5, abs=0.12)
    assert heard[2] / heard[0] == pytest.approx(0.25, abs=0.02)
    assert abs(lengths[3] / lengths[0] - 1.0) > 0.02
    assert lengths[6] == pytest.approx(lengths[3], abs=0.02)
    assert lengths[4] == pytest.approx(lengths[0], abs=0.05) and crossings[4] / crossings[0] > 1.03
    assert lengths[5] == pytest.approx(lengths[0], abs=0.02) and heard[5] == pytest.approx(heard[0], rel=0.02)


def arm(robot):
    return np.array(robot.ALMotion.getAngles("RArm", True))


def test_gestures_go_with_a_text_and_end_when_it_is_cancelled(stiff_robot, audio):
    robot, before = stiff_robot, arm(stiff_robot)
    goal = audio.send(f("animatedSay", f"{HEY} {TEXT} {TEXT}", body_language="disabled", speed=90.0))
    step(robot, goal, lambda: "jumps" in words(goal))
    assert np.abs(arm(robot) - before).max() > 0.3
    assert goal.cancel().state == "preempted"
    robot.advance(3.0)
    at = arm(robot)
    robot.advance(0.5)
    assert np.abs(arm(robot) - at).max() < 0.01 and np.abs(at - before).max() < 0.1
