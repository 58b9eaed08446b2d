"""ALAudioDevice: loudspeakers, buffers that clients send, microphones, energies, modules that listen."""

from __future__ import annotations

import queue
import threading

import numpy as np
import pytest
from simulator import PATIENCE, connected
from sounds import RATE, frequency, loudness, played, tone, write

from nao_sim_bridge.naoqi.sound import microphone_clients
from nao_sim_bridge.naoqi.sound.microphone_clients import WAITING
from naoqi import ALBroker, ALModule

BLOCK = 0.17


@pytest.fixture
def device(robot):
    robot.ALAudioDevice.setParameter("outputSampleRate", 48000)
    return robot.ALAudioDevice


def test_a_tone_volume_mute_and_closed_outputs(robot, device):
    begun = robot.now.time
    device.playSine(1000, 100, 0, 2.4, _async=True)
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
    heard = played(robot, begun)
    levels = [loudness(heard[round((at + 0.1) * RATE) : round((at + 0.35) * RATE)]) for at in np.arange(5) / 2.0]
    assert levels == pytest.approx([0.7071, 0.3536, 0.0, 0.0, 0.3536], abs=0.01)
    assert frequency(heard[:24000, 0]) == pytest.approx(1000.0, abs=2.1)
    assert np.flatnonzero(np.abs(heard[:, 0]) > 1e-3)[[0, -1]] == pytest.approx([0, 2.4 * RATE], abs=60)


def pieces(samples):
    """Mono samples -1..1 as stereo of 16 bits."""
    return np.repeat(np.round(32768.0 * samples).astype("<i2")[:, np.newaxis], 2, axis=1)


def send(robot, piece):
    future = robot.post("ALAudioDevice", "sendRemoteBufferToOutput", len(piece), piece.tobytes())
    robot.handed_over("ALAudioDevice")
    return future


def test_buffers_follow_each_other_without_a_gap_and_their_sender_is_held_back(robot, device):
    device.setParameter("outputSampleRate", 16000)
    begun = robot.now.time
    assert robot.answer(send(robot, pieces(tone(440.0, 0.4, rate=16000)))) is True
    robot.advance(0.6)
    np.testing.assert_allclose(played(robot, begun)[1000:18000, 0], tone(440.0, 0.4)[1000:18000], atol=0.01)
    device.setParameter("outputSampleRate", 48000)
    whole, begun = pieces(tone(440.0, 1.2)), robot.now.time
    for piece in np.split(whole, [16384, 20000, 30000, 46000]):
        last = send(robot, piece)
    assert last.isRunning()  # more than a second is waiting
    robot.advance(0.1)
    assert last.isRunning()
    robot.advance(0.25)
    assert robot.answer(last) is True
    robot.advance(1.0)
    heard = played(robot, begun)
    np.testing.assert_allclose(heard[960 : len(whole) - 960], whole[960:-960] / 32768.0, atol=1e-5)
    assert not heard[len(whole) :].any()


@pytest.mark.parametrize("way", ["flush", "reset"])
def test_waiting_buffers_can_be_dropped_and_the_next_begins_at_once(robot, device, way):
    begun = robot.now.time
    answers = [send(robot, pieces(tone(440.0, 0.34))) for _ in range(4)]
    robot.advance(0.2)
    device.flushAudioOutputs() if way == "flush" else robot.NaoSimulation.reset()
    assert robot.answer(answers[-1]) is True
    robot.advance(0.3)
    device.setOutputVolume(100)
    assert robot.answer(send(robot, pieces(tone(440.0, 0.2)))) is True
    robot.advance(0.5)
    assert loudness(played(robot, begun + 0.05, begun + 0.19)) > 0.2
    assert not played(robot, begun + 0.25, begun + 0.5).any() and not played(robot, begun + 0.72).any()
    assert loudness(played(robot, begun + 0.53, begun + 0.68)) > 0.2


def test_parameters_inputs_and_outputs(device):
    assert device.getParameter("inputBufferSize") == 8192 and device.getParameter("colour") == -1
    assert device.listInputs() == ["microphones"] and device.listOutputs() == ["loudspeakers"]
    assert device.defaultInput() == 0 and device.defaultOutput() == 0
    device.setDefaultInput(0)
    device.setDefaultOutput(0)
    assert dict(device.input(0)) == {"name": "microphones", "channels": 4, "sampleRate": 48000}
    assert dict(device.output(0)) == {"name": "loudspeakers", "channels": 2, "sampleRate": 48000}


def test_what_is_refused_names_what_is_allowed(robot, device, refused):
    begun = robot.now.time
    rows = [
        ("sendRemoteBufferToOutput", (0, b""), "nbOfFrames is 0, allowed is 1 to 16384"),
        ("sendRemoteBufferToOutput", (16385, bytes(65540)), "nbOfFrames is 16385, allowed is 1 to 16384"),
        ("sendRemoteBufferToOutput", (100, b"abcd"), "length of pBuffer is 4, allowed is 4 bytes a frame, 400 in all"),
        ("sendRemoteBufferToOutput", (1, [1, 40000]), r"pBuffer\[1\] is 40000, allowed is -32768 to 32767"),
        ("sendLocalBufferToOutput", (100, 4096), "addresses are for modules inside the robot's own process"),
        ("setClientPreferences", ("Hearing", 44100, [1, 1, 1, 1], 0, 0), "48000 Hz with channels 0"),
        ("setClientPreferences", ("Hearing", 48000, 0, 2), "deinterleaved is 2, allowed is 0 or 1"),
        ("subscribe", ("Nobody",), "there is no module 'Nobody' to send sound to; register it first"),
        ("unsubscribe", ("Nobody",), "module 'Nobody' is not subscribed; subscribed are none"),
        ("setParameter", ("outputSampleRate", 8000), "outputSampleRate is 8000, allowed is one of 16000, 22050"),
        ("setParameter", ("outputSampelRate", 48000), "unknown parameter .*did you mean 'outputSampleRate'"),
        ("setFileAsInput", ("missing.wav",), "no file 'missing.wav'"),
        ("startMicrophonesRecording", ("a.mp3",), "filename is 'a.mp3', allowed is a name that ends in .wav or .ogg"),
        ("startMicrophonesRecording", ("../a.wav",), "is not inside"),
        ("input", (1,), "index is 1"),
        ("setDefaultOutput", (-1,), "index is -1"),
    ]
    refused("ALAudioDevice", rows)
    robot.advance(0.2)
    assert device.getOutputVolume() == 100 and not played(robot, begun).any()


class Hearing:
    """A module of a client, made with libqi alone."""

    def __init__(self):
        self.heard = queue.Queue()
        self.may_return = threading.Event()
        self.may_return.set()

    def processRemote(self, channels, frames, time, buffer):
        self.heard.put((channels, frames, time[0] + 1e-6 * time[1], np.frombuffer(bytes(buffer), "<i2")))
        self.may_return.wait(PATIENCE)

    def blocks(self, count):
        return [self.heard.get(timeout=PATIENCE) for _ in range(count)]


@pytest.fixture
def serve(robot, device):
    """Serves a module from a session of its own, under a name of its own; ends it after the test."""
    sessions = []

    def make(name, module):
        session = connected(robot.port)
        session.listen("tcp://127.0.0.1:0")
        session.registerService(name, module)
        sessions.append((name, session))
        return module

    yield make
    for name, session in sessions:
        try:
            device.unsubscribe(name)
        except RuntimeError:
            pass  # the test did it
        session.close()


def test_a_module_hears_four_channels_in_blocks(robot, device, serve):
    hearing = serve("Blocks", Hearing())
    device.subscribe("Blocks")
    device.subscribe("Blocks")  # no harm
    device.playSine(1000, 50, 0, 1.5, _async=True)
    robot.handed_over("ALAudioDevice")
    begun = robot.now.time
    robot.advance(1.4)
    blocks = hearing.blocks(7)
    times = [time for _, _, time, _ in blocks]
    assert begun <= times[0] <= begun + BLOCK
    np.testing.assert_allclose(np.diff(times), BLOCK, atol=2e-6)
    assert all((channels, frames, samples.shape) == (4, 8160, (4 * 8160,)) for channels, frames, _, samples in blocks)
    front = np.concatenate([samples.reshape(8160, 4)[:, 2] for *_, samples in blocks])
    assert frequency(front) == pytest.approx(1000.0, abs=1.0)
    device.unsubscribe("Blocks")
    robot.advance(0.5)
    hearing.heard = queue.Queue()
    device.subscribe("Blocks")
    device.closeAudioInputs()
    assert device.isInputClosed() is True
    robot.advance(1.0)
    assert hearing.heard.qsize() <= 1  # one may have been under way
    device.openAudioInputs()
    assert device.isInputClosed() is False
    robot.advance(1.0)
    assert hearing.blocks(4)


def test_the_forms_of_a_module_hold_the_channels_of_a_file_that_stands_for_the_microphones(robot, device, serve):
    tones = np.stack([tone(300.0 * (n + 1), 4.0, 0.1 * (n + 1)) for n in range(4)], axis=1)
    write(robot, "input.wav", tones)
    hearing = serve("Forms", Hearing())
    device.setFileAsInput("input.wav")
    device.setClientPreferences("Forms", 48000, 0, 0)
    device.subscribe("Forms")

    def heard(shape, rate, axis=0, blocks=3, lasting=1):
        robot.advance(BLOCK * lasting * (blocks + 1.2))
        found = hearing.blocks(blocks)[-1]
        hearing.heard = queue.Queue()
        samples = found[3].reshape(shape)
        rows = samples.T if axis else samples
        assert found[:2] == (len(rows), rows.shape[1])
        return [
            (round(frequency(row, rate) / 300.0), round(10 * np.sqrt(2.0) * loudness(row) / 32768.0)) for row in rows
        ]

    assert heard((8160, 4), 48000, axis=1) == [(1, 1), (2, 2), (3, 3), (4, 4)]
    device.setClientPreferences("Forms", 48000, [1, 1, 1, 1], 1, 0)
    assert heard((4, 8160), 48000) == [(1, 1), (2, 2), (3, 3), (4, 4)]
    for channel in (1, 4):
        device.setClientPreferences("Forms", 16000, channel, 0)
        assert heard((1, 2720), 16000) == [(channel, channel)]
    device.setClientPreferences("Forms", 16000, [0, 0, 1, 0], 0, 0)
    device.setParameter("inputBufferSize", 16384)
    assert heard((1, 5440), 16000, blocks=2, lasting=2) == [(3, 3)]
    device.setFileAsInput("")
    robot.advance(1.2)
    # Blocks of the file are still on their way: the first one of silence ends with no more of it.
    while loudness(hearing.blocks(1)[-1][3]) > 100.0:
        pass


def test_a_module_of_the_naoqi_package_gets_bytes(robot, device):
    class Sound(ALModule):
        heard = queue.Queue()

        def processRemote(self, nbOfChannels, nbrOfSamplesByChannel, timestamp, buffer):
            self.heard.put((nbOfChannels, nbrOfSamplesByChannel, buffer))

    broker = ALBroker("client", "127.0.0.1", 0, *robot.address)
    try:
        module = Sound("SoundOfNaoqi")
        device.subscribe("SoundOfNaoqi")
        robot.advance(0.5)
        channels, frames, buffer = module.heard.get(timeout=PATIENCE)
        device.unsubscribe("SoundOfNaoqi")
    finally:
        broker.shutdown()
    assert (channels, frames) == (4, 8160) and isinstance(buffer, bytes) and len(buffer) == 65280


def test_time_does_not_wait_for_one_that_hangs_which_loses_the_oldest_blocks(robot, device, serve, monkeypatch, caplog):
    hanging = serve("Hangs", Hearing())
    hanging.may_return.clear()
    device.subscribe("Hangs")
    robot.advance(2 * BLOCK)
    first = hanging.blocks(1)[0][2]
    monkeypatch.setattr(microphone_clients, "HANGS", 0.0)
    robot.advance(8.0)
    hanging.may_return.set()
    newest = [time for _, _, time, _ in hanging.blocks(WAITING)]
    assert newest[0] > first + 10 * BLOCK and newest == pytest.approx(newest[0] + BLOCK * np.arange(WAITING), abs=1e-5)
    assert "Hangs is too slow for the microphones" in caplog.text
