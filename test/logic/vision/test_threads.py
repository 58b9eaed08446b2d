"""Streams and recordings alike: what is dropped, how they end, what they tell of themselves; the table of them."""

from __future__ import annotations

import threading

import pytest
from camera_topics import CAMERA, OUT, numbers_of, wait_for

from nao_library_modules.core.errors import BadGoal
from nao_library_modules.vision import pictures as vision_queue
from nao_library_modules.vision.capture_jobs import MOST_JOBS, CaptureJobs, Stream

FRAME = 64 * 48 * 3


@pytest.mark.parametrize("limit, value, left", [("MOST_FRAMES", 4, 4), ("MOST_BYTES", 3 * FRAME + 100, 3)])
def test_a_slow_thread_drops_the_oldest_frames_and_counts_them(stream, topics, send, monkeypatch, limit, value, left):
    monkeypatch.setattr(vision_queue, limit, value)
    one = stream()
    reached, go_on = threading.Event(), threading.Event()
    topics.publishers[OUT].before = lambda: (reached.set(), go_on.wait(60.0))
    send(1)
    assert reached.wait(60.0)
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


def test_the_table_knows_its_threads(topics, clock):
    threads = CaptureJobs()

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
    for number in range(MOST_JOBS - 2):
        threads.add(made(f"t{number}"))
    with pytest.raises(BadGoal, match="too many"):
        threads.add(made("one more"))
    threads.remove("t0")
    threads.close()
    with pytest.raises(BadGoal, match="the server ends"):
        threads.add(made("late"))
