"""ALAudioRecorder and the recordings of ALAudioDevice: what is in the files afterwards."""

from __future__ import annotations

import pytest
from sounds import RATE, read

ALL, FRONT = [1, 1, 1, 1], [0, 0, 1, 0]


@pytest.fixture
def recorder(robot):
    return robot.ALAudioRecorder


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


def test_what_is_refused_names_what_is_allowed(refused):
    rows = [
        (("a.mp3", "mp3", 48000, ALL), "ALAudioRecorder::startM.* type is 'mp3', allowed is wav or ogg"),
        (("a.wav", "ogg", 48000, ALL), "filename is 'a.wav', allowed is a name that ends in .ogg, as the type says"),
        (("a.wav", "wav", 44100, ALL), "48000 Hz with channels 0 .all four., or 16000 Hz with 1 .left"),
        (("a.wav", "wav", 48000, [1, 1, 1]), "flags .left, right, front, rear. of 0 or 1"),
        (("../a.wav", "wav", 48000, ALL), "is not inside .*; give a relative name"),
    ]
    refused("ALAudioRecorder", [("startMicrophonesRecording", *row) for row in rows])
