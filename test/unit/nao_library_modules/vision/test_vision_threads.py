"""Streams and recordings alike: what is dropped, how they end, what they tell of themselves; the table of them."""

from __future__ import annotations

import threading

import pytest
from fake_vision import image, numbered_image, wait_for
from vision_thread_tools import CAMERA, OUT, numbers, read

from nao_library_modules import vision_queue, vision_recorder, vision_threads
from nao_library_modules.errors import BadGoal
from nao_library_modules.vision_recorder import Recording, VideoWish
from nao_library_modules.vision_stream import Stream
from nao_library_modules.vision_thread import FrameThread
from nao_library_modules.vision_threads import MOST_THREADS, VisionThreads


class Slow:
    """Holds a thread up at its first frame until the test lets it go on."""

    def __init__(self, thread, monkeypatch):
        self.reached, self.go_on = threading.Event(), threading.Event()
        handle = thread._handle

        def slowly(frame):
            self.reached.set()
            assert self.go_on.wait(10.0)
            return handle(frame)

        monkeypatch.setattr(thread, "_handle", slowly)


# What all threads do


def test_a_slow_thread_drops_the_oldest_frames_and_counts_them(stream, topics, send, monkeypatch):
    monkeypatch.setattr(vision_queue, "MOST_FRAMES", 4)
    one = stream()
    slow = Slow(one, monkeypatch)
    send(1)
    assert slow.reached.wait(10.0)
    send(10)
    assert one.report().dropped == 6
    slow.go_on.set()
    one.stop()
    assert numbers(topics.publishers[OUT].messages) == [0, 7, 8, 9, 10]
    assert (one.report().frames, one.report().dropped) == (5, 6)


def test_large_frames_that_wait_are_bounded_in_bytes(stream, topics, send, monkeypatch):
    frame = 64 * 48 * 3
    monkeypatch.setattr(vision_queue, "MOST_BYTES", 3 * frame + 100)
    one = stream()
    slow = Slow(one, monkeypatch)
    send(1)
    assert slow.reached.wait(10.0)
    send(10)
    slow.go_on.set()
    one.stop()
    assert numbers(topics.publishers[OUT].messages) == [0, 8, 9, 10]


def test_a_thread_tells_how_it_is(stream, topics, send, clock):
    one = Stream("s", CAMERA, 0.0, topics, clock, OUT, 0, 0)
    assert (one.report().state, one.report().duration) == ("ready", 0.0)
    one.start()
    clock.time += 3.0
    assert (one.report().state, one.report().duration) == ("waiting", 3.0)
    send(20)
    wait_for(lambda: one.report().frames == 20)
    assert one.report().state == "running"
    assert one.report().frame_rate == pytest.approx(10.0)
    clock.time += 2.5
    assert (one.report().state, one.report().frame_rate) == ("stalled", 0.0)
    send(1)
    assert one.report().state == "running"
    one.stop()
    clock.time += 100.0
    assert (one.report().state, one.report().duration) == ("stopped", pytest.approx(3.0 + 2.0 + 2.5 + 0.1))
    assert topics.count(CAMERA) == 0


def test_a_camera_with_few_frames_has_not_stalled(stream, topics, clock):
    one = stream()
    for number in range(3):
        clock.time += 4.0
        topics.send(CAMERA, numbered_image(number, clock.time))
        wait_for(lambda n=number: one.report().frames == n + 1)
    clock.time += 8.0
    assert one.report().state == "running"
    clock.time += 13.0
    assert one.report().state == "stalled"


def test_frames_that_cannot_be_read_are_told_and_the_next_one_may_be(stream, topics, send, clock, caplog):
    one = stream(width=32)
    for _ in range(3):
        topics.send(CAMERA, image(clock.time, encoding="32FC1"))
    wait_for(lambda: one.report().dropped == 3)
    report = one.report()
    assert report.state == "running" and "encoding '32FC1' cannot be read: known are bgr8" in report.error
    assert len([r for r in caplog.records if "32FC1" in r.getMessage()]) == 1
    send(1)
    wait_for(lambda: one.report().frames == 1)
    assert one.report().error == ""


def test_a_thread_can_be_started_again_but_not_twice(stream, topics, send):
    one = stream()
    with pytest.raises(BadGoal, match="'s' runs already"):
        one.start()
    send(2)
    one.stop()
    one.stop()
    first = topics.publishers[OUT].messages
    one.start()
    send(3)
    one.stop()
    assert (numbers(first), numbers(topics.publishers[OUT].messages)) == ([0, 1], [2, 3, 4])
    assert one.report().frames == 3


def test_stamps_that_are_missing_are_the_time_of_arrival(recording, topics, clock):
    one = recording()
    for number in range(3):
        clock.time += 0.25
        topics.send(CAMERA, numbered_image(number, 0.0))
    one.stop()
    assert one.video.duration == pytest.approx(0.75)


def test_a_kind_of_thread_that_passes_no_frame_on_cannot_be_made(topics, clock):
    class Deaf(FrameThread):
        kind = "deaf"

    with pytest.raises(TypeError, match="abstract.*_begin.*_end.*_fill.*_handle"):
        Deaf("d", CAMERA, 0.0, topics, clock)


# The table


def test_ten_streams_and_ten_recordings_at_once(topics, clock, files, send):
    threads = VisionThreads()
    for number in range(10):
        wish = VideoWish(files.folder / f"{number}.mp4", "mp4", "h264")
        threads.add(Stream(f"s{number}", CAMERA, 0.0, topics, clock, f"/out{number}/image_raw", 32, 0))
        threads.add(Recording(f"r{number}", CAMERA, 0.0, topics, clock, files, wish))
    for thread in threads.known.values():
        thread.start()
    for _ in range(5):
        send(10)
        wait_for(lambda: all(not thread._queue for thread in threads.known.values()))
    threads.close()
    assert [thread.report().dropped for thread in threads.known.values()] == [0] * 20
    assert [read(files.folder / f"{number}.mp4") for number in range(10)] == [list(range(50))] * 10
    assert [numbers(topics.publishers[f"/out{number}/image_raw"].messages) for number in range(10)] == [
        list(range(50))
    ] * 10
    assert topics.count(CAMERA) == 0


def test_at_the_end_of_the_server_what_has_no_time_is_dropped_and_files_are_complete(
    topics, clock, files, send, monkeypatch
):
    monkeypatch.setattr(vision_threads, "CLOSING", 0.1)
    may_go_on = threading.Event()
    write = vision_recorder.VideoFile.write

    def slow(self, picture, stamp):
        if self.frames:
            may_go_on.wait(30.0)
        return write(self, picture, stamp)

    monkeypatch.setattr(vision_recorder.VideoFile, "write", slow)
    threads = VisionThreads()
    recordings = [
        Recording(
            f"r{number}", CAMERA, 0.0, topics, clock, files, VideoWish(files.folder / f"{number}.mp4", "mp4", "h264")
        )
        for number in range(3)
    ]
    for one in recordings:
        threads.add(one)
        one.start()
    send(8)
    wait_for(lambda: all(len(one._queue) == 6 for one in recordings))  # one is written, one is being written
    closing = threading.Thread(target=threads.close)
    closing.start()
    wait_for(lambda: all(one.report().dropped == 6 for one in recordings))
    may_go_on.set()
    closing.join(30.0)
    assert not closing.is_alive()
    for number, one in enumerate(recordings):
        assert (one.report().state, one.video.frames, one.video.dropped) == ("stopped", 2, 6)
        assert read(files.folder / f"{number}.mp4") == [0, 1]


def test_the_table_knows_its_threads(topics, clock):
    threads = VisionThreads()

    def made(ident):
        return Stream(ident, CAMERA, 0.0, topics, clock, f"/{ident}", 0, 0)

    with pytest.raises(BadGoal, match="no stream or recording 'b': there are none"):
        threads.get("b")
    for ident in ("bottom", "alpha"):
        threads.add(made(ident))
    assert list(threads.known) == ["alpha", "bottom"]
    with pytest.raises(BadGoal, match="'botom': did you mean 'bottom'"):
        threads.get("botom")
    threads.get("alpha").start()
    with pytest.raises(BadGoal, match="'alpha' runs already"):
        threads.add(made("alpha"))
    threads.get("alpha").stop()
    again = made("alpha")
    threads.add(again)
    assert threads.get("alpha") is again
    for number in range(MOST_THREADS - 2):
        threads.add(made(f"t{number}"))
    with pytest.raises(BadGoal, match="too many"):
        threads.add(made("one more"))
    threads.remove("t0")
    threads.close()
    with pytest.raises(BadGoal, match="the server ends"):
        threads.add(made("late"))
