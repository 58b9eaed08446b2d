"""Sweeps of whole stacks, without one: what is watched, when it is pushed, what is refused."""

from __future__ import annotations

import math

import pytest

from nao_library_modules.sweeps import BehaviorGoal, sweep_stack
from nao_library_modules.sweeps.sweep_stack import Push, TorsoWatch
from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.readings import Pose


def torso(x, lean):
    """A torso at (x, 0) that leans forward."""
    return Pose((x, 0.0, 0.3), (0.0, math.sin(lean / 2), 0.0, math.cos(lean / 2)))


def watch(push=None):
    """A watch from 10 s on, and the pushes that it has made."""
    pushes = []
    return TorsoWatch(10.0, push, pushes.append), pushes


def test_a_lean_above_one_rad_at_any_time_is_a_fall():
    seen, _ = watch()
    for time, x, lean in ((9.9, 5.0, 3.0), (10.1, 0.0, 0.1), (10.2, 0.3, 0.99), (10.3, 0.2, 0.0)):
        seen.look(time, torso(x, lean))
    assert not seen.fell and seen.lean == pytest.approx(0.99) and seen.moved == pytest.approx(0.2)
    seen.look(10.4, torso(0.2, 1.01))
    seen.look(10.5, torso(0.2, 0.0))
    assert seen.fell


def test_a_push_comes_once_at_its_moment_after_the_begin():
    push = Push(2.0, math.pi / 2, moment=1.5)
    assert push.force == pytest.approx((0.0, 20.0, 0.0))
    seen, pushes = watch(push)
    for time in (10.5, 12.0):
        seen.look(time, torso(0.0, 0.0))
    seen.begin(12.0)
    seen.begin(13.0)
    seen.look(13.4, torso(0.0, 0.0))
    assert pushes == []
    for time in (13.6, 13.7):
        seen.look(time, torso(0.0, 0.0))
    seen.end()
    assert pushes == [push] and seen.pushed_at == pytest.approx(1.6)


def test_a_run_that_is_shorter_than_it_was_is_pushed_at_its_end():
    seen, pushes = watch(Push(2.0, 0.0, moment=5.0))
    seen.begin(10.0)
    seen.look(13.0, torso(0.0, 0.0))
    seen.end()
    assert len(pushes) == 1 and seen.pushed_at == pytest.approx(3.0)


@pytest.mark.parametrize(
    "options, words",
    [
        ({"push": [-1.0]}, "push is -1.0, allowed is 0 to 1000 N s"),
        ({"delay": [2.0]}, "sensor_delay is 2.0, allowed is 0 to 1 s"),
        ({"noise": [math.nan]}, "sensor_noise is nan"),
        ({"parameters": {"push": ["1"]}}, "parameter is 'push'"),
        ({"parameters": {"output": ["1"]}}, "parameter is 'output'"),
    ],
)
def test_what_every_run_would_refuse_is_refused_at_once(options, words):
    with pytest.raises(BadValue, match=words):
        sweep_stack(BehaviorGoal("nod"), 1, workers=0, progress=False, **options)
