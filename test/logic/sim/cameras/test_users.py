"""Who uses the cameras: subscribers that come and go, series of photos, films, disks that are full."""

from __future__ import annotations

import resource
from contextlib import contextmanager

import av
import cv2
import numpy as np
import pytest

from nao_sim_bridge.record_dir import ClientFiles
from nao_sim_bridge.services.errors import NaoqiError
from nao_sim_bridge.services.vision.photo_capture_files import picture_files, save
from nao_sim_bridge.services.vision.photo_capture_series import Photographer, PhotoSettings
from nao_sim_bridge.services.vision.video_device_subscribers import IDLE, MOST, VideoSubscribers, View
from nao_sim_bridge.services.vision.video_recorder_file import Film
from nao_sim_bridge.services.vision.video_recorder_recording import FilmSettings, VideoRecorder
from nao_sim_bridge.sim.errors import BadValue

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


def test_there_is_an_end_to_subscribers(subscribers):
    for index in range(MOST):
        subscribers.one(f"looker{index}")
    with pytest.raises(BadValue, match=f"subscribers is {MOST + 1}, allowed is at most {MOST}"):
        subscribers.one("one more")


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


def test_who_waits_for_a_frame_is_alive(subscribers):
    handle = subscribers.one()
    task = subscribers.ask(handle, "getImageRemote", list)
    subscribers.now += 10 * IDLE
    assert subscribers.handles() == [handle]
    task.request_kill()
    assert task.killed
    subscribers.now += IDLE + 1.0
    assert subscribers.handles() == []


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
    assert task.result(head.patience) == [str(path) for path in paths]
    assert shades(paths) == pytest.approx([2, 62, 122], abs=1)
    assert stream.closed
    photographer.take([tmp_path / "a.png"], PhotoSettings(0, 0, 0, 0.001))
    assert head.cameras.streams[0].fps == 30.0


def full(path, content):
    path.write_bytes(content[: len(content) // 2])
    raise OSError(28, "No space left on device")


def test_a_full_disk_ends_the_series_and_leaves_no_half_picture_but_what_was_there(tmp_path, head):
    path = tmp_path / "a.png"
    path.write_bytes(b"old")
    photographer = Photographer(head.cameras, "photos", lambda path, content: save(path, content, full))
    task = photographer.take([path], GREY)
    head.advance(1 / 120)
    with pytest.raises(NaoqiError, match="a.png' cannot be written: No space left on device"):
        task.result(head.patience)
    assert path.read_bytes() == b"old" and list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize(
    "folder, name, count, expected",
    [("day", "a", 1, ["day/a.jpg"]), ("/home/nao/day/", "a.jpg", 1, ["day/a.jpg"]), ("", "a.png", 1, ["a.png.jpg"])]
    + [("day", "a.JPG", 2, ["day/a_0.jpg", "day/a_1.jpg"]), *(("", name, 1, None) for name in ("", "folder/", ".jpg"))],
)
def test_names_of_the_files(tmp_path, folder, name, count, expected):
    if expected is None:
        with pytest.raises(BadValue, match="the name of a file"):
            picture_files(ClientFiles(tmp_path), folder, name, "jpg", count, True)
    else:
        paths = picture_files(ClientFiles(tmp_path), folder, name, "jpg", count, True)
        assert [str(path.relative_to(tmp_path)) for path in paths] == expected


FILM = FilmSettings(camera=0, resolution=0, color_space=13, rate=10.0, kind="MJPG")


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
def recorder(head):
    recorder = VideoRecorder(head.cameras, head, head.cameras.tables, "films")
    yield recorder
    recorder.close()


def film_shades(path):
    """Grey of each frame."""
    with av.open(str(path)) as film:
        return [frame.to_ndarray(format="gray").mean() for frame in film.decode(video=0)]


def test_every_frame_is_in_the_film_in_order_and_a_lost_one_is_the_one_before_it(tmp_path, head, recorder):
    path = tmp_path / "a.avi"
    recorder.start(path, FILM)
    head.advance(0.25)
    head.pictures.free.clear()
    head.run(36)  # of the frames of these ticks the first is being drawn, the second is lost, the third waits
    head.pictures.free.set()
    head.settle()
    head.advance(0.2)
    assert recorder.stop().result(head.patience) == [8, str(path)]
    assert film_shades(path) == pytest.approx([2, 26, 50, 74, 74, 122, 146, 170], abs=3)


def noisy(time, shape):
    return np.random.default_rng(round(120 * time)).integers(0, 255, shape, dtype=np.uint8)


def test_a_full_disk_ends_the_film_and_says_what_is_in_it(tmp_path, recorder, head):
    head.pictures.paint = noisy
    path = tmp_path / "a.avi"
    with full_disk(200000):
        recorder.start(path, FILM)
        head.advance(2.0)
        text = r"a.avi' is not complete, it ends after (\d+) frames: .*File too large"
        with pytest.raises(NaoqiError, match=text) as failure:
            recorder.stop().result(head.patience)
    frames = int(str(failure.value).split(" frames")[0].rpartition(" ")[2])
    assert 3 < frames < 20
    assert len(film_shades(path)) == frames and path.stat().st_size <= 200000
    recorder.start(tmp_path / "b.avi", FILM)
    head.advance(1 / 120)
    assert recorder.stop().result(head.patience)[0] == 1


@pytest.mark.parametrize("kind", ["MJPG", "IYUV"])
def test_colours_come_through(tmp_path, kind):
    path = tmp_path / "a.avi"
    film = Film(path, kind, 64, 48, 10.0)
    film.write(np.full((48, 64, 3), (20, 40, 200), np.uint8))
    film.close()
    with av.open(str(path)) as read:
        (frame,) = read.decode(video=0)
        assert frame.to_ndarray(format="bgr24").mean(axis=(0, 1)) == pytest.approx((20, 40, 200), abs=6)
