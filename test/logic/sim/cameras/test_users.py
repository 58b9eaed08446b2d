"""Who uses the cameras: subscribers that come and go, series of photos, disks that are full."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from disks import files, room

from nao_sim_bridge.base.whole_file import FileTrouble
from nao_sim_bridge.naoqi.cameras.photographer import Photographer, PhotoSettings
from nao_sim_bridge.naoqi.cameras.video_device_subscribers import IDLE, VideoSubscribers, View

TOP, BOTTOM = View(0, 1, 11), View(1, 0, 13)


@pytest.fixture
def head(head):
    """Cameras whose pictures are the brighter the later: 240 at one second."""
    head.pictures.paint = lambda time, shape: np.full(shape, round(240 * time) % 250, np.uint8)
    head.manual()
    return head


class Subscribers(VideoSubscribers):
    """Subscribers and the clock of their wall."""

    def __init__(self, cameras):
        self.now = 100.0
        super().__init__(cameras, lambda: self.now)

    def one(self, name="looker", *views):
        return self.add(name, views or [TOP], 15, len(views) > 1)


@pytest.fixture
def subscribers(head):
    return Subscribers(head.cameras)


def test_who_is_not_heard_of_is_taken_from_the_cameras_and_finds_everything_as_it_was(subscribers, head):
    gone, alive = subscribers.one("gone", TOP, BOTTOM), subscribers.one("alive")
    subscribers.now += IDLE - 1.0
    subscribers.get(alive)
    subscribers.now += 2.0
    assert subscribers.handles() == [alive]
    assert [stream.name for stream in head.cameras.streams] == [alive]
    back = subscribers.get(gone)
    assert back.views == (TOP, BOTTOM) and back.fps == 15
    assert [stream.camera for stream in head.cameras.streams] == [0, 0, 1]


GREY = PhotoSettings(camera=1, resolution=0, color_space=0, interval=0.25)


@pytest.fixture
def photographer(head):
    photographer = Photographer(head.cameras, "photos")
    yield photographer
    photographer.close()


def shades(paths):
    return [cv2.imread(str(path), cv2.IMREAD_UNCHANGED).mean() for path in paths]


def test_each_picture_is_of_its_moment_and_no_series_is_faster_than_the_camera(tmp_path, head, photographer):
    paths = [tmp_path / f"{number}.png" for number in range(3)]
    task = photographer.take(paths, GREY)
    (stream,) = head.cameras.streams
    assert (stream.camera, stream.resolution, stream.fps) == (1, 0, 4.0)
    head.advance(60 / 120)
    assert not task.finished
    head.advance(1 / 120)
    assert task.result(head.patience) == paths
    assert shades(paths) == pytest.approx([2, 62, 122], abs=1)
    assert stream.closed
    photographer.take([tmp_path / "a.png"], PhotoSettings(0, 0, 0, 0.001))
    assert head.cameras.streams[0].fps == 30.0


def test_a_full_disk_ends_the_series_and_leaves_no_half_picture_but_what_was_there(tmp_path, head, photographer):
    path = tmp_path / "a.png"
    path.write_bytes(b"old")
    with room(100):
        task = photographer.take([path], GREY)
        head.advance(1 / 120)
        with pytest.raises(FileTrouble, match=r"a.png cannot be written: File too large, \d+.\d MB free in"):
            task.result(head.patience)
    assert files(tmp_path) == {"a.png": b"old"}
    head.advance(1 / 120)
    task = photographer.take([path], GREY)
    head.advance(1 / 120)
    task.result(head.patience)
    assert cv2.imread(str(path)) is not None
