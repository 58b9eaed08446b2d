"""Goals that play: how long, how loud, from which side; loops, pauses, the background, and what is silenced."""

from __future__ import annotations

import numpy as np
import pytest
from goal_functions import audio_out as f
from sounds import frequency, loudness, played, span, tone, write

FULL, LENGTH = 0.5 / np.sqrt(2.0), 1.0
MESSAGE = 0.1
"""Simulated s in which the end of a goal is known, and no more."""


@pytest.fixture(autouse=True)
def files(robot):
    write(robot, "tone.wav", tone(440.0, LENGTH))
    write(robot, "short.wav", tone(440.0, 0.3))
    write(robot, "long.wav", tone(440.0, 4.0))


@pytest.fixture
def levels(robot):
    """Levels of both sides in the middle of what was played since a time, as parts of the file's."""

    def of(begun):
        first, last = span(robot, begun)
        middle = played(robot, first + 0.05, last - 0.05)
        return [loudness(side) / FULL for side in middle.T]

    return of


def test_a_file_is_played_to_its_end(robot, audio):
    begun = robot.now.time
    result = audio.succeed(f("playFile", " tone.wav "), f("playFile", "short.wav"))
    first, last = span(robot, begun)
    assert last - first == pytest.approx(LENGTH + 0.3, abs=0.05) and first - begun < 0.05
    assert frequency(played(robot, first, first + 1.0)[:, 0]) == pytest.approx(440.0, abs=1.0)
    assert loudness(played(robot, first + 0.1, first + 0.9)) == pytest.approx(FULL, rel=0.01)
    assert result.files == ["tone.wav", "short.wav"] and result.durations == pytest.approx([1.0, 0.3], abs=0.05)
    assert [each.elapsed.to_sec() for each in result.results] == pytest.approx([1.0, 0.3], abs=0.05)
    assert (result.volume, result.memList) == (100.0, [])


@pytest.mark.parametrize(
    "function, seconds, left, right",
    [
        (f("playFile", "tone.wav", pan=-1.0, duration=0.5), 0.5, 1.0, 0.0),
        (f("playFile", "tone.wav", pan=1.0, volume=0.2, duration=2.0), 1.0, 0.0, 0.2),
        (f("playFileFromPosition", "tone.wav", position=0.5, volume=0.5), 0.5, 0.5, 0.5),
        (f("playFileInLoop", "short.wav", duration=0.8, volume=0.5), 0.8, 0.5, 0.5),
        (f("playSine", frequency=800, volume=0.25, duration=0.4, pan=1), 0.4, 0.0, 0.5),
        (f("playSoundSetFile", "beeps", file_name="beep", position=0.1, pan=-1.0), 0.2, 1.0, 0.0),
    ],
)
def test_a_sound_has_its_length_level_and_side(robot, audio, levels, function, seconds, left, right):
    write(robot, "soundsets/beeps/beep.wav", tone(440.0, 0.3))
    begun = robot.now.time
    result = audio.succeed(function)
    assert robot.now.time - begun == pytest.approx(seconds, abs=MESSAGE)
    assert result.results[0].elapsed.to_sec() == pytest.approx(seconds, abs=0.05)
    assert levels(begun) == pytest.approx([left, right], abs=0.03)
    if function.function == "playSine":
        assert result.files == []
        assert frequency(played(robot, begun + 0.1, begun + 0.35)[:, 1]) == pytest.approx(800.0, abs=4.1)
    else:
        names = {"playSoundSetFile": ["beeps/beep"]}
        assert result.files == names.get(function.function, [function.str_param])
        assert result.durations == pytest.approx([seconds], abs=0.05)


def test_volumes_multiply_and_a_muted_robot_takes_as_long(robot, audio, levels):
    begun = robot.now.time
    chain = f("setOutputVolume", volume=50), f("setMasterVolume", volume=0.5), f("playFile", "short.wav")
    audio.succeed(f("setPanorama", pan=-1.0), f("playFile", "short.wav", pan=0.5), f("setPanorama"))
    assert levels(begun) == pytest.approx([1.0, 0.5], abs=0.01)
    begun = robot.now.time
    result = audio.succeed(*chain, f("getOutputVolume"), f("getMasterVolume"))
    assert (result.memList, result.volume) == (["50", "0.5"], 50.0)
    assert levels(begun) == pytest.approx([0.25, 0.25], abs=0.01)
    begun = robot.now.time
    result = audio.succeed(f("muteAudioOut", enable=True), f("playFile", "tone.wav"), f("isAudioOutMuted"))
    assert result.memList == ["True"] and result.results[1].elapsed.to_sec() == pytest.approx(LENGTH, abs=0.05)
    assert not played(robot, begun + 0.1).any()


def test_a_loop_sounds_on_after_its_goal_until_it_is_stopped(robot, audio):
    begun = robot.now.time
    assert audio.succeed(f("playFileInLoop", "short.wav")).durations == [0.0]
    audio.succeed(f("getMasterVolume"))
    robot.advance(1.0)
    assert loudness(played(robot, begun + 0.1)) == pytest.approx(FULL, rel=0.03)
    audio.succeed(f("stopAll"))
    stopped = robot.now.time
    robot.advance(0.4)
    assert not played(robot, stopped + 0.05).any()


def silent_after(robot, since, seconds=0.4):
    robot.advance(seconds)
    return not played(robot, since + 0.05).any()


def test_a_chain_that_fails_silences_what_it_left_in_the_background_and_nothing_else(robot, audio):
    audio.succeed(f("playFileInLoop", "tone.wav", volume=0.5, pan=-1.0))
    goal = audio.play(f("playFileInLoop", "tone.wav", pan=1.0), f("loadFile", "missing.wav"))
    assert goal.state == "aborted" and "function 2 (loadFile)" in goal.text and "missing.wav" in goal.text
    failed = robot.now.time
    robot.advance(0.4)
    heard = played(robot, failed + 0.1)
    assert loudness(heard[:, 0]) == pytest.approx(0.5 * FULL, rel=0.02) and not heard[:, 1].any()
    audio.close()  # and the end of the node silences what goals have left
    assert silent_after(robot, robot.now.time)


def test_a_goal_that_is_cancelled_silences_its_sounds_of_the_background_as_well(robot, audio):
    begun = robot.now.time
    chain = f("playFileInLoop", "short.wav", volume=0.5), f("playFile", "long.wav"), f("playFile", "short.wav")
    goal = audio.send(*chain)
    robot.advance_until(lambda: goal.feedback and goal.feedback[-1].index == 1, 5.0)
    robot.advance(0.4)
    goal.cancel()
    assert (goal.state, goal.text) == ("preempted", "preempted in function 2 (playFile)")
    assert goal.result.files == ["short.wav", "long.wav"] and 0.3 < goal.result.durations[1] < 3.0
    assert loudness(played(robot, begun + 0.1)) > 0.1 and silent_after(robot, robot.now.time)


def test_waiting_for_silence_lasts_as_long_as_the_background(robot, audio):
    begun = robot.now.time
    result = audio.succeed(f("playFile", "tone.wav", background=True), f("waitUntilSilent"), f("waitUntilSilent"))
    assert robot.now.time - begun == pytest.approx(LENGTH, abs=0.1) and result.durations == [0.0]
    assert result.results[2].elapsed.to_sec() < 0.05


def test_a_loaded_sound_is_played_paused_and_moved(audio):
    wait = 0.3
    result = audio.succeed(
        f("loadFile", "long.wav"),
        f("getFileLength", "long.wav"),
        f("goTo", "long.wav", position=3.6),
        f("getCurrentPosition", "long.wav"),
        f("play", "long.wav", volume=0.5),
        f("play", "long.wav", background=True, time=wait),
        f("pause", "long.wav", time=wait),
        f("getCurrentPosition", "long.wav", time=wait),
        f("getCurrentPosition", "long.wav"),
        f("play", "long.wav", duration=0.2),
        f("playInLoop", "long.wav", duration=4.5),
        f("getLoadedFilesNames"),
        f("unloadFile", "long.wav"),
        f("getLoadedFilesIds"),
    )
    number, length, position, paused, still, *names = result.memList
    assert int(number) > 0 and (float(length), float(position), names) == (4.0, 3.6, ["long.wav"])
    assert 0.3 <= float(paused) < 4.0 and paused == still
    elapsed = [each.elapsed.to_sec() for each in result.results]
    assert (elapsed[4], elapsed[9], elapsed[10]) == pytest.approx((0.4, 0.2, 4.5), abs=0.06)
    assert result.files == ["long.wav"] * 4


def test_loaded_sounds_go_by_name_by_id_or_by_being_the_last(robot, audio):
    first, second = audio.succeed(f("loadFile", "tone.wav"), f("loadFile", "short.wav")).memList
    result = audio.succeed(
        f("getFileLength", "tone.wav"),
        f("getFileLength"),
        f("goTo", sound_id=int(first), position=0.9),
        f("play", "tone.wav"),
        f("play", volume=0.5),
        f("setVolume", "tone.wav", volume=0.25),
        f("setVolume", volume=0.5, sound_id=int(second), revert=True),
        f("getVolume", sound_id=int(first)),
        f("getVolume", sound_id=int(second)),
        f("unloadFile"),
        f("play", sound_id=int(first), duration=0.1),
        f("getLoadedFilesIds"),
    )
    assert result.memList == ["1.0", "0.3", "0.25", "0.5", first]
    assert result.files == ["tone.wav", "short.wav", "tone.wav"]
    assert result.durations == pytest.approx([0.1, 0.3, 0.1], abs=0.02)
    text = audio.refused(f("loadFile", "short.wav"), f("unloadFile"), f("play", "short.wav"))
    assert text == "function 3 (play): field str_param: 'short.wav' is not loaded: one of tone.wav"
    text = audio.refused(f("unloadAllFiles"), f("play"))
    assert text == "function 2 (play): field sound_id: no sound is loaded: loadFile comes first"
