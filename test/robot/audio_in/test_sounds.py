"""Goals that record, locate and measure sounds, and the settings of hearing."""

from __future__ import annotations

import math

import numpy as np
import pytest
from goal_functions import audio_in as f
from sounds import RATE, frequency, loudness, noise, put, read, take, tone, write

from nao_library_actions.msg import NaoAudioInGoal
from nao_library_modules.audio_in.audio_in_server import NaoAudioInput

DETECTED, LOCATED = "SoundDetected", "ALSoundLocalization/SoundLocated"
LEVEL = [0.0] * 6
ALL = ["left", "right", "front", "rear"]


@pytest.mark.parametrize(
    "fields, rate, channels, kind",
    [
        ({"str_param": "day/a.wav"}, 16000, ["front"], "wav"),
        ({"str_param": "/home/nao/c.wav", "rate": 16000, "channels": ["left"]}, 16000, ["left"], "wav"),
        ({"str_param": "d.ogg", "file_type": "ogg", "channels": ["rear", "front", "left", "right"]}, 48000, ALL, "ogg"),
    ],
)
def test_a_recording_takes_its_time_and_has_what_is_heard(robot, ears, fields, rate, channels, kind):
    file = tone(500.0, 2.0)[:, None] * [0.1, 0.2, 0.3, 0.4]
    write(robot, "heard.wav", file)
    ears.succeed(f("setFileAsInput", str_param="heard.wav"))
    result = ears.succeed(f("record", duration=1.5, **fields))
    (recorded,) = result.files
    assert (recorded.path, recorded.rate, recorded.channels, recorded.file_type) == (
        fields["str_param"],
        rate,
        channels,
        kind,
    )
    assert recorded.duration == pytest.approx(1.5, abs=0.2) and result.memList == []
    assert result.results[0].values[0] == fields["str_param"]
    assert float(result.results[0].values[1]) == pytest.approx(recorded.duration)
    samples, found = read(robot, fields["str_param"].replace("/home/nao/", ""))
    assert (found, samples.shape[1]) == (rate, len(channels))
    assert len(samples) / rate == recorded.duration
    middle = samples[rate // 2 : rate]
    assert frequency(middle[:, 0], rate) == pytest.approx(500.0, abs=2.1)
    expected = [0.5 * 0.1 * (1 + ALL.index(name)) / math.sqrt(2.0) for name in channels]
    assert [loudness(channel) for channel in middle.T] == pytest.approx(expected, rel=0.05)


def test_a_recording_that_is_cancelled_is_closed_and_in_the_result(robot, ears):
    goal = ears.send(f("record", str_param="cut.ogg", duration=60.0))
    robot.advance(1.5)
    goal.cancel()
    assert goal.state == "preempted"
    (file,) = goal.result.files
    assert file.path == "cut.ogg" and file.duration == pytest.approx(1.5, abs=0.2)
    samples, rate = read(robot, "cut.ogg")
    assert len(samples) / rate == file.duration


def test_a_recording_outlives_its_goal_until_it_is_stopped(robot, ears):
    start, record = f("startRecording", str_param="long.wav", rate=48000), f("record", str_param="b.wav", duration=0.2)
    text = ears.refused(start, record)
    assert "function 2 (record)" in text and "stopRecording comes first" in text
    assert ears.succeed(start).files == []
    assert "stopRecording comes first" in ears.refused(record)
    robot.advance(2.0)
    result = ears.succeed(f("stopRecording"))
    (file,) = result.files
    assert file.path == "long.wav" and len(file.channels) == 4 and file.duration == pytest.approx(2.0, abs=0.1)
    assert len(read(robot, "long.wav")[0]) / RATE == file.duration
    start.overwrite = True
    ears.succeed(start, f("stopRecording"), record)


def test_a_recording_replaces_no_file_unasked(robot, ears):
    kept = write(robot, "kept.wav", tone(500.0, 0.1))
    for path in ("kept.wav", "/home/nao/kept.wav"):
        for fields in ({"function": "record", "duration": 0.2}, {"function": "startRecording"}):
            text = ears.refused(f(str_param=path, **fields))
            assert f"{kept} is there already" in text and "another name, or overwrite" in text
    assert len(read(robot, "kept.wav")[0]) == 0.1 * RATE
    (file,) = ears.succeed(f("record", str_param="kept.wav", duration=0.2, overwrite=True)).files
    assert len(read(robot, "kept.wav")[0]) / file.rate == file.duration


GRAMMAR = "#BNF+EM V2.1; !grammar house; !start <order>; <order>: turn on the light;"


def test_a_grammar_replaces_no_file_and_saved_contexts_no_others_unasked(robot, ears):
    folder = robot.server.files.folder
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "house.bnf").write_text(GRAMMAR)
    (folder / "kept.lcf").write_text("kept")
    compile_ = f("compile", str_param="English", vocabulary=["house.bnf", "kept.lcf"])
    new = f("compile", str_param="English", vocabulary=["house.bnf", "new.lcf"])
    assert f"{folder / 'kept.lcf'} is there already" in ears.refused(compile_)
    assert "an earlier function writes new.lcf" in ears.refused(new, new)
    assert (folder / "kept.lcf").read_text() == "kept" and not (folder / "new.lcf").exists()
    compile_.overwrite = True
    ears.succeed(compile_, new)
    assert "turn on the light" in (folder / "kept.lcf").read_text()
    save, erase = f("saveContextSet", str_param="set"), f("eraseContextSet", str_param="set")
    assert "'set' is saved already" in ears.refused(save, save)
    ears.succeed(save)
    assert "'set' is saved already: another name, or overwrite" in ears.refused(save)
    ears.succeed(f("saveContextSet", str_param="set", overwrite=True), erase, save, erase)
    ears.succeed(save)


def test_the_length_of_a_recording_that_only_the_robot_can_read_is_the_clocks(robot, goals_to):
    far = goals_to(NaoAudioInput, NaoAudioInGoal)
    (file,) = far.succeed(f("record", str_param="far.wav", duration=1.0)).files
    assert file.duration == pytest.approx(1.0, abs=0.1)


def located(azimuth, confidence, head=LEVEL):
    return [[1, 2], [azimuth, 0.1, confidence, 0.25], LEVEL, head]


@pytest.fixture
def begun(robot, ears, subscribers):
    """A goal of one function that hears, and a way to raise its event."""

    def send(function):
        goal = ears.send(function)
        robot.advance_until(subscribers, 5.0)
        robot.advance(0.3)
        return goal

    return send


def raised(robot, name, *values):
    for value in values:
        robot.ALMemory.raiseEvent(name, value)
        robot.proxy("ALMemory").ping()
        robot.advance(0.1)


def test_a_sound_that_begins_is_detected_and_not_located(robot, begun, subscribers):
    goal = begun(f("detectSound", confidence=0.5, timeout=30.0))
    raised(robot, DETECTED, [[0, 0, 0.9, 1]], [[0, 1, 0.2, 1]], "nonsense")
    assert goal.active
    began = robot.now.time
    put(robot, (1.0, 0.0, 0.5), noise(0.5), 70.0)
    goal.finish()
    (sound,) = goal.result.sounds
    assert not sound.located and 0.5 < sound.confidence <= 1.0 and sound.header.frame_id == "robot1/Head"
    values = [float(value) for value in goal.result.results[0].values]
    assert values == pytest.approx([sound.confidence, 0.7], abs=0.3) and subscribers() == []
    assert sound.header.stamp.to_sec() == pytest.approx(began, abs=0.1)


def test_a_sound_is_located_in_the_head_and_in_the_base(stiff_robot, ears, begun, subscribers):
    robot, yaw, began = stiff_robot, 0.6, stiff_robot.now.time
    result = ears.succeed(f("detectSound", timeout=1.0), f("localizeSound", timeout=1.0))
    assert list(result.sounds) == [] and subscribers() == []
    assert robot.now.time - began == pytest.approx(2.0, abs=0.3)
    robot.finish("ALMotion", "angleInterpolationWithSpeed", "HeadYaw", yaw, 0.5, after=1.5)
    goal = begun(f("localizeSound", timeout=15.0, duration=0.5))
    put(robot, (1.5 * math.cos(0.8), 1.5 * math.sin(0.8), 0.5), noise(2.0), 70.0)
    (sound,) = goal.finish().result.sounds
    assert sound.located and sound.base_azimuth == pytest.approx(0.8, abs=0.12)
    assert sound.azimuth == pytest.approx(0.8 - yaw, abs=0.12) and sound.energy > 10.0
    assert (sound.header.frame_id, sound.base_frame) == ("robot1/Head", "robot1/base_footprint")
    assert [sound.head.x, sound.head.y, sound.head.z] == pytest.approx(
        robot.ALMotion.getPosition("Head", 2, True)[:3], abs=0.01
    )
    values = [float(value) for value in goal.result.results[0].values]
    expected = [sound.azimuth, sound.elevation, sound.confidence, sound.base_azimuth, sound.base_elevation]
    assert values == pytest.approx(expected, abs=1e-5)


def test_with_some_patience_the_most_confident_direction_counts(robot, begun):
    goal = begun(f("localizeSound", confidence=0.4, duration=1.0, timeout=20.0))
    raised(robot, LOCATED, "nonsense", located(1.5, 0.2), located(1.0, 0.5), located(0.3, 0.9), located(2.0, 0.6))
    began = robot.now.time
    (sound,) = goal.finish().result.sounds
    assert (sound.azimuth, sound.elevation, sound.confidence) == pytest.approx((0.3, 0.1, 0.9))
    assert robot.now.time - began == pytest.approx(0.7, abs=0.15)
    goal = begun(f("localizeSound", timeout=20.0))
    raised(robot, LOCATED, located(1.0, 0.5), located(0.3, 0.9))
    assert goal.finish().result.sounds[0].azimuth == pytest.approx(1.0)


def test_energies_are_louder_on_the_side_of_a_sound_and_computed_only_for_the_function(robot, ears):
    quiet = ears.succeed(f("getEnergy", duration=0.6))
    put(robot, (0.0, 0.5, 0.5), noise(2.0), 75.0, loop=True)
    began = robot.now.time
    loud = ears.succeed(f("getEnergy", duration=0.6), f("getRearMicEnergy"), f("getLeftMicEnergy"))
    assert loud.microphones == ["left", "right", "front", "rear", "rear", "left"] and loud.memList == []
    assert 0.6 < robot.now.time - began < 4.0
    assert all(now > 3.0 * before for now, before in zip(loud.energies, quiet.energies))
    assert loud.energies[0] > loud.energies[1] and loud.energies[5] > loud.energies[4]
    assert [list(map(float, done.values)) for done in loud.results[1:]] == [
        [pytest.approx(loud.energies[4])],
        [pytest.approx(loud.energies[5])],
    ]
    robot.advance(0.4)
    assert robot.ALAudioDevice.getFrontMicEnergy() == 0.0
    result = ears.succeed(f("getRightMicEnergy"), f("getFrontMicEnergy"))
    assert result.microphones == ["right", "front"]


def test_sensitivity_of_one_sense_or_of_all(robot, ears):
    def heard():
        """Whether a soft sound is detected, and whether it is located."""
        goal = ears.send(f("detectSound", timeout=2.0), f("localizeSound", timeout=2.0))
        robot.advance(0.8)
        put(robot, (1.0, 0.0, 0.5), np.r_[noise(0.4), np.zeros(RATE // 2), noise(0.4)], 46.0, loop=True)
        found = [bool(done.values) for done in goal.finish().result.results]
        take(robot)
        return found

    speech = robot.ALSpeechRecognition
    before = speech.getParameter("Sensitivity")
    ears.succeed(f("setSensitivity", sensitivity=0.9, str_param="localization"))
    ears.succeed(f("setSensitivity", str_param="detection", sensitivity=0.1))
    assert speech.getParameter("Sensitivity") == pytest.approx(before) and heard() == [False, True]
    ears.succeed(f("setSensitivity", sensitivity=0.1))
    assert speech.getParameter("Sensitivity") == pytest.approx(0.1) and heard() == [False, False]
    ears.succeed(f("setSensitivity", sensitivity=0.9))
    assert heard() == [True, True]


def test_parameters_of_the_recognition_and_of_the_sound_card(ears):
    chain = [
        f("setParameter", str_param="NbHypotheses", values=[3]),
        f("getParameter", str_param="NbHypotheses"),
        f("setParameter", str_param="outputSampleRate", values=[16000]),
        f("getParameter", str_param="outputSampleRate"),
        f("setParameter", str_param="NbHypotheses", values=[1]),
        f("getAudioExpression"),
        f("setVisualExpression", enable=True),
        f("getOutputVolume"),
    ]
    assert ears.succeed(*chain).memList[:3] == ["3.0", "16000", "False"]
    assert "NbHypothesis" in ears.refused(f("getParameter", str_param="NbHypothesis"))


def test_settings_go_back_after_the_wait(robot, ears):
    recognition, device, wait = robot.ALSpeechRecognition, robot.ALAudioDevice, 0.5
    device.setOutputVolume(60)

    def now():
        sensitivity = round(recognition.getParameter("Sensitivity"), 3)
        return (
            recognition.getAudioExpression(),
            sensitivity,
            device.getOutputVolume(),
            device.getParameter("outputSampleRate"),
        )

    before = now()
    for function, changed in [
        (f("setAudioExpression", enable=True, revert=True, time=wait), (True, *before[1:])),
        (f("setParameter", str_param="Sensitivity", values=[0.1], revert=True, time=wait), (False, 0.1, *before[2:])),
        (f("setOutputVolume", volume=20, revert=True, time=wait), (*before[:2], 20, before[3])),
        (f("setParameter", str_param="outputSampleRate", values=[44100], revert=True, time=wait), (*before[:3], 44100)),
    ]:
        goal = ears.send(function)
        robot.advance(0.3)
        assert now() == changed, function.function
        goal.finish()
        assert now() == before
