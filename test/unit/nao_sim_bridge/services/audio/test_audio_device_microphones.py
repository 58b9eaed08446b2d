"""ALAudioDevice over the network: microphones, energies, modules that listen."""

from __future__ import annotations

import queue
import threading

import numpy as np
import pytest
import qi
import soundfile
from measured_sound import RATE, frequency, loudness

from nao_sim_bridge.services.audio import microphone_clients
from nao_sim_bridge.sim.sound.samples import Sound
from nao_sim_bridge.sim.sound.sources import SoundSource

BLOCK = 0.17
SPEED_OF_SOUND = 343.0


class Hearing:
    """A module of a client."""

    def __init__(self):
        self.heard = queue.Queue()
        self.pause = 0.0

    @qi.bind(qi.Void, [qi.Int32, qi.Int32, qi.Dynamic, "r"])
    def processRemote(self, channels, frames, time, buffer):
        self.heard.put((channels, frames, list(time), np.frombuffer(bytes(buffer), "<i2")))
        threading.Event().wait(self.pause)

    def blocks(self, count, patience):
        return [self.heard.get(timeout=patience) for _ in range(count)]


@pytest.fixture
def source(robot, sound):
    """Puts a sound into the world; it is taken out again after the test."""
    names = []

    def put(position, samples, level=65.0, loop=False):
        names.append(f"source {len(names)}")
        made = SoundSource(names[-1], position, Sound(samples, RATE), level_db=level, loop=loop)
        robot.server.runner.call(lambda: sound.sources.add(made))

    yield put
    present = robot.server.runner.call(sound.sources.names)
    for name in set(names) & set(present):
        robot.server.runner.call(lambda name=name: sound.sources.remove(name))


@pytest.fixture(scope="module")
def module(shared_robot):
    """A module "Hearing" that listens as long as a test wants."""
    session = qi.Session()
    session.connect(f"tcp://127.0.0.1:{shared_robot.server.broker.port}")
    session.listen("tcp://127.0.0.1:0")
    served = Hearing()
    session.registerService("Hearing", served)
    yield served
    session.close()


@pytest.fixture
def hearing(device, module):
    module.heard = queue.Queue()
    device.setClientPreferences("Hearing", 48000, 0, 0)
    yield module
    try:
        device.unsubscribe("Hearing")
    except RuntimeError:
        pass  # the test did it


def test_energies_rise_with_what_sounds_and_are_zero_when_not_computed(robot, device, sound):
    sides = ("Left", "Right", "Front", "Rear")

    def energies():
        sound.ears.catch_up()
        return {side: device.call(f"get{side}MicEnergy") for side in sides}

    assert set(energies().values()) == {0.0}
    device.enableEnergyComputation()
    robot.advance(0.6)
    quiet = energies()
    assert all(0.0 < energy < 20.0 for energy in quiet.values())
    device.playSine(1000, 100, 0, 10.0, _async=True)
    robot.handed_over("ALAudioDevice")
    robot.advance(0.6)
    loud = energies()
    device.setOutputVolume(50)
    robot.advance(0.6)
    half = energies()
    for side in sides:
        assert loud[side] > 50.0 * quiet[side]
        assert half[side] == pytest.approx(0.5 * loud[side], rel=0.02)
    device.disableEnergyComputation()
    assert set(energies().values()) == {0.0}


def test_energies_tell_sides_apart(robot, device, sound, source):
    device.enableEnergyComputation()
    noise = np.random.default_rng(0).uniform(-0.5, 0.5, RATE)
    source((0.0, 0.4, 0.5), noise, level=80.0, loop=True)
    robot.advance(1.0)
    sound.ears.catch_up()
    assert device.getLeftMicEnergy() > 1.05 * device.getRightMicEnergy()


def test_a_module_hears_four_channels_in_blocks(robot, device, hearing, patience):
    device.setClientPreferences("Hearing", 48000, 0, 0)
    device.subscribe("Hearing")
    device.playSine(1000, 50, 0, 3.0, _async=True)
    robot.handed_over("ALAudioDevice")
    begun = robot.now.time
    robot.advance(2.0)
    blocks = hearing.blocks(10, patience)
    times = [seconds + 1e-6 * microseconds for _, _, (seconds, microseconds), _ in blocks]
    assert begun <= times[0] <= begun + BLOCK
    np.testing.assert_allclose(np.diff(times), BLOCK, atol=2e-6)
    for channels, frames, _, samples in blocks:
        assert (channels, frames, samples.shape) == (4, 8160, (4 * 8160,))
    front = np.concatenate([samples.reshape(8160, 4)[:, 2] for *_, samples in blocks])
    assert frequency(front) == pytest.approx(1000.0, abs=1.0)


def test_the_forms_of_a_module_hold_the_same_sound(robot, device, hearing, sound, source, patience):
    """Interleaved, deinterleaved, and one channel at a third of the rate, of a steady tone."""
    tone = np.sin(2.0 * np.pi * 500.0 * np.arange(RATE) / RATE)
    source((1.0, 1.0, 0.5), tone, loop=True)
    robot.advance(0.2)
    found = {}
    for preference in [(48000, 0, 0), (48000, 0, 1), (16000, 1, 0), (16000, 2, 0), (16000, 3, 0), (16000, 4, 0)]:
        device.setClientPreferences("Hearing", *preference)
        device.subscribe("Hearing")
        robot.advance(0.6)
        found[preference] = hearing.blocks(2, patience)[1]
        device.unsubscribe("Hearing")
        hearing.heard = queue.Queue()
    levels = np.std(found[48000, 0, 0][3].reshape(8160, 4), axis=0)
    assert np.ptp(levels) > 0.02 * levels.mean()  # nearer is louder, so a channel that was mixed up would show
    np.testing.assert_allclose(np.std(found[48000, 0, 1][3].reshape(4, 8160), axis=1), levels, rtol=0.01)
    for channel in (1, 2, 3, 4):
        channels, frames, _, samples = found[16000, channel, 0]
        assert (channels, frames) == (1, 2720)
        assert frequency(samples, 16000) == pytest.approx(500.0, abs=6.0)
        assert np.std(samples) == pytest.approx(levels[channel - 1], rel=0.01)


def test_delays_between_channels_are_those_of_the_way_through_the_air(robot, device, hearing, source, patience):
    """For sources around the robot, each pair of microphones: within 0.02 ms."""
    noise = np.random.default_rng(3).standard_normal(RATE)
    for position in [(2.0, 0.0, 0.5), (0.0, 1.5, 0.5), (-1.0, -1.0, 1.0), (1.0, 0.2, 0.0)]:
        source(position, noise, level=75.0)
        device.subscribe("Hearing")
        robot.advance(0.8)
        samples = hearing.blocks(3, patience)[2][3].reshape(8160, 4)
        device.unsubscribe("Hearing")
        hearing.heard = queue.Queue()
        robot.advance(0.5)  # until the source has ended
        distances = np.linalg.norm(microphones_in_world(robot) - np.array(position), axis=1)
        expected = (distances - distances[0]) / SPEED_OF_SOUND
        found = [delay(samples[:, 0], samples[:, channel]) for channel in range(4)]
        np.testing.assert_allclose(found, expected, atol=2e-5)


def microphones_in_world(robot):
    """(4, 3) places of the microphones, from the true pose of the torso and NAOqi's transform of the head."""
    x, y, z, qx, qy, qz, qw = robot.NaoSimulation.torsoPose()
    torso = np.array(
        [
            [1 - 2 * (qy * qy + qz * qz), 2 * (qx * qy - qz * qw), 2 * (qx * qz + qy * qw)],
            [2 * (qx * qy + qz * qw), 1 - 2 * (qx * qx + qz * qz), 2 * (qy * qz - qx * qw)],
            [2 * (qx * qz - qy * qw), 2 * (qy * qz + qx * qw), 1 - 2 * (qx * qx + qy * qy)],
        ]
    )
    head = np.array(robot.ALMotion.getTransform("Head", 0, True)).reshape(4, 4)
    in_head = np.array(
        [
            [-0.021544, 0.055772, 0.077426],
            [-0.021543, -0.055772, 0.077426],
            [0.020626, 0.030938, 0.098582],
            [0.020627, -0.030938, 0.098582],
        ]
    )
    return (in_head @ head[:3, :3].T + head[:3, 3]) @ torso.T + [x, y, z]


def delay(first, second):
    """By how much `second` is later than `first`, s: the peak of their correlation, between samples as well."""
    size = 4 * len(first)
    spectrum = np.conj(np.fft.rfft(first, size)) * np.fft.rfft(second, size)
    correlation = np.fft.irfft(spectrum, size)
    peak = int(np.argmax(correlation))
    before, at, after = (correlation[(peak + step) % size] for step in (-1, 0, 1))
    place = peak + 0.5 * (before - after) / (before - 2.0 * at + after)
    return (place - size if place > size / 2 else place) / RATE


def test_fast_time_waits_for_a_module_that_is_slower(robot, device, hearing, patience, monkeypatch):
    """The module takes 100 ms for a block of 170 ms, and nothing is lost however fast time could run."""
    monkeypatch.setattr(microphone_clients, "WAITING", 6)
    hearing.pause = 0.1
    try:
        device.subscribe("Hearing")
        begun = robot.now.time
        robot.advance(5.0)
        blocks = hearing.blocks(round(5.0 / BLOCK) - 2, patience)
    finally:
        hearing.pause = 0.0
    times = [seconds + 1e-6 * microseconds for _, _, (seconds, microseconds), _ in blocks]
    assert times[0] <= begun + BLOCK
    np.testing.assert_allclose(np.diff(times), BLOCK, atol=2e-6)


def test_closed_inputs_are_silent(robot, device, hearing, patience, sound):
    device.subscribe("Hearing")
    device.enableEnergyComputation()
    robot.advance(0.5)
    hearing.blocks(1, patience)
    device.closeAudioInputs()
    assert device.isInputClosed() is True
    hearing.heard = queue.Queue()
    robot.advance(1.0)
    sound.ears.catch_up()
    assert device.getFrontMicEnergy() == 0.0
    assert hearing.heard.qsize() <= 1  # one may have been under way
    device.openAudioInputs()
    assert device.isInputClosed() is False
    hearing.heard = queue.Queue()
    robot.advance(1.0)
    assert hearing.blocks(4, patience)
    sound.ears.catch_up()
    assert device.getFrontMicEnergy() > 0.0


def test_a_file_can_stand_for_the_microphones(robot, device, hearing, patience):
    folder = robot.server.files.folder
    time = np.arange(2 * RATE) / RATE
    tones = np.stack([0.1 * (n + 1) * np.sin(2.0 * np.pi * 300.0 * (n + 1) * time) for n in range(4)], axis=1)
    soundfile.write(str(folder / "input.wav"), tones, RATE)
    soundfile.write(str(folder / "mono.wav"), tones[:, 1], RATE)
    device.subscribe("Hearing")
    device.setFileAsInput("input.wav")
    robot.advance(0.8)
    samples = hearing.blocks(3, patience)[2][3].reshape(8160, 4)
    assert [frequency(channel) for channel in samples.T] == pytest.approx([300.0, 600.0, 900.0, 1200.0], abs=6.0)
    levels = [loudness(channel) * np.sqrt(2.0) / 32768.0 for channel in samples.T]
    assert levels == pytest.approx([0.1, 0.2, 0.3, 0.4], rel=0.02)
    device.setFileAsInput("mono.wav")
    hearing.heard = queue.Queue()
    robot.advance(0.8)
    samples = hearing.blocks(4, patience)[3][3].reshape(8160, 4)
    assert [frequency(channel) for channel in samples.T] == pytest.approx([600.0] * 4, abs=6.0)
    device.setFileAsInput("")
    hearing.heard = queue.Queue()
    robot.advance(0.8)
    assert loudness(hearing.blocks(4, patience)[3][3]) < 100.0
