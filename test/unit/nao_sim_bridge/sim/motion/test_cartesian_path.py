"""Paths of effectors as curves of the joints: where they lead, and how little each step costs."""

from __future__ import annotations

import numpy as np
import pytest

from nao_sim_bridge.sim.frames import FEET, ROBOT, TORSO, WORLD, Placement, frame_of
from nao_sim_bridge.sim.kinematics import link_transforms, transform
from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.motion.body_kinematics import body_kinematics
from nao_sim_bridge.sim.motion.cartesian_move import CartesianMove, EffectorMove
from nao_sim_bridge.sim.motion.cartesian_path import PosePath, SolvedPath, joint_curves, sample_times
from nao_sim_bridge.sim.motion.grounded_pose import Footing, GroundedPose
from nao_sim_bridge.sim.postures import posture

MODEL = load_model()
BODY = body_kinematics(MODEL)
INIT = np.array(posture(MODEL, "StandInit"))
FOOT = frame_of(MODEL, "LLeg")
PLACED = Placement(link_transforms(MODEL, INIT), transform(np.eye(3), -BODY.at(INIT).pose(FOOT)[:3, 3]))


def shifted(pose, *by):
    moved = pose.copy()
    moved[:3, 3] += by
    return moved


def whole(curves, moment):
    """(26,) angles of curves at a time."""
    angles = INIT.copy()
    for index, curve in curves.items():
        angles[index] = curve.value(moment)
    return angles


def curves_of(moves, times):
    move = CartesianMove(BODY, moves, PLACED)
    return joint_curves(BODY, move.indices, move.goals_at, times, INIT, move.footing_at)


def on_the_left_foot(angles):
    """The body in the frame of the torso as it was before."""
    return GroundedPose(BODY.at(angles), Footing(FOOT, BODY.at(INIT).pose(FOOT)))


def test_a_path_is_straight_between_its_poses():
    hand = frame_of(MODEL, "LArm")
    now = BODY.at(INIT).pose(hand)
    path = PosePath((0.0, 1.0), [now, shifted(now, 0.04, 0.0, 0.04)])
    curves = curves_of([EffectorMove("LArm", TORSO, 7, path.pose)], [1.0])
    for moment in np.linspace(0.0, 1.0, 21):
        found = BODY.at(whole(curves, moment)).pose(hand)
        assert found[:3, 3] == pytest.approx(path.pose(moment)[:3, 3], abs=5e-4)


def test_samples_hold_every_key_time_and_steps_between():
    at = sample_times((0.12, 0.25))
    assert at == pytest.approx([0.0, 0.04, 0.08, 0.12, 0.12 + 0.13 / 3, 0.12 + 0.26 / 3, 0.25])
    assert sample_times((0.05,)) == [0.0, 0.05]


def test_samples_are_solved_when_time_comes_near_them():
    times = sample_times((10.0,))
    asked = []
    path = SolvedPath(times, np.zeros(1), lambda moment, before: asked.append(moment) or np.array([moment]))
    for tick in range(1201):
        path.angles(tick / 120.0)
        assert len(asked) <= len([t for t in times if t <= tick / 120.0]) + 2
    assert asked == times[1:]


def test_an_interpolated_path_passes_through_its_samples_and_rests_at_its_ends():
    times = [0.0, 0.1, 0.2, 0.3]
    values = {0.1: 1.0, 0.2: 3.0, 0.3: 2.0}
    path = SolvedPath(times, np.zeros(1), lambda moment, before: np.array([values[moment]]))
    assert [path.angles(t)[0] for t in times] == pytest.approx([0.0, 1.0, 3.0, 2.0])
    assert path.angles(0.001)[0] == pytest.approx(0.0, abs=1e-3)
    assert path.angles(0.299)[0] == pytest.approx(2.0, abs=1e-3)
    assert max(path.angles(t)[0] for t in np.linspace(0.0, 0.3, 61)) <= 3.0
    assert path.angles(-1.0)[0] == 0.0 and path.angles(9.0)[0] == 2.0


@pytest.mark.parametrize("space", [TORSO, WORLD, ROBOT])
def test_the_torso_moves_over_feet_that_stay(space):
    start = np.eye(4) if space == TORSO else PLACED.torso_in_world
    path = PosePath((0.0, 1.0), [start, shifted(start, 0.01, 0.02, -0.03)])
    # The frame of the robot is between the feet: the same shift, another origin.
    curves = curves_of([EffectorMove("Torso", WORLD if space == ROBOT else space, 63, path.pose)], [1.0])
    for moment in (0.3, 0.7, 1.0):
        now = on_the_left_foot(whole(curves, moment))
        shift = path.pose(moment)[:3, 3] - start[:3, 3]
        assert now.torso[:3, 3] == pytest.approx(shift, abs=1e-3)
        for name in FEET:
            foot = frame_of(MODEL, name)
            assert now.pose(foot) == pytest.approx(BODY.at(INIT).pose(foot), abs=5e-4)


def test_a_hand_stays_in_the_world_while_the_torso_moves():
    hand = frame_of(MODEL, "RArm")
    start = PLACED.torso_in_world @ BODY.at(INIT).pose(hand)
    torso = PLACED.torso_in_world
    path = PosePath((0.0, 1.0), [torso, shifted(torso, 0.0, 0.02, -0.02)])
    moves = [EffectorMove("Torso", WORLD, 63, path.pose), EffectorMove("RArm", WORLD, 7, lambda _: start)]
    end = on_the_left_foot(whole(curves_of(moves, [1.0]), 1.0))
    assert end.pose(hand)[:3, 3] == pytest.approx(BODY.at(INIT).pose(hand)[:3, 3], abs=1e-3)


def test_one_leg_moves_and_the_other_foot_stays():
    now = BODY.at(INIT)
    left, right = (frame_of(MODEL, name) for name in FEET)
    path = PosePath((0.0, 1.0), [now.pose(left), shifted(now.pose(left), 0.02, 0.01, 0.03)])
    end = BODY.at(whole(curves_of([EffectorMove("LLeg", TORSO, 63, path.pose)], [1.0]), 1.0))
    assert end.pose(left)[:3, 3] == pytest.approx(path.pose(1.0)[:3, 3], abs=1e-3)
    assert end.pose(right) == pytest.approx(now.pose(right), abs=1e-4)


def test_a_foot_that_is_moved_with_the_torso_goes_its_own_way():
    now = BODY.at(INIT)
    start = PLACED.torso_in_world @ now.pose(frame_of(MODEL, "RLeg"))
    lift = PosePath((0.0, 1.0), [start, shifted(start, 0.0, 0.0, 0.02)])
    torso = PLACED.torso_in_world
    moves = [EffectorMove("Torso", WORLD, 63, lambda _: torso), EffectorMove("RLeg", WORLD, 63, lift.pose)]
    end = on_the_left_foot(whole(curves_of(moves, [1.0]), 1.0))
    right = frame_of(MODEL, "RLeg")
    assert end.pose(right)[:3, 3] - now.pose(right)[:3, 3] == pytest.approx([0.0, 0.0, 0.02], abs=1e-3)
    assert end.torso == pytest.approx(np.eye(4), abs=1e-3)
