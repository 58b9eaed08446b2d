"""Streams and recordings alike: what is dropped, how they end, what they tell of themselves; the table of them."""

from __future__ import annotations

import threading

import pytest
from camera_topics import CAMERA, OUT, image, numbered_image, numbers_of, read_video, wait_for

from nao_library_modules import vision_queue, vision_recorder, vision_threads
from nao_library_modules.errors import BadGoal
from nao_library_modules.vision_recorder import Recording, VideoWish
from nao_library_modules.vision_stream import Stream
from nao_library_modules.vision_thread import FrameThread
from nao_library_modules.vision_threads import MOST_THREADS, VisionThreads

FRAME = 64 * 48 * 3


@pytest.mark.parametrize("limit, value, left", [("MOST_FRAMES", 4, 4), ("MOST_BYTES", 3 * FRAME + 100, 3)])
def test_a_slow_thread_drops_the_oldest_frames_and_counts_them(stream, topics, send, monkeypatch, limit, value, left):
    monkeypatch.setattr(vision_queue, limit, value)
    one = stream()
    reached, go_on = threading.Event(), threading.Event()
    topics.publishers[OUT].before = lambda: (reached.set(), go_on.wait(15.0))
    send(1)
    assert reached.wait(15.0)
    send(10)
    assert one.report().dropped == 10 - left
    go_on.set()
    one.stop()
    assert numbers_of(topics.publishers[OUT].messages) == [0, *range(11 - left, 11)]
    assert (one.report().frames, one.report().dropped) == (1 + left, 10 - left)


def test_a_thread_tells_how_it_is(started, topics, send, clock):
    one = Stream("s", CAMERA, 0.0, topics, clock, OUT, 0, 0)
    assert (one.report().state, one.report().duration) == ("ready", 0.0)
    started(one)
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


def test_frames_that_cannot_be_read_are_told_once_and_the_next_one_may_be(stream, topics, send, clock, caplog):
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
    assert (numbers_of(first), numbers_of(topics.publishers[OUT].messages)) == ([0, 1], [2, 3, 4])
    assert one.report().frames == 3


def test_a_kind_of_thread_that_passes_no_frame_on_cannot_be_made(topics, clock):
    class Deaf(FrameThread):
        kind = "deaf"

    with pytest.raises(TypeError, match="abstract"):
        Deaf("d", CAMERA, 0.0, topics, clock)


# The table


@pytest.fixture
def recordings(topics, clock, files):
    def make(count):
        wishes = [VideoWish(files.folder / f"{number}.mp4", "mp4", "h264") for number in range(count)]
        return [Recording(f"r{n}", CAMERA, 0.0, topics, clock, files, wish) for n, wish in enumerate(wishes)]

    return make


def test_ten_streams_and_ten_recordings_at_once(topics, clock, files, send, recordings):
    threads = VisionThreads()
    made = recordings(10)
    made += [Stream(f"s{n}", CAMERA, 0.0, topics, clock, f"/out{n}/image_raw", 32, 0) for n in range(10)]
    for one in made:
        threads.add(one)
        one.start()
    for count in range(2, 11, 2):
        send(2)
        wait_for(lambda c=count: all(one.report().frames == c for one in made))
    threads.close()
    assert [one.report().dropped for one in made] == [0] * 20
    ten = list(range(10))
    assert [read_video(files.folder / f"{number}.mp4") for number in ten] == [ten] * 10
    assert [numbers_of(topics.publishers[f"/out{n}/image_raw"].messages) for n in ten] == [ten] * 10
    assert topics.count(CAMERA) == 0


def test_at_the_end_of_the_server_what_has_no_time_is_dropped_and_files_are_complete(
    files, send, monkeypatch, recordings
):
    monkeypatch.setattr(vision_threads, "CLOSING", 0.1)
    may_go_on, writing = threading.Event(), threading.Semaphore(0)
    write = vision_recorder.VideoFile.write

    def slow(self, picture, stamp):
        if self.frames:
            writing.release()
            may_go_on.wait(30.0)
        return write(self, picture, stamp)

    monkeypatch.setattr(vision_recorder.VideoFile, "write", slow)
    threads, made = VisionThreads(), recordings(3)
    for one in made:
        threads.add(one)
        one.start()
    send(8)
    for _ in made:  # one is written, one is being written
        assert writing.acquire(timeout=15.0)
    closing = threading.Thread(target=threads.close, daemon=True)
    closing.start()
    wait_for(lambda: all(one.report().dropped == 6 for one in made))
    may_go_on.set()
    closing.join(30.0)
    assert not closing.is_alive()
    for number, one in enumerate(made):
        assert (one.report().state, one.video.frames, one.video.dropped) == ("stopped", 2, 6)
        assert read_video(files.folder / f"{number}.mp4") == [0, 1]


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
