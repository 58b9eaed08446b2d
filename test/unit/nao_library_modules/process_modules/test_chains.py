"""Chains of joints: where the hand is, and how it gets to a point."""

from __future__ import annotations

import random
from pathlib import Path

import numpy as np
import pytest

from nao_library_modules.process_modules.chains import Chain
from naoqi.errors import NaoError

URDF = (Path(__file__).parents[4] / "nao_sim_bridge" / "urdf" / "nao_h25.urdf").read_text(encoding="utf-8")
REST = {"left": [1.4, 0.2, -1.0, -1.0, 0.0], "right": [1.4, -0.2, 1.0, 1.0, 0.0]}


@pytest.fixture(params=["left", "right"])
def arm(request):
    side = request.param
    chain = Chain(URDF, "torso", f"{side[0]}_gripper")
    chain.side, chain.rest = side, REST[side]
    return chain


def test_the_hand_is_where_the_tables_say_with_all_joints_at_zero(arm):
    sign = 1.0 if arm.side == "left" else -1.0
    assert arm.joints == tuple(
        f"{arm.side[0].upper()}{name}"
        for name in ("ShoulderPitch", "ShoulderRoll", "ElbowYaw", "ElbowRoll", "WristYaw")
    )
    assert arm.tip([0.0] * 5)[:3, 3] == pytest.approx((0.2187, sign * 0.113, 0.08769), abs=2e-4)


def test_points_that_the_arm_can_reach_are_reached_within_the_limits(arm):
    generator = random.Random(1)
    for _ in range(60):
        angles = [generator.uniform(low + 0.05, high - 0.05) for low, high in zip(arm.lower, arm.upper)]
        target = arm.tip(angles)[:3, 3]
        found = arm.reach(target, arm.rest)
        assert found.distance < 0.002, (target, found)
        listed = [found.angles[name] for name in arm.joints]
        assert arm.tip(listed)[:3, 3] == pytest.approx(target, abs=0.002)
        assert np.all(listed >= arm.lower) and np.all(listed <= arm.upper)


def test_a_point_too_far_away_is_answered_with_the_nearest_one(arm):
    shoulder = np.array((0.0, 0.098 if arm.side == "left" else -0.098, 0.1))
    target = np.array((1.0, shoulder[1], 0.1))
    found = arm.reach(target, arm.rest)
    assert found.distance == pytest.approx(float(np.linalg.norm(target - found.point)), abs=1e-6)
    # With the arm straight ahead the hand is a little more than 0.2 m from the shoulder.
    assert np.linalg.norm(np.array(found.point) - shoulder) > 0.215
    assert found.distance < 0.79


def test_a_point_that_is_reached_already_changes_nothing(arm):
    found = arm.reach(arm.tip(arm.rest)[:3, 3], arm.rest)
    assert [found.angles[name] for name in arm.joints] == pytest.approx(arm.rest, abs=1e-6)


def test_angles_may_have_names(arm):
    named = dict(zip(arm.joints, arm.rest), HeadYaw=0.5)
    assert arm.tip(named) == pytest.approx(arm.tip(arm.rest))
    del named[arm.joints[2]]
    with pytest.raises(NaoError, match=f"no angle of {arm.joints[2]} is known"):
        arm.tip(named)


def test_what_is_no_chain_is_told():
    with pytest.raises(NaoError, match="no chain from torso to tail: it ends at tail"):
        Chain(URDF, "torso", "tail")
    with pytest.raises(NaoError, match="is no XML"):
        Chain("<robot", "torso", "Head")
