"""Streams and recordings: what goes through, what is dropped, how they end, and what they tell of themselves."""

from __future__ import annotations

import errno
import threading
from pathlib import Path

import pytest
from fake_vision import compressed, image, number_of, numbered, numbered_image, wait_for
from sensor_msgs.msg import CameraInfo, CompressedImage, Image

from nao_library_modules import vision_queue, vision_recorder, vision_threads
from nao_library_modules.errors import BadGoal
from nao_library_modules.vision_camera_info import info_topic
from nao_library_modules.vision_files import VisionFiles
from nao_library_modules.vision_pictures import encoded, picture_of
from nao_library_modules.vision_recorder import Recording, VideoWish
from nao_library_modules.vision_stream import Stream
from nao_library_modules.vision_threads import MOST_THREADS, VisionThreads

CAMERA, OUT = "/camera/image_raw", "/out/image_raw"


class HandClock:
    """ROS time that the test sets."""

    def __init__(self):
        self.time = 50.0

    def now(self):
        return self.time


@pytest.fixture
def clock():
    return HandClock()


@pytest.fixture
def files(tmp_path):
    return VisionFiles(str(tmp_path))


@pytest.fixture
def stream(topics, clock):
    made = []

    def make(rate=0.0, out=OUT, width=0, height=0):
        made.append(Stream("s", CAMERA, rate, topics, clock, out, width, height))
        made[-1].start()
        return made[-1]

    yield make
    for one in made:
        one.stop(at_once=True)


@pytest.fixture
def recording(topics, clock, files):
    made = []

    def make(name="walk.mp4", rate=0.0, **fields):
        wish = VideoWish(files.folder / name if name else None, "mp4", "h264", **fields)
        made.append(Recording("r", CAMERA, rate, topics, clock, files, wish))
        made[-1].start()
        return made[-1]

    yield make
    for one in made:
        one.stop(at_once=True)


@pytest.fixture
def send(topics, clock):
    """Sends frames at 10 a second, numbered on."""
    numbers = iter(range(256))

    def some(count=1, topic=CAMERA):
        for _ in range(count):
            clock.time += 0.1
            topics.send(topic, numbered_image(next(numbers), clock.time))

    return some


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


def numbers(messages):
    return [number_of(picture_of(message)) for message in messages]


# Streams


def test_frames_pass_a_stream_as_they_are(stream, topics, send):
    one = stream()
    send(3)
    one.stop()
    sent = topics.publishers[OUT].messages
    assert topics.publishers[OUT].kind is Image and topics.publishers[OUT].closed
    assert numbers(sent) == [0, 1, 2]
    assert [message.header.stamp.to_sec() for message in sent] == pytest.approx([50.1, 50.2, 50.3])
    assert sent[0].header.frame_id == "CameraTop_optical_frame"


def test_a_stream_has_another_size_and_rate(stream, topics, send):
    one = stream(rate=5.0, height=24)
    send(10)
    one.stop()
    sent = topics.publishers[OUT].messages
    assert numbers(sent) == [0, 2, 4, 6, 8]
    assert {(m.width, m.height, m.step, len(m.data), m.encoding) for m in sent} == {(32, 24, 96, 96 * 24, "bgr8")}
    report = one.report()
    assert (report.frames, report.dropped, report.width, report.height) == (5, 0, 32, 24)


@pytest.mark.parametrize("encoding, pixel", [("mono8", (70,)), ("mono16", (70, 1))])
def test_grey_stays_grey(stream, topics, clock, encoding, pixel):
    one = stream(width=32)
    topics.send(CAMERA, image(clock.time, pixel, encoding=encoding))
    one.stop()
    (message,) = topics.publishers[OUT].messages
    assert (message.encoding, message.width, bytes(message.data)) == (encoding, 32, bytes(pixel) * 32 * 24)


def test_a_stream_compresses_and_decompresses(stream, topics, clock):
    one = stream(out="/out/image_raw/compressed")
    topics.send(CAMERA, numbered_image(77, clock.time))
    topics.send(CAMERA, compressed(clock.time, encoded(numbered(78), "png"), "png"))
    one.stop()
    publisher = topics.publishers["/out/image_raw/compressed"]
    assert publisher.kind is CompressedImage
    first, second = publisher.messages
    assert first.format == "bgr8; jpeg compressed bgr8" and number_of(picture_of(first)) == 77
    assert second.format == "png" and number_of(picture_of(second)) == 78
    two = stream()
    topics.send(CAMERA, compressed(clock.time, encoded(numbered(78), "png"), "png"))
    two.stop()
    (message,) = topics.publishers[OUT].messages
    assert (message.encoding, number_of(picture_of(message))) == ("bgr8", 78)


def test_a_streams_camera_info_is_in_its_size(stream, topics, clock):
    one = stream(width=32)
    topics.send(CAMERA, image(clock.time))  # nothing is known of the camera yet
    wait_for(lambda: one.report().frames == 1)
    calibration = CameraInfo(width=64, height=48, distortion_model="plumb_bob", D=[0.1] * 5)
    calibration.K = [60.0, 0.0, 32.0, 0.0, 62.0, 24.0, 0.0, 0.0, 1.0]
    calibration.P = [60.0, 0.0, 32.0, 8.0, 0.0, 62.0, 24.0, 0.0, 0.0, 0.0, 1.0, 0.0]
    calibration.roi.width, calibration.roi.x_offset = 20, 10
    topics.send("/camera/camera_info", calibration)
    topics.send(CAMERA, image(clock.time))
    one.stop()
    (info,) = topics.publishers["/out/camera_info"].messages
    assert (info.width, info.height, info.distortion_model, list(info.D)) == (32, 24, "plumb_bob", [0.1] * 5)
    assert info.K == [30.0, 0.0, 16.0, 0.0, 31.0, 12.0, 0.0, 0.0, 1.0]
    assert info.P == [30.0, 0.0, 16.0, 4.0, 0.0, 31.0, 12.0, 0.0, 0.0, 0.0, 1.0, 0.0]
    assert (info.roi.width, info.roi.x_offset) == (10, 5)
    assert info.header == topics.publishers[OUT].messages[1].header
    assert topics.count("/camera/camera_info") == 0 and topics.publishers["/out/camera_info"].closed


@pytest.mark.parametrize(
    "topic, beside",
    [
        ("/a/image_raw", "/a/camera_info"), ("/a/image_raw/compressed", "/a/camera_info"),
        ("/image", "/camera_info"), ("/relay", ""), ("/a/compressed", ""),
    ],
)  # fmt: skip
def test_camera_info_is_beside_the_pictures(topic, beside):
    assert info_topic(topic) == beside


def test_nobody_works_for_nobody(stream, topics, send, monkeypatch):
    one = stream(width=32)
    topics.publishers[OUT].heard = False
    monkeypatch.setattr("nao_library_modules.vision_stream.picture_of", lambda _: pytest.fail("it was worked on"))
    send(3)
    one.stop()
    assert topics.publishers[OUT].messages == []
    assert (one.report().frames, one.report().width, one.report().error) == (3, 32, "")


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


# Recordings


def test_a_recording_is_a_file_with_what_came_until_it_was_stopped(recording, send, files):
    one = recording()
    send(20)
    one.stop()
    video = one.video
    assert (video.id, video.path, video.frames, video.dropped) == ("r", str(files.folder / "walk.mp4"), 20, 0)
    assert (video.duration, video.frame_rate) == (pytest.approx(2.0), pytest.approx(10.0))
    assert (video.began.to_sec(), video.width, video.height, video.codec) == (pytest.approx(50.1), 64, 48, "h264")
    assert read(video.path) == list(range(20))


def test_a_recording_has_another_size_and_rate(recording, send):
    one = recording(rate=2.0, width=32)
    send(20)
    one.stop()
    assert read(one.video.path) == [0, 5, 10, 15]
    assert (one.video.width, one.video.height, one.video.dropped) == (32, 24, 0)


def test_what_was_seen_before_the_stop_is_in_the_file_also_if_it_comes_later(recording, send, topics, clock, in_thread):
    one = recording()
    send(5)
    clock.time += 0.25  # three frames are on their way
    stop, _ = in_thread(one.stop)
    wait_for(lambda: one._until is not None)
    for number, stamp in ((5, 50.6), (6, 50.7), (7, 50.8)):
        clock.time += 0.1
        topics.send(CAMERA, numbered_image(number, stamp))
    stop.join(5.0)
    assert read(one.video.path) == [0, 1, 2, 3, 4, 5, 6]
    assert one.report().duration == pytest.approx(0.75)


@pytest.mark.parametrize("lateness", [-3.0, 30.0])
def test_a_camera_with_another_clock_holds_no_stop_up(recording, topics, clock, monkeypatch, lateness):
    one = recording()
    topics.send(CAMERA, numbered_image(0, clock.time - lateness))
    monkeypatch.setattr(one._changed, "wait_for", lambda *_: pytest.fail("it waits"))
    one.stop()
    assert one.video.frames == 1


def test_each_start_makes_a_file(recording, send, files):
    one = recording(overwrite=True)
    send(2)
    one.stop()
    one.start()
    send(3)
    one.stop()
    assert one.video.path == str(files.folder / "walk-2.mp4")
    assert (read(files.folder / "walk.mp4"), read(files.folder / "walk-2.mp4")) == ([0, 1], [2, 3, 4])


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


def test_a_full_disk_ends_a_recording_and_nothing_else(recording, stream, send, topics, monkeypatch, caplog):
    other, one = stream(), recording()
    send(5)
    wait_for(lambda: one.report().frames == 5)

    def write(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr(vision_recorder.VideoFile, "write", write)
        send(1)
        wait_for(lambda: one.report().state == "failed")
    assert one.report().error.endswith("walk.mp4 cannot be written: the disk is full")
    assert "recording 'r' ended:" in caplog.text
    wait_for(lambda: topics.count(CAMERA) == 1)
    send(3)
    other.stop()
    assert other.report().frames == 9
    one.stop()
    assert one.report().state == "failed"
    assert (one.video.frames, one.video.error) == (5, one.report().error)
    assert read(one.video.path) == list(range(5))


def test_a_disk_that_is_full_from_the_start_leaves_no_file(recording, send, monkeypatch):
    one = recording()
    path = Path(one.report().path)
    assert path.exists()

    def write(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(vision_recorder.VideoFile, "write", write)
    send(1)
    wait_for(lambda: one.report().state == "failed")
    one.stop()
    assert (one.video.path, one.video.frames) == ("", 0) and not path.exists()
    assert one.video.error.endswith("walk.mp4 cannot be written: the disk is full")


def test_a_recording_that_failed_can_be_started_again(recording, send, monkeypatch):
    one = recording()
    with monkeypatch.context() as patch:
        patch.setattr(one, "_handle", lambda _: 1 / 0)
        send(1)
        wait_for(lambda: one.report().state == "failed")
    assert "ZeroDivisionError" in one.report().error
    one.start()
    send(2)
    one.stop()
    assert (one.report().state, one.report().error, read(one.video.path)) == ("stopped", "", [1, 2])


def test_what_failed_at_its_first_frame_leaves_no_subscription(recording, topics, monkeypatch):
    one = recording()
    one.stop()
    monkeypatch.setattr(one, "_handle", lambda _: 1 / 0)

    def at_once(topic):
        topics.send(topic, numbered_image(1, 60.0))
        wait_for(lambda: one.report().state == "failed")

    topics.on_subscribe = at_once  # before the subscription is known to the thread
    one.start()
    topics.on_subscribe = lambda topic: None
    monkeypatch.undo()
    one.start()
    assert topics.count(CAMERA) == 1
    one.stop()
    assert topics.count(CAMERA) == 0


def test_a_stop_may_come_from_two_sides(recording, send, in_thread):
    one = recording()
    send(3)
    stops = [in_thread(one.stop) for _ in range(4)]
    for thread, outcome in stops:
        thread.join(5.0)
        assert outcome == [None]
    assert one.video.frames == 3


def test_a_file_that_is_there_is_not_replaced(topics, clock, files):
    (files.folder / "walk.mp4").write_text("precious")
    wish = VideoWish(files.folder / "walk.mp4", "mp4", "h264")
    one = Recording("r", CAMERA, 0.0, topics, clock, files, wish)
    with pytest.raises(BadGoal, match="is there already"):
        one.start()
    assert one.report().state == "ready"
    assert (files.folder / "walk.mp4").read_text() == "precious"


def read(path):
    import cv2

    capture = cv2.VideoCapture(str(path))
    found = []
    while True:
        there, picture = capture.read()
        if not there:
            return found
        found.append(number_of(picture))


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
