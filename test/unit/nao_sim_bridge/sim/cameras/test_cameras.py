"""Which frames fall due, and who gets them. Pictures are plain."""

from __future__ import annotations

import queue
import threading

import pytest

from nao_sim_bridge.sim.cameras import stream as streams
from nao_sim_bridge.sim.cameras.stream import CameraClosed
from nao_sim_bridge.sim.errors import BadValue
from nao_sim_bridge.sim.render import RenderError

TOP, BOTTOM = 0, 1


def in_thread(call):
    """What a call in another thread gives, to be waited for."""
    answers = queue.Queue()

    def run():
        try:
            answers.put(call())
        except Exception as error:
            answers.put(error)

    threading.Thread(target=run, daemon=True).start()
    return answers


# --- frames -------------------------------------------------------------------------------------------------------


def test_a_frame_says_what_it_is(head):
    stream = head.open(camera=BOTTOM, resolution=0, color_space=13)
    head.run(3)
    frame = head.take(stream)
    assert (frame.time, frame.camera, frame.number) == (pytest.approx(1 / 120), BOTTOM, 0)
    assert (frame.width, frame.height, frame.layers, frame.color_space) == (160, 120, 3, 13)
    assert (frame.hfov, frame.vfov) == head.cameras.optics(BOTTOM).fov
    assert frame.array().shape == (120, 160, 3) and not frame.array().flags.writeable
    assert frame.stamp == (0, 8333)
    grey = head.open(color_space=0)
    head.run()
    assert head.take(grey).array().shape == (240, 320)


def test_frames_fall_due_in_simulated_time(head):
    stream = head.open(fps=30)
    assert head.times(stream, 20) == [1, 5, 9, 13, 17]


def test_a_rate_that_is_no_part_of_the_ticks_does_not_drift(head):
    ticks = head.times(head.open(fps=25), 241)
    assert len(ticks) == 51 and ticks[-1] == 241
    assert {later - earlier for earlier, later in zip(ticks, ticks[1:])} == {4, 5}


def test_slower_streams_get_frames_of_the_faster_ones(head):
    slow = head.open(fps=5)
    head.run(10)
    fast = head.open(fps=30)
    due = {name: [] for name in ("slow", "fast")}
    for _ in range(110):
        head.run()
        for name, stream in (("slow", slow), ("fast", fast)):
            if stream._pending:
                due[name].append(head.take(stream).number)
    assert head.cameras.rate(TOP) == 30.0
    assert len(due["slow"]) == 5 and set(due["slow"][1:]) < set(due["fast"])
    fast.close()
    assert head.cameras.rate(TOP) == 5.0
    slow.close()
    assert head.cameras.rate(TOP) == 0.0


def test_nothing_is_drawn_before_somebody_asks(head):
    stream = head.open()
    head.run(40)
    assert head.pictures.shots == []
    assert head.take(stream).time == pytest.approx(37 / 120)
    assert len(head.pictures.shots) == 1


def test_a_frame_is_not_had_twice(head):
    stream = head.open()
    head.run(5)
    assert head.take(stream).number == 1
    with pytest.raises(TimeoutError, match="camera stream 'test': no frame within 0.01 s"):
        stream.take(0.01)
    waiting = in_thread(lambda: stream.take(head.patience))
    head.run(4)
    assert waiting.get(timeout=head.patience).number == 2


def test_a_frame_that_comes_after_the_time_is_up_is_kept(head):
    stream = head.open()
    head.pictures.free.clear()
    head.run()
    with pytest.raises(TimeoutError):
        stream.take(0.01)
    head.pictures.free.set()
    assert head.take(stream).number == 0


def test_every_frame_counts_for_those_who_say_so(head):
    stream = head.open(every=True, keep=3)
    head.run(12)
    assert [head.take(stream).number for _ in range(3)] == [0, 1, 2]
    head.run(20)
    assert stream.dropped == 2
    assert [head.take(stream).number for _ in range(3)] == [5, 6, 7]


def test_calls_are_answered_in_their_order(head):
    stream = head.open()
    answers = queue.Queue()
    for _ in range(3):
        stream.ask(answers.put)
    head.run(9)
    assert [answers.get(timeout=head.patience).number for _ in range(3)] == [0, 1, 2]
    for _ in range(streams.MOST_ASKS):
        stream.ask(answers.put)
    with pytest.raises(BadValue, match="calls that wait for a frame is 33, allowed is at most 32"):
        stream.ask(answers.put)


def test_who_gives_up_gets_nothing_and_the_next_one_does(head):
    stream = head.open()
    answers = queue.Queue()
    first = stream.ask(answers.put)
    second = stream.ask(answers.put)
    assert stream.give_up(first)
    head.run()
    assert answers.get(timeout=head.patience).number == 0
    assert answers.empty()
    assert not stream.give_up(second)


def test_the_same_picture_is_drawn_once(head):
    streams_of_one_size = [head.open() for _ in range(3)]
    head.run()
    pictures = [head.take(stream).data for stream in streams_of_one_size]
    assert len(head.pictures.shots) == 1 and pictures[0] == pictures[1] == pictures[2]
    other = head.open(color_space=0)
    head.run(4)
    head.take(streams_of_one_size[0]), head.take(other)
    assert len(head.pictures.shots) == 3


def test_what_cannot_be_drawn_is_an_error_for_who_asked(head):
    stream = head.open()
    head.run()
    head.pictures.error = RenderError("the picture process ended")
    with pytest.raises(RenderError, match="the picture process ended"):
        head.take(stream)
    head.pictures.error = None
    head.run(4)
    assert head.take(stream).number == 1


@pytest.mark.parametrize("every", [False, True])
def test_the_noise_of_a_frame_is_always_the_same(head_of, every):
    heads = [head_of(), head_of()]
    data = []
    for each, ticks in zip(heads, (13, 17)):
        stream = each.open(every=every, keep=10)
        each.run(13)
        frames = [each.take(stream)]
        while frames[-1].number < 3:
            each.run(1 if ticks == 13 else 2)
            frames.append(each.take(stream))
        data.append({frame.number: frame.data for frame in frames})
    common = set(data[0]) & set(data[1])
    assert common and all(data[0][number] == data[1][number] for number in common)
    assert len(set(data[0].values())) == len(data[0])


# --- changes while it runs ----------------------------------------------------------------------------------------


def test_everything_about_a_stream_can_be_changed(head):
    stream = head.open(fps=30)
    stream.resolution, stream.color_space, stream.fps = 0, 0, 10
    head.run()
    frame = head.take(stream)
    assert (frame.width, frame.layers) == (160, 1)
    assert (stream.resolution, stream.color_space, stream.fps) == (0, 0, 10)
    assert head.times(stream, 24) == [13, 25]
    stream.camera = BOTTOM
    head.run()
    assert head.take(stream).camera == BOTTOM
    assert head.cameras.rate(TOP) == 0.0


@pytest.mark.parametrize(
    "field, value, text",
    [
        ("camera", 2, "camera is 2"),
        ("resolution", 5, "resolution is 5"),
        ("resolution", 4, "resolution is 4, allowed is one of .* with camera 1"),
        ("color_space", 17, "needs a depth camera"),
        ("fps", 60, "fps is 60"),
    ],
)
def test_what_the_cameras_cannot_do_changes_nothing(head, field, value, text):
    stream = head.open(camera=BOTTOM)
    before = getattr(stream, field)
    with pytest.raises(BadValue, match=text):
        setattr(stream, field, value)
    assert getattr(stream, field) == before
    with pytest.raises(BadValue, match=text):
        head.open(**{"camera": BOTTOM, field: value})
    assert head.cameras.streams == (stream,)


def test_the_largest_pictures_come_at_their_own_rate(head):
    stream = head.open(resolution=4, fps=30)
    assert head.cameras.rate(TOP) == 1.0
    stream.resolution = 3
    assert head.cameras.rate(TOP) == 30.0


def test_a_camera_that_is_stopped_takes_no_pictures(head):
    stream = head.open()
    head.run(5)
    head.take(stream)
    head.cameras.set_stopped(TOP, True)
    head.run(40)
    with pytest.raises(TimeoutError):
        stream.take(0.01)
    head.cameras.set_stopped(TOP, False)
    head.run()
    assert head.take(stream).time == pytest.approx(46 / 120)


def test_a_finished_stream_gives_what_it_has(head):
    stream = head.open(every=True, keep=5)
    head.run(5)
    stream.finish()
    head.run(20)
    assert [head.take(stream).number for _ in range(2)] == [0, 1]
    with pytest.raises(CameraClosed, match="camera stream 'test' is finished"):
        head.take(stream)
    assert head.cameras.rate(TOP) == 0.0


def test_who_waits_at_the_end_is_told(head):
    stream, other = head.open(), head.open()
    waiting = in_thread(lambda: stream.take(head.patience))
    while not stream._asks:
        pass
    stream.close()
    assert isinstance(waiting.get(timeout=head.patience), CameraClosed)
    assert head.cameras.streams == (other,)
    waiting = in_thread(lambda: other.take(head.patience))
    while not other._asks:
        pass
    head.cameras.close()
    assert isinstance(waiting.get(timeout=head.patience), CameraClosed)
    with pytest.raises(CameraClosed):
        other.take(head.patience)
    with pytest.raises(CameraClosed, match="the simulation has ended"):
        head.open()


# --- time that runs fast ------------------------------------------------------------------------------------------


def test_fast_time_waits_until_the_next_frame_is_asked_for(head):
    stream = head.open(every=True)
    assert not head.cameras.holds()
    head.run()
    assert head.cameras.holds()
    head.take(stream)
    assert head.cameras.holds(), "what is done with the frame takes no simulated time either"
    head.released.clear()
    ask = stream.ask(lambda _: None)
    assert not head.cameras.holds() and head.released.is_set()
    head.pictures.free.clear()
    head.run(4)
    assert head.cameras.holds(), "it is being drawn"
    head.pictures.free.set()
    stream.close()
    assert not head.cameras.holds()
    del ask


def test_fast_time_does_not_wait_for_those_who_want_the_newest(head):
    stream = head.open()
    head.run(10)
    head.take(stream)
    head.run(10)
    assert not head.cameras.holds()


def test_fast_time_does_not_wait_for_ever(head, monkeypatch):
    monkeypatch.setattr(streams, "PATIENCE", 0.0)
    head.open(every=True)
    head.run()
    assert not head.cameras.holds()


# --- many users -------------------------------------------------------------------------------------------------


def test_many_threads_at_once(head):
    """Opening, changing and closing while frames fall due and are taken."""
    failures = queue.Queue()

    def use(seed):
        try:
            for round_ in range(15):
                stream = head.open(camera=(seed + round_) % 2, fps=1 + (7 * seed + round_) % 30)
                stream.resolution = (0, 1, 7)[round_ % 3]
                try:
                    frame = stream.take(0.02)
                    assert frame.camera == stream.camera
                except TimeoutError:
                    pass
                stream.camera = BOTTOM
                stream.close()
        except Exception as error:
            failures.put(error)

    users = [threading.Thread(target=use, args=(seed,)) for seed in range(4)]
    for user in users:
        user.start()
    while any(user.is_alive() for user in users):
        head.run()
    assert failures.empty(), failures.get()
    assert head.cameras.streams == () and head.cameras.rate(TOP) == head.cameras.rate(BOTTOM) == 0.0
