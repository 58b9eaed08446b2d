"""Rotations of plain tuples: known values, round trips, and agreement with the matrices of the kinematics."""

from __future__ import annotations

import math

import pytest

from nao_sim_bridge.sim.kinematics import quaternion_matrix, rpy_matrix
from nao_sim_bridge.sim.rotations import cross, from_roll_pitch_yaw, roll_pitch_yaw, rotate, rotate_back

HALF = math.sqrt(0.5)
ANGLES = [(0.0, 0.0, 0.0), (0.3, -0.4, 2.0), (-3.0, 1.2, -0.1), (0.5, -1.5, 3.1), (1e-9, 0.0, -1e-9)]


@pytest.mark.parametrize(
    "quaternion, vector, turned",
    [
        ((0, 0, 0, 1), (1, 2, 3), (1, 2, 3)),
        ((0, 0, HALF, HALF), (1, 0, 0), (0, 1, 0)),
        ((HALF, 0, 0, HALF), (0, 1, 0), (0, 0, 1)),
        ((0, HALF, 0, HALF), (0, 0, 1), (1, 0, 0)),
        ((0, 0, 1, 0), (1, 2, 3), (-1, -2, 3)),
    ],
)
def test_rotation_by_known_angles(quaternion, vector, turned):
    assert rotate(quaternion, vector) == pytest.approx(turned)
    assert rotate_back(quaternion, turned) == pytest.approx(vector)


@pytest.mark.parametrize("angles", ANGLES)
def test_it_agrees_with_the_matrices(angles):
    quaternion = from_roll_pitch_yaw(*angles)
    assert quaternion_matrix(quaternion) == pytest.approx(rpy_matrix(angles))
    assert rotate(quaternion, (0.3, -2.0, 1.0)) == pytest.approx(tuple(rpy_matrix(angles) @ (0.3, -2.0, 1.0)))


@pytest.mark.parametrize("angles", ANGLES)
def test_roll_pitch_yaw_survive_the_way_through_a_quaternion(angles):
    assert roll_pitch_yaw(from_roll_pitch_yaw(*angles)) == pytest.approx(angles)


@pytest.mark.parametrize("pitch", [math.pi / 2, -math.pi / 2])
def test_a_pitch_of_ninety_degrees_survives_rounding(pitch):
    assert roll_pitch_yaw(from_roll_pitch_yaw(0.0, pitch, 0.0))[1] == pytest.approx(pitch)
    # A component a hair above 1 must not leave the range of the arc sine.
    assert math.isfinite(roll_pitch_yaw((0.0, HALF + 1e-9, 0.0, HALF + 1e-9))[1])


def test_the_cross_product_follows_the_right_hand_rule():
    assert cross((1, 0, 0), (0, 1, 0)) == (0, 0, 1)
    assert cross((1, 2, 3), (4, 5, 6)) == (-3, 6, -3)
