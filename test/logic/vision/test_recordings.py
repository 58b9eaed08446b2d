"""Recordings: what is in the file, and how they end."""

from __future__ import annotations

import errno
import threading
from pathlib import Path

import pytest
from camera_topics import CAMERA, numbered_image, read_video, wait_for

from nao_library_modules import vision_recorder, vision_thread
from nao_library_modules.errors import BadGoal

LIMIT = 15.0


def in_thread(function):
    thread = threading.Thread(target=function, daemon=True)
    thread.start()
    return thread


@pytest.fixture
def full_disk(monkeypatch):
    """From now on nothing can be written, for the length of a block."""

    def write(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    def full():
        context = monkeypatch.context()
        patch = context.__enter__()
        patch.setattr(vision_recorder.VideoFile, "write", write)
        return lambda: context.__exit__(None, None, None)

    return full


def test_a_recording_is_a_file_with_what_came_until_it_was_stopped(recording, send, files):
    one = recording()
    send(20)
    one.stop()
    video = one.video
    assert (video.id, video.path, video.frames, video.dropped) == ("r", str(files.folder / "walk.mp4"), 20, 0)
    assert (video.duration, video.frame_rate) == (pytest.approx(2.0), pytest.approx(10.0))
    assert (video.began.to_sec(), video.width, video.height, video.codec) == (pytest.approx(50.1), 64, 48, "h264")
    assert read_video(video.path) == list(range(20))


def test_a_recording_has_another_size_and_rate(recording, send):
    one = recording(rate=2.0, width=32)
    send(20)
    one.stop()
    assert read_video(one.video.path) == [0, 5, 10, 15]
    assert (one.video.width, one.video.height, one.video.dropped) == (32, 24, 0)


def test_what_was_seen_before_the_stop_is_in_the_file_also_if_it_comes_later(recording, send, topics, clock):
    one = recording()
    send(5)
    clock.time += 0.25  # three frames are on their way
    asked = threading.Event()
    clock.on_now = asked.set
    stop = in_thread(one.stop)
    assert asked.wait(LIMIT)
    clock.on_now = lambda: None
    for number, stamp in ((5, 50.6), (6, 50.7), (7, 50.8)):
        clock.time += 0.1
        topics.send(CAMERA, numbered_image(number, stamp))
    stop.join(LIMIT)
    assert read_video(one.video.path) == [0, 1, 2, 3, 4, 5, 6]
    assert one.report().duration == pytest.approx(0.75)


@pytest.mark.parametrize("lateness", [-3.0, 100.0])
def test_a_camera_with_another_clock_holds_no_stop_up(recording, topics, clock, monkeypatch, lateness):
    monkeypatch.setattr(vision_thread, "LAST_FRAME_LIMIT", 60.0)
    clock.time = 500.0
    one = recording()
    topics.send(CAMERA, numbered_image(0, clock.time - lateness))
    stop = in_thread(one.stop)
    stop.join(LIMIT)
    assert not stop.is_alive() and one.video.frames == 1


def test_each_start_makes_a_file(recording, send, files):
    one = recording(overwrite=True)
    send(2)
    one.stop()
    one.start()
    send(3)
    one.stop()
    assert one.video.path == str(files.folder / "walk-2.mp4")
    assert [read_video(files.folder / name) for name in ("walk.mp4", "walk-2.mp4")] == [[0, 1], [2, 3, 4]]


def test_without_a_frame_there_is_no_file(recording, files):
    one = recording()
    assert (files.folder / "walk.mp4").exists()  # nobody else takes the name meanwhile
    one.stop()
    assert list(files.folder.iterdir()) == []
    assert (one.video.path, one.video.frames) == ("", 0)
    assert one.video.error == f"no frame came from {CAMERA}: there is no file"


def test_a_recording_without_a_name_is_named_by_the_time(recording, send):
    one = recording(name="")
    send(1)
    one.stop()
    assert one.video.path.rpartition("/")[2].startswith("r_20") and one.video.path.endswith(".mp4")


def test_a_full_disk_ends_a_recording_and_nothing_else(recording, stream, send, topics, full_disk, caplog):
    other, one = stream(), recording()
    send(5)
    wait_for(lambda: one.report().frames == 5)
    room = full_disk()
    send(1)
    wait_for(lambda: one.report().state == "failed")
    room()
    assert one.report().error.endswith("walk.mp4 cannot be written: the disk is full")
    assert "recording 'r' ended:" in caplog.text
    wait_for(lambda: topics.count(CAMERA) == 1)
    send(3)
    other.stop()
    assert other.report().frames == 9
    one.stop()
    assert one.report().state == "failed"
    assert (one.video.frames, one.video.error) == (5, one.report().error)
    assert read_video(one.video.path) == list(range(5))


def test_a_disk_that_is_full_from_the_start_leaves_no_file_and_a_new_start_makes_one(recording, send, full_disk):
    one = recording()
    path = Path(one.report().path)
    assert path.exists()
    room = full_disk()
    send(1)
    wait_for(lambda: one.report().state == "failed")
    one.stop()
    room()
    assert (one.video.path, one.video.frames) == ("", 0) and not path.exists()
    assert one.video.error.endswith("walk.mp4 cannot be written: the disk is full")
    one.start()
    send(2)
    one.stop()
    assert (one.report().state, one.report().error, read_video(one.video.path)) == ("stopped", "", [1, 2])


def test_what_failed_at_its_first_frame_leaves_no_subscription(recording, topics, full_disk):
    one = recording()
    one.stop()
    room = full_disk()

    def at_once(topic):  # before the subscription is known to the thread
        topics.send(topic, numbered_image(1, 60.0))
        wait_for(lambda: one.report().state == "failed")

    topics.on_subscribe = at_once
    one.start()
    topics.on_subscribe = lambda topic: None
    room()
    one.start()
    assert topics.count(CAMERA) == 1
    one.stop()
    assert topics.count(CAMERA) == 0


def test_a_stop_may_come_from_several_sides(recording, send):
    one = recording()
    send(3)
    for stop in [in_thread(one.stop) for _ in range(4)]:
        stop.join(LIMIT)
        assert not stop.is_alive()
    assert one.video.frames == 3


def test_stamps_that_are_missing_are_the_time_of_arrival(recording, topics, clock):
    one = recording()
    for number in range(3):
        clock.time += 0.25
        topics.send(CAMERA, numbered_image(number, 0.0))
    one.stop()
    assert one.video.duration == pytest.approx(0.75)


def test_a_file_that_is_there_is_not_replaced(recording, files):
    (files.folder / "walk.mp4").write_text("precious")
    with pytest.raises(BadGoal, match="is there already"):
        recording()
    assert (files.folder / "walk.mp4").read_text() == "precious"
