"""Films of cameras that lose frames, and of disks that are full."""

from __future__ import annotations

import resource
from contextlib import contextmanager

import av
import numpy as np
import pytest
from fake_cameras import FakeCameras

from nao_sim_bridge.services.errors import NaoqiError
from nao_sim_bridge.services.vision.video_recorder_file import Film
from nao_sim_bridge.services.vision.video_recorder_recording import FilmSettings, VideoRecorder
from nao_sim_bridge.sim.cameras.settings import load_cameras
from nao_sim_bridge.sim.tasks import Task

SETTINGS = FilmSettings(camera=0, resolution=0, color_space=13, rate=10.0, kind="MJPG")


class Runner:
    """A simulation that does at once what it is told."""

    def execute(self, command, name=""):
        task = Task(name, 0)
        task.finish(command())
        return task


@contextmanager
def full_disk(size):
    """No file can become larger than `size` bytes."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


@pytest.fixture
def cameras():
    return FakeCameras()


@pytest.fixture
def recorder(cameras):
    recorder = VideoRecorder(cameras, Runner(), load_cameras("V6"), "films")
    yield recorder
    recorder.close()


def shades(path):
    """Grey of each frame."""
    with av.open(str(path)) as film:
        return [frame.to_ndarray(format="gray").mean() for frame in film.decode(video=0)]


def test_every_frame_is_in_the_film_in_order(tmp_path, cameras, recorder, patience):
    recorder.start(tmp_path / "a.avi", SETTINGS)
    cameras.advance(0.9)
    assert recorder.stop().result(patience) == [10, str(tmp_path / "a.avi")]
    assert shades(tmp_path / "a.avi") == pytest.approx([10.0 * k for k in range(10)], abs=2.0)


def test_frames_that_were_lost_are_filled_with_the_one_before(tmp_path, cameras, recorder, patience):
    cameras.losing = {3, 4}
    recorder.start(tmp_path / "a.avi", SETTINGS)
    cameras.advance(0.7)
    assert recorder.stop().result(patience)[0] == 8
    assert shades(tmp_path / "a.avi") == pytest.approx([0, 10, 20, 20, 20, 50, 60, 70], abs=2.0)


def test_a_recording_looks_no_longer_than_it_lasts(tmp_path, cameras, recorder, patience):
    recorder.start(tmp_path / "a.avi", SETTINGS)
    task = recorder.stop()
    cameras.advance(1.0)
    assert task.result(patience)[0] == 1


def noisy(number, shape):
    return np.random.default_rng(number).integers(0, 255, shape, dtype=np.uint8)


def test_a_full_disk_ends_the_film_and_says_what_is_in_it(tmp_path, recorder, cameras, patience):
    cameras.paint = noisy
    path = tmp_path / "a.avi"
    with full_disk(200000):
        recorder.start(path, SETTINGS)
        cameras.advance(2.0)
        with pytest.raises(
            NaoqiError, match=r"a.avi' is not complete, it ends after (\d+) frames: .*File too large"
        ) as failure:
            recorder.stop().result(patience)
    frames = int(str(failure.value).split(" frames")[0].rpartition(" ")[2])
    assert 3 < frames < 20
    assert len(shades(path)) == frames
    assert path.stat().st_size <= 200000
    recorder.start(tmp_path / "b.avi", SETTINGS)
    assert recorder.stop().result(patience)[0] == 1


def test_a_disk_without_room_for_a_frame_is_left_as_it_was(tmp_path, recorder, cameras, patience):
    cameras.paint = noisy
    with full_disk(3000):
        recorder.start(tmp_path / "a.avi", SETTINGS)
        with pytest.raises(NaoqiError, match="a.avi' has not become a file: .*File too large"):
            recorder.stop().result(patience)
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_is_not_there_is_an_error_at_the_start(tmp_path, recorder):
    with pytest.raises(NaoqiError, match="cannot be written: No such file or directory"):
        recorder.start(tmp_path / "none" / "a.avi", SETTINGS)
    assert not recorder.records


def test_the_end_of_the_simulator_completes_the_film(tmp_path, cameras, recorder):
    recorder.start(tmp_path / "a.avi", SETTINGS)
    cameras.advance(0.4)
    recorder.close()
    assert len(shades(tmp_path / "a.avi")) == 5


def test_cameras_that_end_complete_the_film(tmp_path, cameras, recorder, patience):
    recorder.start(tmp_path / "a.avi", SETTINGS)
    recording = recorder._recording
    cameras.opened[0].finish()
    assert recording.ended.result(patience)[0] == 1
    assert recorder.stop().result(patience)[0] == 1


@pytest.mark.parametrize("kind", ["MJPG", "IYUV"])
def test_colours_come_through(tmp_path, kind):
    path = tmp_path / "a.avi"
    film = Film(path, kind, 64, 48, 10.0)
    film.write(np.full((48, 64, 3), (20, 40, 200), np.uint8))
    film.close()
    with av.open(str(path)) as read:
        (frame,) = read.decode(video=0)
        assert frame.to_ndarray(format="bgr24").mean(axis=(0, 1)) == pytest.approx((20, 40, 200), abs=6)
