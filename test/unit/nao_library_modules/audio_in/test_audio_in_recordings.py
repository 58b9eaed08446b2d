"""Recordings on stand-ins: formats, ends, who owns them."""

from __future__ import annotations

import pytest
from audio_in_goals import LISTEN, YES_NO, f, play, succeed

from nao_library_modules.audio_in_checks import recording_format


def test_a_recording_takes_its_time_and_is_in_the_result(hearing, ears, robot, clock):
    result = succeed(hearing, f("record", str_param="day/hello.wav", duration=3.0))
    start, stop = robot.proxy("ALAudioRecorder").calls
    assert start[1:] == ("/home/nao/day/hello.wav", "wav", 16000, [0, 0, 1, 0])
    assert stop == ("stopMicrophonesRecording",)
    (file,) = result.files
    assert (file.path, file.duration, file.rate, file.channels) == ("day/hello.wav", 3.0, 16000, ["front"])
    assert (file.file_type, clock.waits, result.memList) == ("wav", [3.0], [])
    assert result.results[0].values == ["day/hello.wav", "3.0"]


@pytest.mark.parametrize(
    "rate, channels, expected",
    [
        (0, [], (16000, ["front"])),
        (48000, [], (48000, ["left", "right", "front", "rear"])),
        (0, ["rear"], (16000, ["rear"])),
        (16000, ["left"], (16000, ["left"])),
        (0, ["rear", "front", "left", "right"], (48000, ["left", "right", "front", "rear"])),
    ],
)
def test_rate_and_channels_belong_together(rate, channels, expected):
    assert recording_format(rate, channels) == expected


def test_a_preempted_recording_is_closed_and_in_the_result(hearing, ears, clock):
    clock.script = [hearing.server.preempt]
    server = play(hearing, f("record", str_param="a.ogg", duration=60.0), LISTEN)
    assert server.end == "preempted"
    assert ears.recorder.done == ["/home/nao/a.ogg"] and ears.idle()
    assert [file.path for file in server.result.files] == ["a.ogg"]
    assert server.result.files[0].duration < 60.0


def test_a_recording_outlives_its_goal_until_it_is_stopped(hearing, ears, clock):
    assert succeed(hearing, f("startRecording", str_param="a.wav", rate=48000)).files == []
    assert ears.recorder.running
    clock.time += 7.0
    result = succeed(hearing, f("stopRecording"))
    assert (result.files[0].path, result.files[0].duration) == ("a.wav", 7.0)
    assert len(result.files[0].channels) == 4 and ears.idle()


def test_the_end_of_the_server_ends_what_goals_have_left(hearing, ears, edge):
    succeed(
        hearing,
        f("startRecording", str_param="a.wav"),
        f("startRecognition", vocabulary=YES_NO),
        f("enableEnergyComputation"),
        f("pause"),
    )
    assert ears.recorder.running and ears.recognition.subscribers and ears.card.computing and ears.recognition.paused
    for action in edge.shutdown_actions:
        action()
    assert ears.idle() and not ears.recognition.paused


def test_two_recordings_at_once_are_refused_before_anything_runs(hearing, ears):
    start, record = f("startRecording", str_param="a.wav"), f("record", str_param="b.wav", duration=1.0)
    server = play(hearing, start, record)
    assert server.end == "aborted"
    assert "function 2 (record)" in server.text and "stopRecording comes first" in server.text
    assert ears.recorder.running is None
    succeed(hearing, start)
    assert play(hearing, record).end == "aborted"
    succeed(hearing, f("stopRecording"), record)


def test_a_recording_of_another_program_is_left_alone(hearing, ears):
    ears.recorder.running = ("theirs.wav", "wav", 16000, [1, 0, 0, 0])
    server = play(hearing, f("record", str_param="a.wav", duration=1.0))
    assert server.end == "aborted" and "a recording runs already" in server.text
    assert ears.recorder.running and server.result.files == []


def test_a_preemption_while_the_recording_begins_ends_it(hearing, ears, robot, make_call):
    call = make_call("ALAudioRecorder.startMicrophonesRecording")
    begun = ears.recorder.startMicrophonesRecording

    def slow(*args):
        begun(*args)
        hearing.server.preempt()
        call.end()
        return call

    ears.recorder.startMicrophonesRecording = slow
    assert play(hearing, f("record", str_param="a.wav", duration=1.0)).end == "preempted"
    assert ears.recorder.done == ["/home/nao/a.wav"] and not call.canceled
