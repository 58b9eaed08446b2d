"""Who uses the cameras: subscribers that come and go, series of photos, films, disks that are full."""

from __future__ import annotations

import resource
import threading
from contextlib import contextmanager

import av
import cv2
import numpy as np
import pytest

from nao_sim_bridge.record_dir import ClientFiles
from nao_sim_bridge.services.errors import NaoqiError
from nao_sim_bridge.services.vision.photo_capture_files import picture_files, save
from nao_sim_bridge.services.vision.photo_capture_series import MOST_SERIES, Photographer, PhotoSettings
from nao_sim_bridge.services.vision.video_device_subscribers import IDLE, MOST, SOON_IDLE, VideoSubscribers, View
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


def test_a_client_that_crashes_again_and_again_does_not_run_out_of_handles(subscribers):
    for _ in range(20):
        subscribers.one()
        subscribers.now += SOON_IDLE
    assert len(subscribers.handles()) == 6


def test_a_handle_given_to_somebody_else_is_theirs(subscribers):
    first = subscribers.one()
    subscribers.now += IDLE + 1.0
    handles = [subscribers.one() for _ in range(6)]
    assert handles[-1] == first and handles[0] != first
    subscribers.remove(first)
    with pytest.raises(NaoqiError, match="'looker_0' is not subscribed; subscribed is 'looker_1'"):
        subscribers.get(first)


def test_who_waits_for_a_frame_is_alive(subscribers):
    handle = subscribers.one()
    task = subscribers.ask(handle, "getImageRemote", list)
    subscribers.now += 10 * IDLE
    assert subscribers.handles() == [handle]
    task.request_kill()
    assert task.killed
    subscribers.now += IDLE + 1.0
    assert subscribers.handles() == []


def test_calls_that_are_too_many_are_refused_and_leave_nothing_behind(subscribers, head):
    handle = subscribers.one("flood", TOP, BOTTOM)
    head.cameras.streams[1].ask(lambda _: None)  # so that it is the second camera that refuses
    waiting = [subscribers.ask(handle, "getImagesRemote", list) for _ in range(31)]
    for _ in range(50):
        with pytest.raises(BadValue, match="calls that wait for a frame is 33, allowed is at most 32"):
            subscribers.ask(handle, "getImagesRemote", list).result(0)
    assert not any(task.finished for task in waiting)
    for task in waiting:
        task.request_kill()
    subscribers.now += IDLE + 1.0
    assert subscribers.handles() == []


def test_all_of_a_name_are_removed_also_those_that_are_not_heard_of(subscribers):
    for _ in range(3):
        subscribers.one()
    other = subscribers.one("looker_2")
    subscribers.now += IDLE + 1.0
    subscribers.get("looker_1")
    assert subscribers.remove_all("looker") == 1
    assert subscribers.handles() == [] and subscribers.get(other).name == "looker_2"
    with pytest.raises(NaoqiError, match="'looker_0' is not subscribed"):
        subscribers.get("looker_0")


@pytest.mark.parametrize(
    "views, fps, text",
    [
        ([], 15, "cameraIndexes is"),
        ([TOP, View(0, 2, 11)], 15, r"cameraIndexes is \[0, 0\], allowed is different cameras"),
        ([TOP, View(1, 4, 11)], 15, "resolution is 4"),
        ([TOP, View(1, 1, 17)], 15, "needs a depth camera"),
        ([TOP], 31, "fps is 31, allowed is 1 to 30"),
    ],
)
def test_what_the_cameras_cannot_do_leaves_nobody_behind(subscribers, head, views, fps, text):
    with pytest.raises(BadValue, match=text):
        subscribers.add("looker", views, fps, len(views) > 1)
    assert subscribers.handles() == [] and head.cameras.streams == ()


def test_a_change_that_cannot_be_changes_nothing(subscribers, head):
    handle = subscribers.one("looker", TOP, BOTTOM)
    with pytest.raises(BadValue, match="colorSpace is 99"):
        subscribers.change(handle, [View(0, 2, 13), View(1, 2, 99)])
    assert subscribers.get(handle).views == (TOP, BOTTOM)
    assert [stream.resolution for stream in head.cameras.streams] == [1, 0]
    subscribers.change(handle, [View(1, 2, 13), View(0, 4, 0)], 30)
    streams = head.cameras.streams
    assert [(s.camera, s.resolution, s.color_space, s.fps) for s in streams] == [(1, 2, 13, 30), (0, 4, 0, 30)]


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


@pytest.mark.parametrize("end", ["simulator", "cameras"])
def test_the_end_of_simulator_or_camera_ends_a_series_with_an_error(tmp_path, head, photographer, end):
    task = photographer.take([tmp_path / f"{number}.png" for number in range(9)], GREY)
    if end == "simulator":
        photographer.close()
        text = "ended before the pictures were taken"
        with pytest.raises(NaoqiError, match="the simulator ends"):
            photographer.take([tmp_path / "a.png"], GREY)
    else:
        head.cameras.streams[0].close()
        text = "the camera was closed before all pictures were taken"
    with pytest.raises(NaoqiError, match=text):
        task.result(head.patience)
    assert head.cameras.streams == ()


def test_there_is_an_end_to_series_at_the_same_time(tmp_path, head, photographer):
    tasks = [photographer.take([tmp_path / f"{i}_{k}.png" for k in range(2)], GREY) for i in range(MOST_SERIES)]
    with pytest.raises(BadValue, match=f"series of pictures is {MOST_SERIES + 1}, allowed is at most {MOST_SERIES}"):
        photographer.take([tmp_path / "more.png"], GREY)
    head.advance(0.3)
    for task in tasks:
        assert len(task.result(head.patience)) == 2
    task = photographer.take([tmp_path / "more.png"], GREY)
    head.advance(0.3)
    assert task.result(head.patience)


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


def test_two_who_write_the_same_picture_do_not_get_into_each_others_way(tmp_path):
    path, both, failures = tmp_path / "a.png", threading.Barrier(2), []

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


def test_a_disk_without_room_for_a_frame_is_left_as_it_was(tmp_path, recorder, head):
    head.pictures.paint = noisy
    with full_disk(3000):
        recorder.start(tmp_path / "a.avi", FILM)
        head.advance(1 / 120)
        with pytest.raises(NaoqiError, match="a.avi' has not become a file: .*File too large"):
            recorder.stop().result(head.patience)
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(NaoqiError, match="cannot be written: No such file or directory"):
        recorder.start(tmp_path / "none" / "a.avi", FILM)
    assert not recorder.records


@pytest.mark.parametrize("kind", ["MJPG", "IYUV"])
def test_colours_come_through(tmp_path, kind):
    path = tmp_path / "a.avi"
    film = Film(path, kind, 64, 48, 10.0)
    film.write(np.full((48, 64, 3), (20, 40, 200), np.uint8))
    film.close()
    with av.open(str(path)) as read:
        (frame,) = read.decode(video=0)
        assert frame.to_ndarray(format="bgr24").mean(axis=(0, 1)) == pytest.approx((20, 40, 200), abs=6)
