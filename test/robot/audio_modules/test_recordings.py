"""ALAudioRecorder and the recordings of ALAudioDevice: what is in the files afterwards."""

from __future__ import annotations

import numpy as np
import pytest
import soundfile
from simulator import Simulator
from sounds import RATE, frequency, loudness, read

from nao_sim_bridge.sim.sound import wav_file

ALL, FRONT = [1, 1, 1, 1], [0, 0, 1, 0]


@pytest.fixture
def recorder(robot):
    return robot.ALAudioRecorder


@pytest.mark.parametrize(
    "name, kind, rate, flags, channels",
    [
        ("a.wav", "wav", 48000, ALL, 4),
        ("day/one/b.wav", "wav", 16000, FRONT, 1),
        ("c.ogg", "ogg", 16000, [0, 0, 0, 1], 1),
        ("/home/nao/recordings/d.ogg", "ogg", 48000, ALL, 4),
    ],
)
def test_a_tone_is_in_the_recording_from_its_first_to_its_last_moment(
    robot, recorder, name, kind, rate, flags, channels
):
    robot.advance(0.05)
    recorder.startMicrophonesRecording(name, kind, rate, flags)
    begun = robot.now.time
    robot.advance(0.25)
    robot.finish("ALAudioPlayer", "playSine", 1000, 50, 0, 0.5, after=0.5)
    robot.advance(0.261)
    recorder.stopMicrophonesRecording()
    lasted = robot.now.time - begun
    robot.advance(0.3)
    samples, found = read(robot, name.replace("/home/nao/", ""))
    assert (found, samples.shape[1]) == (rate, channels)
    assert len(samples) == pytest.approx(lasted * rate, abs=2)
    sounds, quiet = samples[round(0.3 * rate) : round(0.7 * rate)], samples[: round(0.2 * rate)]
    for channel in range(channels):
        assert frequency(sounds[:, channel], rate) == pytest.approx(1000.0, abs=2.6)
        assert loudness(sounds[:, channel]) > 50.0 * loudness(quiet[:, channel])
    above = np.flatnonzero(np.abs(samples[:, 0]) > 0.3 * np.abs(sounds).max()) / rate
    assert above[[0, -1]] == pytest.approx([0.25, 0.75], abs=0.006)


def test_the_microphones_of_a_side_hear_more_of_the_loudspeaker_there(robot, recorder):
    recorder.startMicrophonesRecording("pan.wav", "wav", 48000, ALL)
    for pan in (-1, 1):
        robot.finish("ALAudioPlayer", "playSine", 1000, 50, pan, 0.5, after=0.5)
    recorder.stopMicrophonesRecording()
    samples, _ = read(robot, "pan.wav")
    by_left, by_right = (np.std(samples[first : first + 14400], axis=0) for first in (4800, 28800))
    assert by_left[0] > 1.05 * by_left[1] and by_right[1] > 1.05 * by_right[0]
    assert by_left[0] == pytest.approx(by_right[1], rel=0.01)


def test_a_recording_grows_can_be_read_while_it_goes_on_and_goes_through_a_reset(robot, recorder):
    recorder.startMicrophonesRecording("live.wav", "wav", 48000, ALL)
    begun = robot.now.time
    for seconds in (1, 2):
        robot.advance(1.0)
        robot.server.simulation.sound.ears.catch_up()
        assert seconds - 0.35 < len(read(robot, "live.wav")[0]) / RATE <= seconds + 0.01
    robot.NaoSimulation.reset()
    robot.advance(0.5)
    recorder.stopMicrophonesRecording()
    assert len(read(robot, "live.wav")[0]) == pytest.approx((robot.now.time - begun) * RATE, abs=2)


def test_the_end_of_the_simulator_completes_what_is_recorded(tmp_path):
    other = Simulator(tmp_path)
    try:
        other.ALAudioDevice.startMicrophonesRecording("a.ogg")
        other.ALAudioRecorder.startMicrophonesRecording("a.wav", "wav", 48000, ALL)
        other.advance(0.5)
    finally:
        other.close()
    durations = [soundfile.info(str(tmp_path / name)).duration for name in ("a.ogg", "a.wav")]
    assert durations == pytest.approx([0.5, 0.5], abs=0.01)


def test_one_recording_at_a_time_and_two_need_two_files(robot, recorder):
    device = robot.ALAudioDevice
    recorder.stopMicrophonesRecording()  # no harm
    recorder.startMicrophonesRecording("one.wav", "wav", 16000, FRONT)
    with pytest.raises(RuntimeError, match="a recording to 'one.wav' is under way; stop it first"):
        recorder.startMicrophonesRecording("two.wav", "wav", 48000, ALL)
    with pytest.raises(RuntimeError, match="'day/../one.wav' is being written to by another recording"):
        device.startMicrophonesRecording("day/../one.wav")
    for name, rate, channels in [("device.wav", 48000, 4), ("device.ogg", 16000, 1)]:
        device.startMicrophonesRecording(name)
        begun = robot.now.time
        robot.advance(0.3)
        device.stopMicrophonesRecording()
        samples, found = read(robot, name)
        assert (found, samples.shape[1]) == (rate, channels)
        assert len(samples) == pytest.approx((robot.now.time - begun) * rate, abs=2)
    recorder.stopMicrophonesRecording()
    recorder.stopMicrophonesRecording()
    assert len(read(robot, "one.wav")[0]) == pytest.approx(9600, abs=200)
    device.startMicrophonesRecording("one.wav")
    assert not (robot.server.files.folder / "two.wav").exists()


def test_a_file_that_cannot_grow_is_reported(robot, recorder, monkeypatch):
    recorder.startMicrophonesRecording("full.wav", "wav", 48000, ALL)
    robot.advance(0.5)
    robot.server.simulation.sound.ears.catch_up()
    monkeypatch.setattr(wav_file, "LARGEST", 1000)
    robot.advance(0.5)
    with pytest.raises(RuntimeError, match="'full.wav' is not complete: .*4 GiB"):
        recorder.stopMicrophonesRecording()
    assert 0.1 < len(read(robot, "full.wav")[0]) / RATE < 0.6
    recorder.startMicrophonesRecording("full.wav", "wav", 48000, ALL)


def test_what_is_refused_names_what_is_allowed(robot, recorder, refused):
    folder = robot.server.files.folder
    for name in ("folder.wav", "folder.ogg"):
        (folder / name).mkdir(parents=True, exist_ok=True)
    rows = [
        (
            ("a.mp3", "mp3", 48000, ALL),
            "ALAudioRecorder::startMicrophonesRecording type is 'mp3', allowed is wav or ogg",
        ),
        (("a.wav", "ogg", 48000, ALL), "filename is 'a.wav', allowed is a name that ends in .ogg, as the type says"),
        (("a", "wav", 48000, ALL), "filename is 'a', allowed is a name that ends in .wav or .ogg"),
        (("a.wav", "wav", 44100, ALL), "48000 Hz with channels 0 .all four., or 16000 Hz with 1 .left"),
        (("a.wav", "wav", 16000, ALL), "48000 Hz with channels 0 .all four., or 16000 Hz with 1 .left"),
        (("a.wav", "wav", 48000, FRONT), "48000 Hz with channels 0 .all four."),
        (("a.wav", "wav", 48000, [1, 1, 1]), "flags .left, right, front, rear. of 0 or 1"),
        (("a.wav", "wav", 48000, "1111"), "flags .left, right, front, rear. of 0 or 1"),
        (("../a.wav", "wav", 48000, ALL), "is not inside .*; give a relative name"),
        (("/etc/a.wav", "wav", 48000, ALL), "is not inside"),
        (("folder.wav", "wav", 48000, ALL), "'folder.wav' cannot be written: Is a directory"),
        (("folder.ogg", "ogg", 16000, FRONT), "'folder.ogg' cannot be written: "),
    ]
    refused("ALAudioRecorder", [("startMicrophonesRecording", *row) for row in rows])
    for name in (".wav", "wav", "", "a.b.txt"):
        with pytest.raises(RuntimeError, match="a name that ends in .wav or .ogg"):
            robot.ALAudioDevice.startMicrophonesRecording(name)
    recorder.startMicrophonesRecording("day/A.WAV", "wav", 48000, ALL)
