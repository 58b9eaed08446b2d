"""When what the robot says and plays is to be heard: in results, and of each word in the feedback."""

from __future__ import annotations

import numpy as np
import pytest
from goal_functions import audio_out as f
from sounds import RATE, played, tone, write

from nao_library_actions.msg import NaoAudioOutGoal
from nao_library_modules.audio_out.audio_out_server import NaoAudioOutput

EXACT = 0.06


def heard(robot, begin):
    """Simulated times of the first and the last sound since `begin` that is no pause of an engine, s."""
    samples = np.abs(played(robot, begin)).max(axis=1)
    loud = np.flatnonzero(samples > 0.02 * samples.max()) / RATE
    return [begin + loud[0], begin + loud[-1]]


def happened(done):
    return [done.onset.to_sec(), done.offset.to_sec()]


@pytest.mark.parametrize("function", ["say", "animatedSay", "sayToFileAndPlay"])
def test_speech_has_the_times_of_its_first_and_its_last_sound(robot, audio, function):
    robot.advance(0.5)
    begin = robot.now.time
    (done,) = audio.succeed(f(function, "Good morning. This is a test.")).results
    assert happened(done) == pytest.approx(heard(robot, begin), abs=EXACT)
    assert begin <= done.onset.to_sec() < done.offset.to_sec() <= robot.now.time


def test_feedback_has_the_times_at_which_words_begin(robot, audio):
    begin = robot.now.time
    goal = audio.send(f("say", "Good morning."))
    goal.finish()
    words = [(told.word, told.stamp.to_sec()) for told in goal.feedback if told.word]
    assert [word.strip(".") for word, _ in words] == ["Good", "morning"]
    first, last = heard(robot, begin)
    assert words[0][1] == pytest.approx(first, abs=EXACT) and words[0][1] < words[1][1] < last


def test_a_file_has_the_times_of_its_first_and_its_last_sample(robot, audio):
    write(robot, "tone.wav", tone(500.0, 0.7))
    begin = robot.now.time
    done, in_background, written = audio.succeed(
        f("playFile", "tone.wav", time=0.3),
        f("say", "One.", background=True),
        f("sayToFile", "Two.", file_name="a.wav"),
    ).results
    assert happened(done) == pytest.approx([begin, begin + 0.7], abs=EXACT)
    assert happened(in_background) == happened(written) == [0.0, 0.0]


def test_a_robot_that_tells_less_has_the_times_of_its_events(robot, goals_to):
    robot.ALMemory.removeData("NaoSimulation/SpeechTimes")
    audio = goals_to(NaoAudioOutput, NaoAudioOutGoal)
    began = robot.now.time
    (done,) = audio.succeed(f("say", "Good morning.")).results
    first, last = heard(robot, began)
    assert done.onset.to_sec() == pytest.approx(first, abs=EXACT)
    assert last - EXACT < done.offset.to_sec() <= robot.now.time
