"""Aims: goals that follow paths or approach targets."""

from __future__ import annotations

import numpy as np
import pytest

from nao_sim_bridge.sim.frames import frame_of
from nao_sim_bridge.sim.kinematics import axis_matrix, transform
from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.motion.inverse_kinematics import Goal
from nao_sim_bridge.sim.motion.whole_body_aims import PathAim, TargetAim

GOAL = Goal(frame_of(load_model(), "LArm"), np.eye(4))
TICK = 1.0 / 120.0
SPEED = (0.1, 1.0)


def at(x, turn=0.0):
    return transform(axis_matrix((0.0, 0.0, 1.0), turn), (x, 0.0, 0.0))


def watched(aim, seconds):
    """Positions along X, one a tick."""
    found = []
    for _ in range(round(seconds / TICK)):
        aim.advance(TICK)
        found.append(aim.goal.pose[0, 3])
    return np.array(found)


def test_a_path_is_followed_and_its_end_is_kept():
    aim = PathAim(GOAL, lambda elapsed: at(0.1 * elapsed), 1.0)
    assert watched(aim, 0.5)[-1] == pytest.approx(0.05)
    assert not aim.resting
    assert watched(aim, 1.0)[-1] == pytest.approx(0.1)
    assert aim.resting


def test_a_target_is_reached_at_limited_speed_without_overshoot():
    aim = TargetAim(GOAL, at(0.2, 0.5), SPEED)
    places = watched(aim, 5.0)
    assert np.diff(places).max() <= SPEED[0] * TICK + 1e-12
    assert places.max() <= 0.2 + 1e-6
    assert aim.resting
    assert aim.goal.pose == pytest.approx(at(0.2, 0.5))


def test_turns_have_a_limited_speed_too():
    aim = TargetAim(GOAL, at(0.0, 2.0), SPEED)
    watched(aim, 1.0)
    turned = np.arctan2(aim.goal.pose[1, 0], aim.goal.pose[0, 0])
    assert 0.5 < turned <= 1.0


def test_a_new_target_bends_the_way_without_a_jerk():
    aim = TargetAim(GOAL, at(0.2), SPEED)
    before = watched(aim, 0.6)
    aim.aim(at(0.0))
    places = np.concatenate((before, watched(aim, 5.0)))
    # Acceleration stays below what a spring of the approach would do.
    assert np.abs(np.diff(places, 2)).max() / TICK**2 < 8.0
    assert places[-1] == pytest.approx(0.0, abs=1e-5)
