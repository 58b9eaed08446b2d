"""Odometry: it begins where the robot stands, looking ahead, whatever heading the inertial unit has then."""

from __future__ import annotations

import pytest

from nao_sim_bridge.control.balance.odometry import Odometry
from nao_sim_bridge.model.kinematics import matrix_rpy, quaternion_matrix
from nao_sim_bridge.model.model_reader import load_model
from nao_sim_bridge.model.postures import posture

MODEL = load_model()
INIT = posture(MODEL, "StandInit")
LEAN = 0.1
"""rad; pitch of the torso when the feet are flat on the ground."""


@pytest.mark.parametrize("start", [0.0, 1.0, -2.5])
def test_it_begins_with_heading_zero_and_turns_as_the_inertial_unit_says(start):
    odometry = Odometry(MODEL, INIT, (0.0, LEAN, start))
    for turn in (0.0, 0.5):
        odometry.update(INIT, (0.0, LEAN, start + turn), (20.0, 20.0))
        assert matrix_rpy(quaternion_matrix(odometry.torso.orientation))[2] == pytest.approx(turn, abs=1e-6)


def test_a_foot_that_is_pressed_from_above_hands_over_to_none_in_the_air():
    odometry = Odometry(MODEL, INIT, (0.0, LEAN, 0.0))
    on_the_left = [*INIT]
    on_the_left[MODEL.joint_index["RKneePitch"]] += 0.6
    before = odometry.update(on_the_left, (0.0, LEAN, 0.0), (40.0, 0.0))
    for _ in range(2):  # the foot that takes over is on the ground from the next time on
        now = odometry.update(on_the_left, (0.0, LEAN, 0.0), (-5.0, 0.0))
    assert now.position == pytest.approx(before.position)


def test_the_torso_goes_on_while_a_landing_bounces_and_holds_where_nothing_carries():
    odometry, angles = Odometry(MODEL, INIT, (0.0, LEAN, 0.0)), [*INIT]

    def gone(loads, swing):
        """How far ahead it goes in a tick in which the leg that carries swings so far, m."""
        before = odometry.torso.position
        for joint in ("LHipPitch", "LAnklePitch"):
            angles[MODEL.joint_index[joint]] += swing if joint == "LHipPitch" else -swing
        return odometry.update(angles, (0.0, LEAN, 0.0), loads).position[0] - before[0]

    over_the_foot = [gone((40.0, 0.0), 0.004) for _ in range(8)][-1]
    assert over_the_foot > 0.0004
    assert [gone((0.0, 0.0), 0.0) for _ in range(3)] == pytest.approx([over_the_foot] * 3, rel=0.05)
    assert [gone((0.0, 0.0), 0.0) for _ in range(20)][-1] == pytest.approx(0.0, abs=1e-9)
