"""Sounds, energies and parameters on stand-ins."""

from __future__ import annotations

import pytest
from audio_in_goals import DETECTED, LEVEL, LOCATED, YES_NO, f, play, succeed
from genpy import Duration


def test_a_sound_that_begins_is_detected(hearing, ears, clock):
    clock.script = [
        lambda: ears.raise_event(DETECTED, [[0, 0, 0.9, 1]]),
        lambda: ears.raise_event(DETECTED, [[0, 1, 0.2, 1]]),
        lambda: ears.raise_event(DETECTED, [[0, 1, 0.8, 1]]),
    ]
    result = succeed(hearing, f("detectSound", confidence=0.5, timeout=5.0))
    (sound,) = result.sounds
    assert (sound.located, sound.confidence, sound.header.frame_id) == (False, 0.8, "robot1/Head")
    assert [float(value) for value in result.results[0].values] == pytest.approx([0.8, 0.3])
    assert ears.idle()


@pytest.mark.parametrize("function", ["detectSound", "localizeSound"])
def test_silence_is_no_failure(hearing, ears, clock, function):
    result = succeed(hearing, f(function, timeout=2.0))
    assert (result.sounds, result.results[0].values, clock.time) == ([], [], 102.0)
    assert ears.idle()


def located(azimuth, confidence, head=LEVEL):
    return [[1, 2], [azimuth, 0.1, confidence, 0.25], LEVEL, head]


def test_a_sound_is_located_in_the_head_and_in_the_base(hearing, ears, clock):
    head = [0.05, 0.0, 0.45, 0.0, 0.0, 0.5]
    clock.script = [
        lambda: ears.raise_event(LOCATED, located(1.0, 0.2)),
        lambda: ears.raise_event(LOCATED, located(0.25, 0.9, head)),
    ]
    (sound,) = succeed(hearing, f("localizeSound", confidence=0.5)).sounds
    assert (sound.header.frame_id, sound.base_frame, sound.located) == ("robot1/Head", "robot1/base_footprint", True)
    assert (sound.azimuth, sound.elevation, sound.confidence, sound.energy) == (0.25, 0.1, 0.9, 0.25)
    assert (sound.base_azimuth, sound.base_elevation) == pytest.approx((0.75, 0.1))
    assert (sound.head.x, sound.head.y, sound.head.z) == (0.05, 0.0, 0.45)
    assert sound.header.stamp.to_sec() == pytest.approx(100.2)
    assert ears.localization.parameters["EnergyComputation"] is True and ears.idle()


def test_with_some_patience_the_most_confident_direction_counts(hearing, ears, clock):
    clock.script = [
        lambda: ears.raise_event(LOCATED, located(1.0, 0.5)),
        lambda: ears.raise_event(LOCATED, located(0.3, 0.9)),
        lambda: ears.raise_event(LOCATED, located(2.0, 0.6)),
    ]
    (sound,) = succeed(hearing, f("localizeSound", duration=1.0)).sounds
    assert sound.azimuth == 0.3
    assert clock.time == pytest.approx(101.1)


@pytest.mark.parametrize("function", ["detectSound", "localizeSound", "getEnergy", "listen"])
def test_preemption_ends_every_wait_and_every_subscription(hearing, ears, clock, function):
    clock.script = [hearing.server.preempt]
    server = play(hearing, f(function, vocabulary=YES_NO, duration=5.0))
    assert server.end == "preempted" and ears.idle()


def test_nonsense_of_the_robot_is_passed_over(hearing, ears, clock):
    clock.script = [
        lambda: ears.raise_event(LOCATED, "nonsense"),
        lambda: ears.raise_event(LOCATED, located(0.3, 0.9)),
    ]
    assert len(succeed(hearing, f("localizeSound")).sounds) == 1


def test_sensitivity_of_one_sense_or_of_all(hearing, ears):
    succeed(hearing, f("setSensitivity", str_param="detection", sensitivity=0.4))
    senses = (ears.recognition, ears.detection, ears.localization)
    assert [sense.parameters["Sensitivity"] for sense in senses] == [0.9, 0.4, 0.9]
    succeed(hearing, f("setSensitivity", sensitivity=0.5))
    assert [sense.parameters["Sensitivity"] for sense in senses] == [0.5, 0.5, 0.5]


def test_energies_are_computed_only_for_the_function(hearing, ears):
    result = succeed(hearing, f("getEnergy"), f("getRearMicEnergy"))
    assert result.microphones == ["left", "right", "front", "rear", "rear"]
    assert [energy // 100 for energy in result.energies] == [1, 2, 3, 4, 4]
    assert all(energy % 100 for energy in result.energies)  # they were computed
    assert result.memList == [] and ears.idle()


def test_energies_that_another_program_has_computed_go_on(hearing, ears, robot):
    ears.card.computing = True
    succeed(hearing, f("getFrontMicEnergy"))
    assert ears.card.computing
    assert "enableEnergyComputation" not in [call[0] for call in robot.proxy("ALAudioDevice").calls]


def test_energies_that_are_computed_all_the_time_are_there_at_once(hearing, ears, clock):
    succeed(hearing, f("enableEnergyComputation"), f("getEnergy"))
    assert clock.waits == [] and ears.card.computing
    succeed(hearing, f("disableEnergyComputation"))
    assert ears.idle()


def test_energies_are_the_mean_over_a_while(hearing, ears):
    succeed(hearing, f("enableEnergyComputation"))
    result = succeed(hearing, f("getFrontMicEnergy", duration=0.5))
    assert result.energies == [302.0]  # 301, 302, 303


def test_the_sound_card_of_naoaudio_is_there(hearing, ears):
    assert succeed(hearing, f("setOutputVolume", volume=30), f("getOutputVolume")).memList == ["30"]


def test_parameters_of_the_recognition_and_of_the_sound_card(hearing, ears):
    chain = [
        f("setParameter", str_param="NbHypotheses", values=[3]),
        f("getParameter", str_param="NbHypotheses"),
        f("setParameter", str_param="outputSampleRate", values=[16000]),
        f("getParameter", str_param="outputSampleRate"),
    ]
    assert succeed(hearing, *chain).memList == ["3.0", "16000"]
    server = play(hearing, f("getParameter", str_param="NbHypothesis"))
    assert server.end == "aborted" and "no parameter NbHypothesis" in server.text


def test_settings_go_back_after_the_wait(hearing, ears, clock):
    during = []
    second = Duration(1)
    clock.script = [
        lambda: during.append(ears.recognition.language),
        lambda: during.append(ears.recognition.audio_expression),
        lambda: during.append(ears.recognition.parameters["Sensitivity"]),
    ]
    succeed(
        hearing,
        f("setLanguage", str_param="French", revert=True, time=second),
        f("setAudioExpression", enable=False, revert=True, time=second),
        f("setParameter", str_param="Sensitivity", values=[0.1], revert=True, time=second),
    )
    assert during == ["French", False, 0.1]
    assert (ears.recognition.language, ears.recognition.audio_expression) == ("English", True)
    assert ears.recognition.parameters["Sensitivity"] == 0.9


def test_a_file_instead_of_the_microphones(hearing, ears):
    succeed(hearing, f("setFileAsInput", str_param="question.wav"))
    assert ears.card.file == "/home/nao/question.wav"
