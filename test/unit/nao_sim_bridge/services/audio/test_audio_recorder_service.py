"""ALAudioRecorder and the recordings of ALAudioDevice over the network: what is in the files afterwards."""

from __future__ import annotations

import numpy as np
import pytest
import qi
import soundfile

from nao_sim_bridge.server import ServerOptions, SimulatorServer
from nao_sim_bridge.sim.simulation import Scene
from nao_sim_bridge.sim.sound import wav_file

RATE = 48000
ALL, FRONT = [1, 1, 1, 1], [0, 0, 1, 0]


@pytest.fixture
def recorder(robot):
    robot.ALAudioDevice.setOutputVolume(100)
    yield robot.ALAudioRecorder
    robot.ALAudioRecorder.stopMicrophonesRecording()
    robot.ALAudioDevice.stopMicrophonesRecording()


@pytest.fixture
def read(robot):
    """Samples (frames, channels) and rate of a recording."""
    return lambda name: soundfile.read(str(robot.server.files.folder / name), always_2d=True)


def frequency(samples, rate):
    spectrum = np.abs(np.fft.rfft(samples * np.hanning(len(samples))))
    return np.argmax(spectrum) * rate / len(samples)


def loudness(samples):
    return np.sqrt(np.mean(np.asarray(samples, dtype=float) ** 2))


@pytest.mark.parametrize(
    "name, kind, rate, flags, channels",
    [
        ("a.wav", "wav", 48000, ALL, 4),
        ("day/one/b.wav", "wav", 16000, FRONT, 1),
        ("c.ogg", "ogg", 16000, [0, 0, 0, 1], 1),
        ("/home/nao/recordings/d.ogg", "ogg", 48000, ALL, 4),
    ],
)
def test_a_recording_has_the_length_between_start_and_stop(robot, recorder, read, name, kind, rate, flags, channels):
    robot.advance(0.05)
    recorder.startMicrophonesRecording(name, kind, rate, flags)
    begun = robot.now.time
    robot.advance(1.111)
    recorder.stopMicrophonesRecording()
    lasted = robot.now.time - begun
    robot.advance(0.5)
    samples, found = read(name.replace("/home/nao/", ""))
    assert (found, samples.shape[1]) == (rate, channels)
    assert len(samples) == pytest.approx(lasted * rate, abs=2)


@pytest.mark.parametrize("kind, rate, flags", [("wav", 48000, ALL), ("wav", 16000, FRONT), ("ogg", 16000, FRONT)])
def test_a_tone_of_its_own_is_in_the_recording_from_its_first_to_its_last_moment(
    robot, recorder, read, kind, rate, flags
):
    name = f"tone.{kind}"
    recorder.startMicrophonesRecording(name, kind, rate, flags)
    robot.advance(0.5)
    robot.finish("ALAudioPlayer", "playSine", 1000, 50, 0, 1.0, after=1.0)
    robot.advance(0.5)
    recorder.stopMicrophonesRecording()
    samples, _ = read(name)
    tone, quiet = samples[round(0.55 * rate) : round(1.45 * rate)], samples[: round(0.45 * rate)]
    for channel in range(samples.shape[1]):
        assert frequency(tone[:, channel], rate) == pytest.approx(1000.0, abs=1.2)
        assert loudness(tone[:, channel]) > 50.0 * loudness(quiet[:, channel])
    above = np.flatnonzero(np.abs(samples[:, 0]) > 0.3 * np.abs(tone).max()) / rate
    assert above[[0, -1]] == pytest.approx([0.5, 1.5], abs=0.006)


def test_the_microphones_of_a_side_hear_more_of_the_loudspeaker_there(robot, recorder, read):
    recorder.startMicrophonesRecording("pan.wav", "wav", 48000, ALL)
    for pan in (-1, 1):
        robot.finish("ALAudioPlayer", "playSine", 1000, 50, pan, 0.5, after=0.5)
    recorder.stopMicrophonesRecording()
    samples, _ = read("pan.wav")
    by_left, by_right = (np.std(samples[first : first + 14400], axis=0) for first in (4800, 28800))
    assert by_left[0] > 1.05 * by_left[1] and by_right[1] > 1.05 * by_right[0]
    assert by_left[0] == pytest.approx(by_right[1], rel=0.01)


def test_a_recording_grows_and_can_be_read_while_it_goes_on(robot, recorder, read):
    recorder.startMicrophonesRecording("live.wav", "wav", 48000, ALL)
    for seconds in (1, 2, 3):
        robot.advance(1.0)
        robot.server.simulation.sound.ears.catch_up()
        assert seconds - 0.35 < len(read("live.wav")[0]) / RATE <= seconds + 0.01


def test_recordings_go_through_a_reset(robot, recorder, read):
    recorder.startMicrophonesRecording("reset.wav", "wav", 48000, ALL)
    begun = robot.now.time
    robot.advance(0.5)
    robot.NaoSimulation.reset()
    robot.advance(0.5)
    recorder.stopMicrophonesRecording()
    assert len(read("reset.wav")[0]) == pytest.approx((robot.now.time - begun) * RATE, abs=2)


def test_the_end_of_the_simulator_completes_what_is_recorded(tmp_path):
    server = SimulatorServer(ServerOptions(Scene(posture="Stand"), port=0, paused=True, record_dir=tmp_path))
    server.start()
    session = qi.Session()
    session.connect(f"tcp://127.0.0.1:{server.broker.port}")
    try:
        session.service("ALAudioDevice").startMicrophonesRecording("a.ogg")
        session.service("ALAudioRecorder").startMicrophonesRecording("a.wav", "wav", 48000, ALL)
        session.service("NaoSimulation").advance(1.0)
    finally:
        session.close()
        server.stop()
    assert [soundfile.info(str(tmp_path / name)).duration for name in ("a.ogg", "a.wav")] == pytest.approx(
        [1.0, 1.0], abs=0.01
    )


def test_one_recording_at_a_time_and_the_next_after_it(robot, recorder, read):
    recorder.startMicrophonesRecording("one.wav", "wav", 48000, ALL)
    with pytest.raises(RuntimeError, match="a recording to 'one.wav' is under way; stop it first"):
        recorder.startMicrophonesRecording("two.wav", "wav", 48000, ALL)
    assert not (robot.server.files.folder / "two.wav").exists()
    robot.advance(0.2)
    recorder.stopMicrophonesRecording()
    recorder.stopMicrophonesRecording()
    recorder.startMicrophonesRecording("one.wav", "wav", 16000, FRONT)
    robot.advance(0.4)
    recorder.stopMicrophonesRecording()
    samples, rate = read("one.wav")
    assert (rate, len(samples)) == (16000, pytest.approx(6400, abs=140))


def test_two_recordings_need_two_files(robot, recorder, read):
    recorder.startMicrophonesRecording("both.wav", "wav", 16000, FRONT)
    with pytest.raises(RuntimeError, match="'day/../both.wav' is being written to by another recording"):
        robot.ALAudioDevice.startMicrophonesRecording("day/../both.wav")
    robot.ALAudioDevice.startMicrophonesRecording("other.wav")
    robot.advance(0.3)
    recorder.stopMicrophonesRecording()
    robot.ALAudioDevice.stopMicrophonesRecording()
    assert read("both.wav")[1] == 16000 and read("other.wav")[1] == 48000
    robot.ALAudioDevice.startMicrophonesRecording("both.wav")


def test_a_file_that_cannot_grow_is_reported(robot, recorder, read, monkeypatch):
    recorder.startMicrophonesRecording("full.wav", "wav", 48000, ALL)
    robot.advance(0.5)
    robot.server.simulation.sound.ears.catch_up()
    monkeypatch.setattr(wav_file, "LARGEST", 1000)
    robot.advance(0.5)
    with pytest.raises(RuntimeError, match="'full.wav' is not complete: .*4 GiB"):
        recorder.stopMicrophonesRecording()
    assert 0.1 < len(read("full.wav")[0]) / RATE < 0.6
    recorder.startMicrophonesRecording("full.wav", "wav", 48000, ALL)


def test_the_device_records_by_the_ending_of_the_name(robot, recorder, read):
    for name, rate, channels in [("device.wav", 48000, 4), ("device.ogg", 16000, 1)]:
        robot.ALAudioDevice.startMicrophonesRecording(name)
        begun = robot.now.time
        robot.advance(0.5)
        robot.ALAudioDevice.stopMicrophonesRecording()
        samples, found = read(name)
        assert (found, samples.shape[1]) == (rate, channels)
        assert len(samples) == pytest.approx((robot.now.time - begun) * rate, abs=2)


@pytest.mark.parametrize(
    "arguments, message",
    [
        (("a.mp3", "mp3", 48000, ALL), "type is 'mp3', allowed is wav or ogg"),
        (("a.wav", "ogg", 48000, ALL), "filename is 'a.wav', allowed is a name that ends in .ogg, as the type says"),
        (("a", "wav", 48000, ALL), "filename is 'a', allowed is a name that ends in .wav or .ogg"),
        (("a.wav", "wav", 44100, ALL), "48000 Hz with channels 0 .all four., or 16000 Hz with 1 .left"),
        (("a.wav", "wav", 16000, ALL), "48000 Hz with channels 0 .all four., or 16000 Hz with 1 .left"),
        (("a.wav", "wav", 48000, FRONT), "48000 Hz with channels 0 .all four."),
        (("a.wav", "wav", 48000, [1, 1, 1]), "flags .left, right, front, rear. of 0 or 1"),
        (("a.wav", "wav", 48000, "1111"), "flags .left, right, front, rear. of 0 or 1"),
        (("../a.wav", "wav", 48000, ALL), "is not inside .*; give a relative name"),
        (("/etc/a.wav", "wav", 48000, ALL), "is not inside"),
    ],
)
def test_what_is_refused_names_what_is_allowed(robot, recorder, arguments, message):
    with pytest.raises(RuntimeError, match=f"ALAudioRecorder::startMicrophonesRecording .*{message}"):
        recorder.startMicrophonesRecording(*arguments)
    recorder.startMicrophonesRecording("after.wav", "wav", 48000, ALL)


def test_a_file_that_cannot_be_written_is_named(robot, recorder):
    (robot.server.files.folder / "folder.wav").mkdir(parents=True, exist_ok=True)
    with pytest.raises(RuntimeError, match="'folder.wav' cannot be written: Is a directory"):
        recorder.startMicrophonesRecording("folder.wav", "wav", 48000, ALL)
    with pytest.raises(RuntimeError, match="'folder.ogg' cannot be written: "):
        (robot.server.files.folder / "folder.ogg").mkdir(exist_ok=True)
        recorder.startMicrophonesRecording("folder.ogg", "ogg", 16000, FRONT)
    recorder.startMicrophonesRecording("after.wav", "wav", 48000, ALL)
