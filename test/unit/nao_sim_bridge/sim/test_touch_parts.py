"""Limbs that somebody holds."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim.touch_parts import LimbTouch


def held(one, seconds):
    """What is told as touched in the next seconds."""
    limbs, told = LimbTouch(one.model), []
    for snapshot in one.watch(seconds):
        now = limbs.look(snapshot)
        if not told or told[-1] != now:
            told.append(now)
    return told


def test_a_robot_that_stands_is_not_touched(bench):
    assert held(bench(), 2.0) == [frozenset()]


def test_an_arm_that_is_pulled_is_touched_until_it_is_let_go(bench):
    one = bench()
    one.run(0.2)
    one.push((12.0, 0.0, 0.0), 1.5, "l_wrist")
    assert held(one, 3.0) == [frozenset(), {"LArm"}, frozenset()]


def test_an_arm_that_moves_is_not_touched(bench):
    one = bench()
    one.run(1.0)
    one.aim(1.0, RShoulderPitch=0.0, RElbowRoll=1.2)
    assert held(one, 3.0) == [frozenset()]


def test_a_limp_arm_cannot_tell(bench):
    one = bench()
    one.stiffen(0.0, *one.model.chains["LArm"])
    one.run(0.2)
    one.push((4.0, 0.0, 0.0), 1.0, "l_wrist")
    assert held(one, 2.0) == [frozenset()]


@pytest.mark.parametrize("posture", ["Crouch", "StandInit"])
def test_postures_do_not_look_like_touches(bench, posture):
    assert held(bench(posture), 2.0) == [frozenset()]
