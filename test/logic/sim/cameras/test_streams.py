"""Which frames fall due, who gets them, and how the cameras are set. Pictures are plain."""

from __future__ import annotations

import queue
from fractions import Fraction

import pytest

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.cameras import stream as streams
from nao_sim_bridge.cameras.rate import Shutter
from nao_sim_bridge.cameras.stream import CameraClosed

TOP = 0
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
