"""What raises in a tick or at the end of a task fails alone; the log names it once, and it is counted after that."""

from __future__ import annotations

import logging
from functools import partial

import pytest

from nao_sim_bridge.base.guard import Guard
from nao_sim_bridge.base.tasks import Task, TaskIds
from nao_sim_bridge.body.joint_commands import JointCommands
from nao_sim_bridge.body.leds import LedBank, LedKeyframe
from nao_sim_bridge.control.joints.curves import Ramp
from nao_sim_bridge.control.joints.engine import MotionEngine
from nao_sim_bridge.model.model_reader import load_model

TICK = 1.0 / 120.0


def broken(*_):
    raise ValueError("a slip")


class Broken:
    """An object that can be called."""

    def __call__(self, *_):
        raise KeyError("other")


def test_what_it_calls_answers_and_what_raises_is_named_and_counted():
    guard = Guard()
    assert guard.call(divmod, 7, 2) == (3, 1) and guard.failures() == []
    for culprit in (broken, partial(partial(broken, 1), 2), broken, Broken()):
        assert guard.call(culprit) is None
    first, second = guard.failures()
    assert first.culprit.endswith("test_guard.broken") and (first.count, first.error) == (3, "ValueError: a slip")
    assert second.culprit.endswith("test_guard.Broken") and second.count == 1


def test_the_log_has_the_first_error_with_its_traceback_and_then_only_how_many_there_were(caplog):
    guard = Guard()
    with caplog.at_level(logging.ERROR, "nao_sim.guard"):
        for _ in range(250):
            guard.call(broken)
    first, *others = caplog.records
    assert "broken failed" in first.getMessage() and first.exc_info[0] is ValueError
    assert ["failed 10 times: ValueError" in one.getMessage() for one in others] == [True, False]
    assert "failed 100 times" in others[-1].getMessage() and not any(one.exc_info for one in others)


def test_a_task_ends_for_everybody_also_where_one_of_its_callbacks_raises():
    ids, heard = TaskIds(), []
    task = ids.make("glide", on_kill=broken)
    after = task.then(lambda _: 1 / 0)
    task.add_done_callback(broken)
    task.add_done_callback(heard.append)
    assert task.kill() and heard == [task] and task.finished
    task.add_done_callback(broken)
    with pytest.raises(ZeroDivisionError):
        after.result(timeout=0)
    assert [failure.count for failure in ids.guard.failures()] == [3]
    Task("alone", 1).add_done_callback(broken)


@pytest.fixture
def engine():
    model = load_model()
    return MotionEngine(JointCommands(model, [0.0] * 26), TaskIds())


class BrokenCurve:
    """A curve that raises half-way."""

    duration = 1.0

    def value(self, elapsed):
        return 0.0 if elapsed < 0.1 else broken()


class EndlessCurve:
    """A curve that raises when it is asked for its end."""

    def value(self, _):
        return 0.0

    @property
    def duration(self):
        return broken()


@pytest.mark.parametrize("build", [broken, lambda _: {0: BrokenCurve()}, lambda _: {0: EndlessCurve()}])
@pytest.mark.parametrize("kind", ["follow", "stiffen"])
def test_a_motion_that_raises_fails_alone_and_tells_who_waits_for_it(engine, build, kind):
    failing = getattr(engine, kind)("glide", [0], build)
    other = engine.follow("turn", [1], lambda _: {1: Ramp(0.0, 0.2, 0.4)})
    for number in range(100):
        engine.tick(number * TICK, TICK)
    with pytest.raises(ValueError, match="a slip"):
        failing.result(timeout=0)
    assert other.finished and other.error is None and engine.tasks() == []
    assert engine._joints.commands[1] == pytest.approx(0.2)


def test_an_animation_of_leds_that_raises_fails_alone():
    ids = TaskIds()
    leds = LedBank(4, ids)
    failing = leds.animate("fade", [LedKeyframe(1.0, {0: 1.0, 1: 1.0})], 0.0)
    for fade in leds._fades.values():
        fade.value = broken
    other = leds.animate("fade", [LedKeyframe(0.5, {2: 1.0})], 0.0)
    for number in range(100):
        leds.tick(number * TICK)
    with pytest.raises(ValueError):
        failing.result(timeout=0)
    assert other.finished and leds.values[2] == 1.0 and ids.guard.failures()[0].culprit == "task fade"
