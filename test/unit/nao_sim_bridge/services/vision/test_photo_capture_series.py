"""Series of pictures from cameras of no robot, and onto disks that are full."""

from __future__ import annotations

import threading

import cv2
import pytest
from fake_cameras import FakeCameras

from nao_sim_bridge.record_dir import ClientFiles
from nao_sim_bridge.services.errors import NaoqiError
from nao_sim_bridge.services.vision.photo_capture_files import picture_files, save
from nao_sim_bridge.services.vision.photo_capture_series import MOST_SERIES, Photographer, PhotoSettings
from nao_sim_bridge.sim.errors import BadValue

SETTINGS = PhotoSettings(camera=1, resolution=0, color_space=0, interval=0.25)


@pytest.fixture
def cameras():
    return FakeCameras()


@pytest.fixture
def photographer(cameras):
    photographer = Photographer(cameras, "photos")
    yield photographer
    photographer.close()


def shade(path):
    return cv2.imread(str(path), cv2.IMREAD_UNCHANGED).mean()


def test_each_picture_is_of_its_moment(tmp_path, cameras, photographer, patience):
    paths = [tmp_path / f"{number}.png" for number in range(3)]
    task = photographer.take(paths, SETTINGS)
    cameras.advance(0.49)
    assert not task.finished
    cameras.advance(0.02)
    assert task.result(patience) == [str(path) for path in paths]
    assert [shade(path) for path in paths] == [0.0, 10.0, 20.0]
    (stream,) = cameras.opened
    assert (stream.camera, stream.resolution, stream.fps, stream.every) == (1, 0, 4.0, True)
    assert stream.closed


def test_no_series_is_faster_than_the_camera(tmp_path, cameras, photographer, patience):
    photographer.take([tmp_path / "a.png"], PhotoSettings(0, 0, 0, 0.001)).result(patience)
    assert cameras.opened[0].fps == 30.0


def test_a_series_of_a_held_camera_begins_with_what_it_sees_now(tmp_path, cameras, photographer, patience):
    photographer.hold(SETTINGS)
    cameras.advance(1.0)  # the picture with number 30
    paths = [tmp_path / f"{number}.png" for number in range(3)]
    task = photographer.take(paths, PhotoSettings(0, 2, 13, 1.0))
    cameras.advance(0.51)
    task.result(patience)
    assert [shade(path) for path in paths] == [50.0, 10.0, 20.0]
    assert [stream.resolution for stream in cameras.opened] == [0, 0]
    photographer.release()
    assert cameras.open_streams == []


def test_the_end_of_the_simulator_ends_a_series_with_an_error(tmp_path, cameras, photographer, patience):
    task = photographer.take([tmp_path / f"{number}.png" for number in range(9)], SETTINGS)
    photographer.close()
    with pytest.raises(NaoqiError, match="ended before the pictures were taken"):
        task.result(patience)
    assert cameras.open_streams == []
    with pytest.raises(NaoqiError, match="the simulator ends"):
        photographer.take([tmp_path / "a.png"], SETTINGS)


def test_cameras_that_close_end_a_series_with_an_error(tmp_path, cameras, photographer, patience):
    task = photographer.take([tmp_path / f"{number}.png" for number in range(9)], SETTINGS)
    cameras.opened[0].close()
    with pytest.raises(NaoqiError, match="the camera was closed before all pictures were taken"):
        task.result(patience)


def full(path, content):
    path.write_bytes(content[: len(content) // 2])
    raise OSError(28, "No space left on device")


def test_there_is_an_end_to_series_at_the_same_time(tmp_path, cameras, photographer, patience):
    tasks = [photographer.take([tmp_path / f"{i}_{k}.png" for k in range(2)], SETTINGS) for i in range(MOST_SERIES)]
    with pytest.raises(BadValue, match=f"series of pictures is {MOST_SERIES + 1}, allowed is at most {MOST_SERIES}"):
        photographer.take([tmp_path / "more.png"], SETTINGS)
    cameras.advance(0.3)
    for task in tasks:
        assert len(task.result(patience)) == 2
    photographer.take([tmp_path / "more.png"], SETTINGS).result(patience)


def test_two_who_write_the_same_picture_do_not_get_into_each_others_way(tmp_path):
    path, both = tmp_path / "a.png", threading.Barrier(2)
    failures = []

    def write(target, content):
        target.write_bytes(content)
        both.wait(10.0)  # both are written before the first takes its name

    def run(content):
        try:
            save(path, content, write)
        except Exception as error:
            failures.append(error)

    threads = [threading.Thread(target=run, args=(content,)) for content in (b"one", b"other")]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert failures == [] and path.read_bytes() in (b"one", b"other")
    assert list(tmp_path.iterdir()) == [path]


def test_a_full_disk_leaves_no_half_picture_and_what_was_there(tmp_path):
    path = tmp_path / "a.png"
    path.write_bytes(b"old")
    with pytest.raises(NaoqiError, match="a.png' cannot be written: No space left on device"):
        save(path, b"new picture", full)
    assert path.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [path]


def test_a_full_disk_ends_the_series_with_an_error(tmp_path, cameras, patience):
    photographer = Photographer(cameras, "photos", lambda path, content: save(path, content, full))
    with pytest.raises(NaoqiError, match="No space left on device"):
        photographer.take([tmp_path / "a.png"], SETTINGS).result(patience)
    assert list(tmp_path.iterdir()) == []
    assert cameras.open_streams == []


@pytest.mark.parametrize(
    "folder, name, count, expected",
    [
        ("day", "a", 1, ["day/a.jpg"]),
        ("/home/nao/day/", "a.jpg", 1, ["day/a.jpg"]),
        ("", "a.png", 1, ["a.png.jpg"]),
        ("day", "a.JPG", 2, ["day/a_0.jpg", "day/a_1.jpg"]),
    ],
)
def test_names_of_the_files(tmp_path, folder, name, count, expected):
    paths = picture_files(ClientFiles(tmp_path), folder, name, "jpg", count, True)
    assert [str(path.relative_to(tmp_path)) for path in paths] == expected


@pytest.mark.parametrize("name", ["", "folder/", ".jpg"])
def test_a_name_has_to_be_that_of_a_file(tmp_path, name):
    with pytest.raises(BadValue, match="the name of a file"):
        picture_files(ClientFiles(tmp_path), "", name, "jpg", 1, True)
