"""Ranked wishes: each is served as far as those before it and the bounds leave it free."""

from __future__ import annotations

import numpy as np
import pytest

from nao_sim_bridge.sim.motion.task_solver import Wish, ranked_step

WIDE = np.full(4, 10.0)
EVEN = np.ones(4)
NOTHING = np.zeros(4)


def wish(rows, change, damping=1e-7):
    return Wish(np.array(rows, dtype=float), np.array(change, dtype=float), damping)


SUM = wish([[1, 1, 1, 1]], [2.0])
FIRST = wish([[1, 0, 0, 0]], [5.0])


def test_the_first_wish_holds_and_the_second_one_as_far_as_it_can():
    against = wish([[1, 0, 0, 0]], [-3.0])
    step = ranked_step([FIRST, against, SUM], NOTHING, -WIDE, WIDE, EVEN)
    assert step[0] == pytest.approx(5.0, abs=1e-3)
    assert step.sum() == pytest.approx(2.0)


def test_freedom_that_is_left_goes_to_the_preferred_step():
    preferred = np.array([1.0, 2.0, 3.0, 4.0])
    step = ranked_step([FIRST], preferred, -WIDE, WIDE, EVEN)
    assert step == pytest.approx([5.0, 2.0, 3.0, 4.0], abs=1e-5)


def test_others_make_up_for_a_joint_at_its_bound():
    upper = np.array([0.1, 10.0, 10.0, 10.0])
    step = ranked_step([SUM], NOTHING, -WIDE, upper, EVEN)
    assert step[0] == pytest.approx(0.1)
    assert step.sum() == pytest.approx(2.0)


def test_no_bound_is_overstepped_even_when_the_wish_cannot_be_had():
    bounds = np.full(4, 0.25)
    step = ranked_step([SUM], NOTHING, -bounds, bounds, EVEN)
    assert step == pytest.approx(bounds)


def test_a_joint_that_stands_still_stays_and_one_that_must_move_does():
    lower, upper = np.array([0.0, 0.5, -10.0, -10.0]), np.array([0.0, 0.6, 10.0, 10.0])
    step = ranked_step([SUM], NOTHING, lower, upper, EVEN)
    assert step[0] == 0.0
    assert 0.5 <= step[1] <= 0.6
    assert step.sum() == pytest.approx(2.0)


def test_mobile_joints_do_more_of_the_work():
    step = ranked_step([SUM], NOTHING, -WIDE, WIDE, np.array([9.0, 1.0, 1.0, 1.0]))
    assert step[0] == pytest.approx(9.0 * step[1])
    assert step.sum() == pytest.approx(2.0)


def test_damping_keeps_a_step_small_where_a_wish_is_nearly_out_of_reach():
    faint = wish([[1e-4, 0, 0, 0]], [1.0], damping=1e-4)
    assert abs(ranked_step([faint], NOTHING, -WIDE, WIDE, EVEN)[0]) <= 1.0 + 1e-9
