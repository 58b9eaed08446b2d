"""The example that writes the microphones' topic to a file keeps samples, order and time."""

from __future__ import annotations

import importlib.util
import wave
from array import array
from pathlib import Path

import pytest
import rospy

from nao_library_msgs.msg import AudioBuffer

EXAMPLE = Path(__file__).parents[3] / "nao_library_modules" / "examples" / "microphone_to_file.py"
FRAMES = 1600
BLOCK = 0.1


@pytest.fixture(scope="module")
def example():
    spec = importlib.util.spec_from_file_location(EXAMPLE.stem, EXAMPLE)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def block(number, channels=1, frequency=16000):
    """A block whose samples are its number."""
    message = AudioBuffer(frequency=frequency, channelMap=bytes(channels), data=[number] * FRAMES * channels)
    message.header.stamp = rospy.Time.from_sec(100.0 + number * BLOCK)
    return message


def written(recording, path):
    recording.write(str(path))
    with wave.open(str(path)) as file:
        samples = array("h", file.readframes(file.getnframes()))
        return file.getnchannels(), file.getframerate(), list(samples)


def test_blocks_become_a_file_of_the_length_that_was_asked_for(example, tmp_path):
    recording = example.Recording(0.25, 16000)
    for number in (0, -3, 2, 3):
        message = block(number)
        message.header.stamp = rospy.Time.from_sec(100.0 + abs(number) * BLOCK - (0.2 if number == -3 else 0.0))
        recording.take(message)
    assert recording.complete.is_set()
    channels, rate, samples = written(recording, tmp_path / "a.wav")
    assert (channels, rate, len(samples)) == (1, 16000, 4000)
    assert samples == [0] * FRAMES + [-3] * FRAMES + [2] * (FRAMES // 2)


def test_missing_blocks_are_silent(example, tmp_path):
    recording = example.Recording(0.5, 16000)
    for number in (1, 2, 5):
        recording.take(block(number, channels=4))
    channels, _, samples = written(recording, tmp_path / "a.wav")
    part = 4 * FRAMES
    assert channels == 4
    assert samples == [1] * part + [2] * part + [0] * 2 * part + [5] * part


def test_blocks_from_before_the_change_of_frequency_are_left_out(example):
    recording = example.Recording(0.1, 16000)
    recording.take(block(1, channels=4, frequency=48000))
    assert recording.channels == 0 and not recording.complete.is_set()
