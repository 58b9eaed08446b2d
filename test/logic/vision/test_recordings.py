"""Recordings: what is in the file, and how they end."""

from __future__ import annotations

import re
import threading

import pytest
from camera_topics import CAMERA, numbered_image, read_video, wait_for
from disks import room

from nao_library_modules.core.errors import BadGoal

LIMIT = 60.0


def test_a_recording_is_a_file_with_what_came_until_it_was_stopped(recording, send, files):
    one, small = recording(), recording("small.mp4", rate=2.0, width=32)
    send(20)
    one.stop()
    small.stop()
    video = one.video
    assert (video.id, video.path, video.frames, video.dropped) == ("r", str(files.folder / "walk.mp4"), 20, 0)
    assert (video.duration, video.frame_rate) == (pytest.approx(2.0), pytest.approx(10.0))
    assert (video.began.to_sec(), video.width, video.height, video.codec) == (pytest.approx(50.1), 64, 48, "h264")
    assert read_video(video.path) == list(range(20))
    assert read_video(small.video.path) == [0, 5, 10, 15]
    assert (small.video.width, small.video.height, small.video.dropped) == (32, 24, 0)


def test_what_was_seen_before_the_stop_is_in_the_file_also_if_it_comes_later(recording, send, topics, clock):
    one = recording()
    send(5)
    clock.time += 0.25  # three frames are on their way
    asked = threading.Event()
    clock.on_now = asked.set
    stop = threading.Thread(target=one.stop, daemon=True)
    stop.start()
    assert asked.wait(LIMIT)
    clock.on_now = lambda: None
    for number, stamp in ((5, 50.6), (6, 50.7), (7, 50.8)):
        clock.time += 0.1
        topics.send(CAMERA, numbered_image(number, stamp))
    stop.join(LIMIT)
    assert read_video(one.video.path) == [0, 1, 2, 3, 4, 5, 6]
    assert one.report().duration == pytest.approx(0.75)


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
    with pytest.raises(BadGoal, match="a recording is writing .*walk.mp4"):
        files.require_free(files.folder / "walk.mp4", True)
    one.stop()
    assert list(files.folder.iterdir()) == []
    assert (one.video.path, one.video.frames) == ("", 0)
    assert one.video.error == f"no frame came from {CAMERA}: there is no file"


def test_a_full_disk_ends_a_recording_and_nothing_else_and_with_room_there_are_others(recording, stream, send, files):
    (files.folder / "walk.mp4").write_bytes(b"old")
    other, one = stream(), recording(overwrite=True)
    with room(3000):
        for count in range(10, 80, 10):
            send(10)
            wait_for(lambda: other.report().frames == count and one.report().frames in (count, 61))  # noqa: B023
        wait_for(lambda: one.report().state == "failed")
    other.stop()
    one.stop()
    assert (other.report().frames, one.video.frames) == (70, 30)
    assert re.search(r"walk.part1.mp4 cannot be written: File too large, \d+\.\d MB free in", one.video.error)
    assert one.video.path == str(files.folder / "walk.part1.mp4")
    assert read_video(one.video.path) == list(range(30))
    assert (files.folder / "walk.mp4").read_bytes() == b"old"
    again = recording(overwrite=True)
    send(3)
    again.stop()
    assert (again.video.error, read_video(files.folder / "walk.mp4")) == ("", [70, 71, 72])
