"""ALAudioDevice over the network: loudspeakers, parameters, devices, errors."""

from __future__ import annotations

import numpy as np
import pytest
from measured_sound import RATE, frequency, loudness

from naoqi import ALProxy


@pytest.fixture
def played(robot, sound):
    """What the loudspeakers played between two times: (frames, 2)."""
    return lambda begin, end: sound.loudspeakers.played(begin, end).samples


# --- loudspeakers -----------------------------------------------------------------------------------------------------


def test_a_tone_has_its_pitch_level_and_length(robot, device, played):
    begun = robot.now.time
    robot.finish("ALAudioDevice", "playSine", 1000, 50, 0, 0.5, after=0.55)
    heard = played(begun, begun + 0.54)
    assert frequency(heard[:24000, 0]) == pytest.approx(1000.0, abs=2.1)
    assert loudness(heard[2400:21600]) == pytest.approx(0.5 / np.sqrt(2.0), rel=0.01)
    assert np.flatnonzero(np.abs(heard[:, 0]) > 1e-3)[[0, -1]] == pytest.approx([0, 24000], abs=60)


def test_volume_mute_and_closed_outputs(robot, device, played):
    begun = robot.now.time
    device.playSine(1000, 100, 0, 4.0, _async=True)
    robot.handed_over("ALAudioDevice")
    robot.advance(0.5)
    device.setOutputVolume(50)
    assert device.getOutputVolume() == 50
    robot.advance(0.5)
    device.muteAudioOut(True)
    assert device.isAudioOutMuted() is True
    robot.advance(0.5)
    device.muteAudioOut(False)
    device.closeAudioOutputs()
    assert device.isOutputClosed() is True and device.isAudioOutMuted() is False
    robot.advance(0.5)
    device.openAudioOutputs()
    assert device.isOutputClosed() is False
    robot.advance(0.5)
    levels = [loudness(played(begun + at + 0.1, begun + at + 0.4)) * np.sqrt(2.0) for at in (0.0, 0.5, 1.0, 1.5, 2.0)]
    assert levels == pytest.approx([1.0, 0.5, 0.0, 0.0, 0.5], abs=0.01)
    robot.NaoSimulation.reset()
    assert device.getOutputVolume() == 50


def test_buffers_follow_each_other_without_a_gap(robot, device, played):
    time = np.arange(round(1.2 * RATE)) / RATE
    tone = np.round(16000.0 * np.sin(2.0 * np.pi * 440.0 * time)).astype("<i2")
    whole = np.repeat(tone[:, np.newaxis], 2, axis=1)
    begun = robot.now.time
    for piece in np.split(whole, [16384, 20000, 30000]):
        for part in np.array_split(piece, -(-len(piece) // 16384)):
            future = robot.post("ALAudioDevice", "sendRemoteBufferToOutput", len(part), part.tobytes())
            robot.handed_over("ALAudioDevice")
    assert future.isRunning()  # more than a second is waiting: the sender is held back
    robot.advance(1.3)
    assert robot.answer(future) is True
    heard = played(begun, begun + 1.25)
    np.testing.assert_allclose(heard[960 : len(whole) - 960], whole[960:-960] / 32768.0, atol=1e-5)
    assert not heard[len(whole) :].any()


def test_scripts_send_bytes_through_the_naoqi_package(robot, device, played):
    piece = np.full((4800, 2), 8000, dtype="<i2")
    proxy = ALProxy("ALAudioDevice", "127.0.0.1", robot.server.broker.port)
    begun = robot.now.time
    assert proxy.sendRemoteBufferToOutput(4800, piece.tobytes()) is True
    robot.advance(0.2)
    np.testing.assert_allclose(played(begun + 0.02, begun + 0.08), 8000 / 32768, atol=1e-5)


@pytest.mark.parametrize("rate", [16000, 22050, 44100])
def test_buffers_at_other_rates_keep_their_pitch(robot, device, played, rate):
    device.setParameter("outputSampleRate", rate)
    assert device.getParameter("outputSampleRate") == rate
    tone = np.round(16000.0 * np.sin(2.0 * np.pi * 440.0 * np.arange(rate // 2) / rate)).astype("<i2")
    begun = robot.now.time
    for part in np.array_split(np.repeat(tone[:, np.newaxis], 2, axis=1), 4):
        assert device.sendRemoteBufferToOutput(len(part), part.tobytes()) is True
    robot.advance(0.6)
    heard = played(begun, begun + 0.55)
    assert frequency(heard[2400:21600, 0]) == pytest.approx(440.0, abs=2.6)
    assert np.flatnonzero(np.abs(heard[:, 0]) > 0.1)[-1] == pytest.approx(24000, abs=60)


def test_waiting_buffers_can_be_dropped(robot, device, played):
    piece = np.full((16000, 2), 8000, dtype="<i2")
    begun = robot.now.time
    for _ in range(3):
        device.sendRemoteBufferToOutput(16000, piece.tobytes())
    robot.advance(0.2)
    device.flushAudioOutputs()
    robot.advance(0.5)
    assert loudness(played(begun + 0.05, begun + 0.19)) > 0.2
    assert not played(begun + 0.25, begun + 0.7).any()


# --- parameters, devices, errors --------------------------------------------------------------------------------------


def test_parameters(device):
    assert device.getParameter("inputBufferSize") == 8192
    device.setParameter("inputBufferSize", 16384)
    assert device.getParameter("inputBufferSize") == 16384
    device.setParameter("inputBufferSize", 8192)
    assert device.getParameter("colour") == -1


def test_inputs_and_outputs(device):
    assert device.listInputs() == ["microphones"] and device.listOutputs() == ["loudspeakers"]
    assert device.defaultInput() == 0 and device.defaultOutput() == 0
    device.setDefaultInput(0)
    device.setDefaultOutput(0)
    assert dict(device.input(0)) == {"name": "microphones", "channels": 4, "sampleRate": 48000}
    assert dict(device.output(0)) == {"name": "loudspeakers", "channels": 2, "sampleRate": 48000}


@pytest.mark.parametrize(
    "method, arguments, message",
    [
        ("setOutputVolume", (101,), "volume is 101, allowed is 0 to 100"),
        ("setOutputVolume", (-1,), "volume is -1"),
        ("playSine", (0, 50, 0, 1.0), "frequence is 0"),
        ("playSine", (440, 50, 2, 1.0), "pan is 2"),
        ("sendRemoteBufferToOutput", (100, b"abcd"), "length of pBuffer is 4, allowed is 4 bytes a frame, 400 in all"),
        ("sendRemoteBufferToOutput", (16385, bytes(65540)), "nbOfFrames is 16385, allowed is 1 to 16384"),
        ("sendLocalBufferToOutput", (100, 4096), "addresses are for modules inside the robot's own process"),
        ("setClientPreferences", ("Hearing", 16000, 0, 0), "48000 Hz with channels 0"),
        ("setClientPreferences", ("Hearing", 44100, [1, 1, 1, 1], 0, 0), "48000 Hz with channels 0"),
        ("subscribe", ("Nobody",), "there is no module 'Nobody'"),
        ("unsubscribe", ("Nobody",), "module 'Nobody' is not subscribed"),
        ("setParameter", ("outputSampleRate", 8000), "outputSampleRate is 8000, allowed is one of 16000, 22050"),
        ("setParameter", ("outputSampelRate", 48000), "unknown parameter .*did you mean 'outputSampleRate'"),
        ("setFileAsInput", ("missing.wav",), "no file 'missing.wav'"),
        ("startMicrophonesRecording", ("a.mp3",), "filename is 'a.mp3', allowed is a name that ends in .wav or .ogg"),
        ("startMicrophonesRecording", ("../a.wav",), "is not inside"),
        ("input", (1,), "index is 1"),
        ("setDefaultOutput", (-1,), "index is -1"),
    ],
)
def test_what_is_refused_names_what_is_allowed(device, method, arguments, message):
    with pytest.raises(RuntimeError, match=f"ALAudioDevice::{method} .*{message}"):
        device.call(method, *arguments)
