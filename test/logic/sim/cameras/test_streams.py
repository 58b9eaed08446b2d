"""Which frames fall due, who gets them, and how the cameras are set. Pictures are plain."""

from __future__ import annotations

import queue
from fractions import Fraction

import numpy as np
import pytest

from nao_sim_bridge.sim.cameras import stream as streams
from nao_sim_bridge.sim.cameras.rate import Shutter
from nao_sim_bridge.sim.cameras.stream import CameraClosed
from nao_sim_bridge.sim.errors import BadValue

TOP, BOTTOM = 0, 1
AUTO_EXPOSURE, AUTO_WHITE, EXPOSURE, GAIN, WHITE, LUMINANCE = 11, 12, 17, 6, 33, 39
TICKS = Fraction(120)


def ticks_of(head, ticks, stream=None, **options):
    """Ticks of the frames of a stream that takes every one, in the next `ticks`."""
    stream = stream or head.open(every=True, keep=1000, **options)
    head.run(ticks)
    stream.finish()
    found = []
    while True:
        try:
            found.append(round(120 * head.take(stream).time))
        except CameraClosed:
            return found


def next_ticks(shutter, count):
    found = []
    for _ in range(count):
        found.append(shutter.next_tick)
        shutter.advance(shutter.next_tick)
    return found


@pytest.mark.parametrize("rate", [1, 7, 24, 25, 29, 30])
def test_rates_do_not_drift(rate):
    shutter = Shutter(TICKS)
    shutter.set_rate(Fraction(rate), 0)
    ticks = next_ticks(shutter, 100 * rate + 1)
    assert all(abs(tick - 1 - Fraction(i * 120, rate)) <= Fraction(1, 2) for i, tick in enumerate(ticks))
    assert ticks[-1] == 1 + 100 * 120


def test_a_camera_begins_at_the_next_tick_and_another_rate_goes_on_from_the_last_frame():
    shutter = Shutter(TICKS)
    assert shutter.next_tick == Shutter.NEVER
    shutter.set_rate(Fraction(1, 10), 500)
    assert next_ticks(shutter, 2) == [501, 501 + 1200]
    shutter.set_rate(Fraction(0), 600)
    assert shutter.next_tick == Shutter.NEVER
    shutter.set_rate(Fraction(5), 0)
    assert next_ticks(shutter, 2) == [1, 25]
    shutter.set_rate(Fraction(30), 31)
    assert next_ticks(shutter, 3) == [33, 37, 41]
    shutter.set_rate(Fraction(5), 42)
    assert next_ticks(shutter, 2) == [65, 89]
    shutter.advance(150)
    assert shutter.next_tick == 161, "ticks that nobody looked at are left out"


def test_frames_fall_due_in_simulated_time_and_slower_streams_get_those_of_the_faster_ones(head):
    assert ticks_of(head, 20) == [1, 5, 9, 13, 17]
    slow = head.open(fps=5, every=True, keep=9)
    head.run(10)
    fast = head.open(fps=30, every=True, keep=99)
    head.run(110)
    assert head.cameras.rate(TOP) == 30.0
    fast_ticks = ticks_of(head, 0, fast)
    assert head.cameras.rate(TOP) == 5.0
    slow_ticks = ticks_of(head, 0, slow)
    assert head.cameras.rate(TOP) == 0.0
    assert slow_ticks == [21, 45, 69, 93, 117] and set(slow_ticks[1:]) < set(fast_ticks)


def test_a_frame_says_what_it_is(head):
    stream = head.open(camera=BOTTOM, resolution=0, color_space=13)
    head.run(3)
    assert head.pictures.shots == [], "nothing is drawn before somebody asks"
    frame = head.take(stream)
    assert len(head.pictures.shots) == 1
    assert (frame.time, frame.camera, frame.number) == (pytest.approx(1 / 120), BOTTOM, 0)
    assert (frame.width, frame.height, frame.layers, frame.color_space) == (160, 120, 3, 13)
    assert (frame.hfov, frame.vfov) == head.cameras.optics(BOTTOM).fov
    assert frame.array().shape == (120, 160, 3) and not frame.array().flags.writeable
    assert frame.stamp == (0, 8333)
    grey = head.open(color_space=0)
    head.run()
    assert head.take(grey).array().shape == (240, 320)


def test_the_newest_frame_is_had_once_and_who_waits_gets_the_next(head):
    stream = head.open()
    head.run(40)
    assert head.take(stream).time == pytest.approx(37 / 120)
    with pytest.raises(TimeoutError, match="camera stream 'test': no frame within 0.01 s"):
        stream.take(0.01)
    answers = queue.Queue()
    for _ in range(3):
        stream.ask(answers.put)
    head.run(9)
    assert [answers.get(timeout=head.patience).number for _ in range(3)] == [10, 11, 12]
    for _ in range(streams.MOST_ASKS):
        stream.ask(answers.put)
    with pytest.raises(BadValue, match="calls that wait for a frame is 33, allowed is at most 32"):
        stream.ask(answers.put)


def test_every_frame_counts_for_those_who_say_so_and_a_finished_stream_gives_what_it_has(head):
    stream = head.open(every=True, keep=3)
    head.run(12)
    assert [head.take(stream).number for _ in range(3)] == [0, 1, 2]
    head.run(20)
    assert stream.dropped == 2
    stream.finish()
    head.run(20)
    assert [head.take(stream).number for _ in range(3)] == [5, 6, 7]
    with pytest.raises(CameraClosed, match="camera stream 'test' is finished"):
        head.take(stream)
    assert head.cameras.rate(TOP) == 0.0
    with pytest.raises(BadValue, match="keep is 0"):
        head.open(every=True, keep=0)


def test_the_same_picture_is_drawn_once(head):
    of_one_size = [head.open() for _ in range(3)]
    head.run()
    pictures = [head.take(stream).data for stream in of_one_size]
    assert len(head.pictures.shots) == 1 and pictures[0] == pictures[1] == pictures[2]
    other = head.open(color_space=0)
    head.run(4)
    head.take(of_one_size[0]), head.take(other)
    assert len(head.pictures.shots) == 3


def test_who_waits_at_the_end_is_told(head):
    stream, other, answers = head.open(), head.open(), queue.Queue()
    stream.ask(answers.put)
    stream.close()
    assert isinstance(answers.get(timeout=head.patience), CameraClosed)
    assert stream.closed and head.cameras.streams == (other,)
    other.ask(answers.put)
    head.cameras.close()
    assert isinstance(answers.get(timeout=head.patience), CameraClosed)
    with pytest.raises(CameraClosed):
        head.take(other)
    with pytest.raises(CameraClosed, match="the simulation has ended"):
        head.open()


def test_fast_time_waits_for_those_who_want_every_frame_until_they_ask_for_the_next(head, monkeypatch):
    stream, newest = head.open(every=True), head.open()
    assert not head.cameras.holds()
    head.run()
    assert head.cameras.holds()
    head.take(stream)
    assert head.cameras.holds(), "what is done with the frame takes no simulated time either"
    head.released.clear()
    answers = queue.Queue()
    stream.ask(answers.put)
    assert not head.cameras.holds() and head.released.is_set()
    head.pictures.free.clear()
    head.run(4)
    assert head.cameras.holds(), "it is being drawn"
    head.pictures.free.set()
    answers.get(timeout=head.patience)
    monkeypatch.setattr(streams, "PATIENCE", 0.0)
    assert not head.cameras.holds(), "not for ever"
    monkeypatch.undo()
    assert head.cameras.holds()
    stream.close()
    head.take(newest)
    head.run(10)
    assert not head.cameras.holds()


def test_automatics_tell_what_they_chose_and_leave_it_behind(head):
    head.pictures.paint = lambda _, shape: np.full(shape, 60, np.uint8)
    stream = head.open()
    head.run()
    head.take(stream)
    exposure, gain = head.cameras.parameter(TOP, EXPOSURE), head.cameras.parameter(TOP, GAIN)
    assert exposure == 128 and gain > 16
    assert head.cameras.parameter(TOP, LUMINANCE) == pytest.approx(135, abs=3)
    assert head.cameras.parameter(BOTTOM, EXPOSURE) == 32
    head.cameras.set_parameter(TOP, AUTO_EXPOSURE, 0)
    assert (head.cameras.parameter(TOP, EXPOSURE), head.cameras.parameter(TOP, GAIN)) == (exposure, gain)
    head.run(4)
    assert head.take(stream).array().mean() == pytest.approx(135, abs=3)
    head.cameras.reset_parameters(TOP)
    assert head.cameras.parameter(TOP, AUTO_EXPOSURE) == 1 and head.cameras.parameter(TOP, LUMINANCE) == 0


def test_the_cameras_of_an_older_robot(head_of):
    head = head_of(version="V5")
    head.pictures.paint = lambda _, shape: np.full(shape, (130, 122, 116), np.uint8)
    stream = head.open()
    head.run()
    frame = head.take(stream)
    assert np.degrees((frame.hfov, frame.vfov)) == pytest.approx((60.9, 47.6))
    seen = head.cameras.parameter(TOP, WHITE)
    assert seen < 4600, "the light is warm"
    head.cameras.set_parameter(TOP, AUTO_WHITE, 0)
    assert head.cameras.parameter(TOP, WHITE) == seen
    head.cameras.set_parameter(TOP, WHITE, 6500)
    assert head.cameras.parameter(TOP, WHITE) == 6500
    with pytest.raises(BadValue, match="resolution is 4"):
        head.open(resolution=4)
    with pytest.raises(BadValue, match="parameter is 40"):
        head.cameras.parameter(TOP, 40)
