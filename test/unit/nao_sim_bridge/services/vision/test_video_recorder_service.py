"""ALVideoRecorder over the network: films that open, with the right number of frames, rate and size."""

from __future__ import annotations

import av
import pytest
import qi

from nao_sim_bridge.server import ServerOptions, SimulatorServer
from nao_sim_bridge.sim.simulation import Scene

PICTURES = {0: (160, 120), 1: (320, 240), 2: (640, 480)}


@pytest.fixture
def films(robot):
    films = robot.ALVideoRecorder
    films.setResolution(0)
    yield films
    films.stopRecording()
    for method, value in [("setColorSpace", 13), ("setVideoFormat", "MJPG"), ("setFrameRate", 15), ("setCameraID", 0)]:
        films.call(method, value)


def read(path):
    """Codec, size, rate and number of the frames of a film."""
    with av.open(str(path)) as film:
        stream = film.streams.video[0]
        count = sum(1 for _ in film.decode(stream))
        return stream.codec_context.name, (stream.width, stream.height), float(stream.average_rate), count


def test_defaults_are_those_of_the_robot(shared_robot):
    films = shared_robot.ALVideoRecorder
    found = [films.getCameraID(), films.getResolution(), films.getColorSpace(), films.getFrameRate()]
    assert found == [0, 1, 13, 15]
    assert films.getVideoFormat() == "MJPG" and not films.isRecording()


@pytest.mark.parametrize(
    "kind, resolution, rate, color_space, codec",
    [
        ("MJPG", 0, 15, 13, "mjpeg"),
        ("MJPG", 1, 30, 0, "mjpeg"),
        ("IYUV", 0, 10, 13, "rawvideo"),
        ("MJPG", 0, 2.5, 13, "mjpeg"),
    ],
)
def test_a_film_has_a_frame_for_each_period_that_it_lasted(robot, films, kind, resolution, rate, color_space, codec):
    films.setVideoFormat(kind)
    films.setResolution(resolution)
    films.setColorSpace(color_space)
    films.setFrameRate(rate)
    films.startRecording("films", "one")
    assert films.isRecording()
    robot.advance(2.0)
    frames, path = films.stopRecording()
    assert not films.isRecording()
    assert path == str(robot.server.files.folder / "films" / "one.avi")
    assert read(path) == (codec, PICTURES[resolution], pytest.approx(rate), frames)
    assert frames == 2.0 * rate


def test_films_in_vga_have_fifteen_frames_a_second_at_most(robot, films):
    films.setResolution(2)
    films.setFrameRate(30)
    films.startRecording("films", "vga.avi")
    robot.advance(0.4)
    frames, path = films.stopRecording()
    assert read(path) == ("mjpeg", (640, 480), 15.0, frames)
    assert frames == 6


def test_recordings_go_through_a_reset(robot, films):
    films.startRecording("films", "reset")
    robot.advance(1.0)
    robot.NaoSimulation.reset()
    robot.advance(1.0)
    frames, path = films.stopRecording()
    assert (frames, read(path)[3]) == (30, 30)


def test_settings_that_change_meanwhile_count_for_the_next_film(robot, films):
    films.startRecording("films", "settings")
    films.setResolution(1)
    robot.advance(0.5)
    assert read(films.stopRecording()[1])[1] == PICTURES[0]


def test_one_recording_at_a_time_and_the_next_after_it(robot, films):
    films.startRecording("films", "first")
    with pytest.raises(RuntimeError, match="first.avi' is under way; stop it first"):
        films.startRecording("films", "second")
    assert not (robot.server.files.folder / "films" / "second.avi").exists()
    robot.advance(0.2)
    assert films.stopRecording()[0] == 3
    assert films.stopRecording() == [0, ""]
    films.startRecording("films", "second")
    robot.advance(0.2)
    assert films.stopRecording()[0] == 3


def test_a_film_that_is_there_is_kept_when_it_must_not_be_overwritten(robot, films):
    path = robot.server.files.folder / "kept.avi"
    path.write_bytes(b"old")
    with pytest.raises(RuntimeError, match="kept.avi' exists already, and is not to be overwritten"):
        films.startRecording("", "kept", False)
    assert path.read_bytes() == b"old"
    films.startRecording("", "kept", True)
    robot.advance(0.2)
    assert read(films.stopRecording()[1])[3] == 3


def test_a_film_without_a_picture_is_no_film(robot, films):
    films.startRecording("films", "empty")
    with pytest.raises(RuntimeError, match="empty.avi' has not become a file: no picture was taken"):
        films.stopRecording()
    assert not (robot.server.files.folder / "films" / "empty.avi").exists()


def test_the_end_of_the_simulator_completes_the_film(tmp_path):
    server = SimulatorServer(ServerOptions(Scene(posture="Stand"), port=0, paused=True, record_dir=tmp_path))
    server.start()
    session = qi.Session()
    session.connect(f"tcp://127.0.0.1:{server.broker.port}")
    try:
        session.service("ALVideoRecorder").startRecording("", "end")
        session.service("NaoSimulation").advance(1.0)
    finally:
        session.close()
        server.stop()
    assert read(tmp_path / "end.avi")[3] == 15


@pytest.mark.parametrize(
    "method, arguments, message",
    [
        ("setCameraID", (2,), "camera is 2, allowed is"),
        ("setResolution", (3,), "resolution is 3, allowed is 0 .160x120., 1 .320x240. or 2 .640x480."),
        ("setColorSpace", (11,), "colorSpace is 11, allowed is 0 .grey. or 13 .BGR."),
        ("setFrameRate", (31.0,), "frameRate is 31.0, allowed is 1 to 30"),
        ("setVideoFormat", ("H264",), "videoFormat is 'H264', allowed is MJPG or IYUV"),
        ("startRecording", ("..", "a"), "is not inside"),
        ("startRecording", ("/etc", "a"), "is not inside"),
        ("startRecording", ("films", ""), "fileName is '', allowed is the name of a file"),
    ],
)
def test_what_is_refused_names_what_is_allowed(films, method, arguments, message):
    with pytest.raises(RuntimeError, match=f"ALVideoRecorder::{method} .*{message}"):
        films.call(method, *arguments)
    assert not films.isRecording()


def test_raw_films_have_colours(films):
    films.setVideoFormat("IYUV")
    films.setColorSpace(0)
    with pytest.raises(RuntimeError, match="IYUV has no grey films"):
        films.startRecording("films", "grey")


def test_mjpg_needs_more_than_two_frames_a_second(films):
    films.setFrameRate(2)
    with pytest.raises(RuntimeError, match="frameRate is 2.0, allowed is more than 2 with MJPG"):
        films.startRecording("films", "slow")


def test_a_file_that_cannot_be_written_is_named(robot, films):
    (robot.server.files.folder / "folder.avi").mkdir(exist_ok=True)
    with pytest.raises(RuntimeError, match="folder.avi' cannot be written: Is a directory"):
        films.startRecording("", "folder")
    assert not films.isRecording()
