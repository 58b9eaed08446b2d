"""Inverse kinematics, and the aims of whole body control."""

from __future__ import annotations

import numpy as np
import pytest

from nao_sim_bridge.control.whole_body.aims import PathAim, TargetAim
from nao_sim_bridge.control.whole_body.body_kinematics import body_kinematics
from nao_sim_bridge.control.whole_body.cartesian_path import SolvedPath
from nao_sim_bridge.control.whole_body.inverse_kinematics import Goal, solve
from nao_sim_bridge.control.whole_body.task_solver import Wish, ranked_step
from nao_sim_bridge.model.frames import FEET, frame_of
from nao_sim_bridge.model.kinematics import axis_matrix, transform
from nao_sim_bridge.model.model_reader import load_model
from nao_sim_bridge.model.postures import posture

MODEL = load_model()
BODY = body_kinematics(MODEL)
STAND = np.array(posture(MODEL, "Stand"))
ARM, LEFT, RIGHT = (frame_of(MODEL, name) for name in ("LArm", *FEET))
Z = (0.0, 0.0, 1.0)


def chain(*names):
    return [MODEL.joint_index[j] for name in names for j in MODEL.chains[name] if not MODEL.joint(j).is_hand]


def shifted(pose, *by):
    moved = pose.copy()
    moved[:3, 3] += by
    return moved


WIDE, EVEN, NOTHING = np.full(4, 10.0), np.ones(4), np.zeros(4)


def wish(rows, change, damping=1e-7):
    return Wish(np.array(rows, dtype=float), np.array(change, dtype=float), damping)


SUM, FIRST = wish([[1, 1, 1, 1]], [2.0]), wish([[1, 0, 0, 0]], [5.0])


def test_the_first_wish_holds_and_later_ones_and_the_preferred_step_as_far_as_they_can():
    step = ranked_step([FIRST, wish([[1, 0, 0, 0]], [-3.0]), SUM], NOTHING, -WIDE, WIDE, EVEN)
    assert (step[0], step.sum()) == (pytest.approx(5.0, abs=1e-3), pytest.approx(2.0))
    step = ranked_step([FIRST], np.array([1.0, 2.0, 3.0, 4.0]), -WIDE, WIDE, EVEN)
    assert step == pytest.approx([5.0, 2.0, 3.0, 4.0], abs=1e-5)
    step = ranked_step([SUM], NOTHING, -WIDE, WIDE, np.array([9.0, 1.0, 1.0, 1.0]))
    assert (step[0], step.sum()) == pytest.approx((9.0 * step[1], 2.0)), "mobile joints do more of the work"
    faint = wish([[1e-4, 0, 0, 0]], [1.0], damping=1e-4)
    assert abs(ranked_step([faint], NOTHING, -WIDE, WIDE, EVEN)[0]) <= 1.0 + 1e-9, "damped"


def test_others_make_up_for_a_joint_at_its_bound_and_no_bound_is_overstepped():
    step = ranked_step([SUM], NOTHING, -WIDE, np.array([0.1, 10.0, 10.0, 10.0]), EVEN)
    assert (step[0], step.sum()) == pytest.approx((0.1, 2.0))
    tight = np.full(4, 0.25)
    assert ranked_step([SUM], NOTHING, -tight, tight, EVEN) == pytest.approx(tight)
    lower, upper = np.array([0.0, 0.5, -10.0, -10.0]), np.array([0.0, 0.6, 10.0, 10.0])
    step = ranked_step([SUM], NOTHING, lower, upper, EVEN)
    assert step[0] == 0.0 and 0.5 <= step[1] <= 0.6 and step.sum() == pytest.approx(2.0)


@pytest.mark.parametrize("names, mask", [(["LArm"], 7), (["LArm", "RArm"], 63), (["LLeg", "RLeg"], 63)])
def test_reachable_poses_are_reached_within_the_limits_by_the_joints_that_are_named(names, mask):
    chance, indices, frames = np.random.default_rng(1), chain(*names), [frame_of(MODEL, name) for name in names]
    others = [i for i in range(26) if i not in indices]
    for _ in range(5):
        angles = STAND.copy()
        angles[indices] += chance.uniform(-0.25, 0.25, len(indices))
        angles[BODY.right_hip] = angles[BODY.left_hip]
        wanted = BODY.at(np.clip(angles, *BODY.limits(angles)))
        found = solve(BODY, indices, [Goal(frame, wanted.pose(frame), mask) for frame in frames], STAND)
        lower, upper = BODY.limits(found)
        assert np.all(found[indices] >= lower[indices] - 1e-9) and np.all(found[indices] <= upper[indices] + 1e-9)
        assert found[BODY.right_hip] == found[BODY.left_hip] and found[others] == pytest.approx(STAND[others])
        for frame in frames:
            assert BODY.at(found).pose(frame)[:3, 3] == pytest.approx(wanted.pose(frame)[:3, 3], abs=1e-3)


@pytest.mark.parametrize("mask", [7, 63])
def test_a_target_out_of_reach_stretches_the_arm_towards_it(mask):
    target = transform(np.eye(3), (1.0, 0.1, 0.1))
    found = BODY.at(solve(BODY, chain("LArm"), [Goal(ARM, target, mask)], STAND)).pose(ARM)
    shoulder = MODEL.joint("LShoulderPitch").origin
    toward, reach = target[:3, 3] - shoulder, found[:3, 3] - shoulder
    assert np.linalg.norm(reach) > 0.2
    assert reach @ toward / np.linalg.norm(reach) / np.linalg.norm(toward) > 0.99


def test_axes_outside_the_mask_do_not_matter_and_what_must_hold_holds():
    target = shifted(BODY.at(STAND).pose(ARM), 9.0, 9.0, 0.03)
    found = solve(BODY, chain("LArm"), [Goal(ARM, target, 4)], STAND)
    assert BODY.at(found).pose(ARM)[2, 3] == pytest.approx(target[2, 3], abs=1e-4)
    now = BODY.at(STAND)
    turned = now.pose(LEFT) @ transform(axis_matrix(Z, 0.5), (0.0, 0.0, 0.02))
    goals = [Goal(RIGHT, now.pose(RIGHT), rank=0), Goal(LEFT, turned)]
    found = BODY.at(solve(BODY, chain("LLeg", "RLeg"), goals, STAND))
    assert found.pose(RIGHT) == pytest.approx(now.pose(RIGHT), abs=1e-4)
    assert found.pose(LEFT)[2, 3] > now.pose(LEFT)[2, 3] + 0.005


def test_an_interpolated_path_passes_through_its_samples_and_rests_at_its_ends():
    values = {0.1: 1.0, 0.2: 3.0, 0.3: 2.0}
    path = SolvedPath([0.0, *values], np.zeros(1), lambda moment, before: np.array([values[moment]]))
    assert [path.angles(t)[0] for t in (0.0, *values)] == pytest.approx([0.0, 1.0, 3.0, 2.0])
    assert (path.angles(0.001)[0], path.angles(0.299)[0]) == pytest.approx((0.0, 2.0), abs=1e-3)
    assert max(path.angles(t)[0] for t in np.linspace(0.0, 0.3, 61)) <= 3.0
    assert (path.angles(-1.0)[0], path.angles(9.0)[0]) == (0.0, 2.0)


TICK, SPEED = 1.0 / 120.0, (0.1, 1.0)


def at(x, turn=0.0):
    return transform(axis_matrix(Z, turn), (x, 0.0, 0.0))


def watched(aim, seconds):
    """Positions along X, one a tick."""
    return np.array([aim.advance(TICK) or aim.goal.pose[0, 3] for _ in range(round(seconds / TICK))])


def test_a_path_is_followed_and_its_end_is_kept():
    aim = PathAim(Goal(ARM, np.eye(4)), lambda elapsed: at(0.1 * elapsed), 1.0)
    assert watched(aim, 0.5)[-1] == pytest.approx(0.05) and not aim.resting
    assert watched(aim, 1.0)[-1] == pytest.approx(0.1) and aim.resting


def test_a_target_is_reached_at_limited_speed_without_overshoot_or_jerk():
    aim = TargetAim(Goal(ARM, np.eye(4)), at(0.2, 0.5), SPEED)
    places = watched(aim, 5.0)
    assert np.diff(places).max() <= SPEED[0] * TICK + 1e-12 and places.max() <= 0.2 + 1e-6
    assert aim.resting and aim.goal.pose == pytest.approx(at(0.2, 0.5))
    aim.aim(at(0.2, 2.5))
    watched(aim, 1.0)
    assert 1.0 < np.arctan2(aim.goal.pose[1, 0], aim.goal.pose[0, 0]) <= 1.5, "turns have a limited speed, too"
    aim = TargetAim(Goal(ARM, np.eye(4)), at(0.2), SPEED)
    before = watched(aim, 0.6)
    aim.aim(at(0.0))
    places = np.concatenate((before, watched(aim, 5.0)))
    # Acceleration stays below what a spring of the approach would do.
    assert np.abs(np.diff(places, 2)).max() / TICK**2 < 8.0 and places[-1] == pytest.approx(0.0, abs=1e-5)
