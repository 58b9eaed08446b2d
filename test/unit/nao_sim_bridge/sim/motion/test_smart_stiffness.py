"""Smart stiffness: torque is limited in a static posture only, and what the posture needs is always there."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.motion.smart_stiffness import ALL, FACTOR, MOVED, SETTLING, SPARE, SmartStiffness

MODEL = load_model()
DT = 0.1
AT, TORQUES = (0.0, 0.0), (1.0, -0.2)


@pytest.fixture
def smart():
    return SmartStiffness([2.0, 1.0])


def settle(smart, positions=AT, seconds=SETTLING + DT):
    shares = ALL
    for _ in range(round(seconds / DT)):
        shares = smart.shares(False, positions, TORQUES, DT)
    return shares


def test_a_static_posture_gets_what_it_needs_and_some_to_spare(smart):
    assert settle(smart, seconds=SETTLING - DT) == ALL
    assert settle(smart) == pytest.approx((SPARE + FACTOR * 0.5, SPARE + FACTOR * 0.2))


def test_a_command_gives_all_back_at_once(smart):
    settle(smart)
    assert smart.shares(True, AT, TORQUES, DT) == ALL
    assert smart.shares(False, AT, TORQUES, DT) == ALL


def test_a_push_gives_all_back(smart):
    shares = settle(smart)
    assert smart.shares(False, (0.0, 0.9 * MOVED), TORQUES, DT) == shares
    assert smart.shares(False, (0.0, 1.1 * MOVED), TORQUES, DT) == ALL


def test_switched_off_it_limits_nothing(smart):
    smart.enabled = False
    assert settle(smart) == ALL
    smart.enabled = True
    assert settle(smart) != ALL


# --- under physics ----------------------------------------------------------------------------------------------------


def test_a_robot_that_keeps_still_stands_as_before_with_less_torque_to_give(bench):
    one = bench()
    one.run(0.9)
    assert one.robot.joints.efforts == one.robot.joints.stiffnesses
    before = one.run(0.05)
    after = one.run(4.0)
    efforts = one.robot.joints.efforts
    assert min(efforts) < 0.3 and max(efforts) < 1.0
    assert one.robot.joints.stiffnesses == (1.0,) * 26
    assert after.positions == pytest.approx(before.positions, abs=0.005)
    one.aim(HeadYaw=0.3)
    one.run(0.1)
    assert one.robot.joints.efforts == (1.0,) * 26


def test_a_lower_stiffness_of_the_caller_wins(bench):
    one = bench()
    one.stiffen(0.1, "HeadYaw")
    one.run(2.0)
    assert one.robot.joints.efforts[MODEL.joint_index["HeadYaw"]] == 0.1


@pytest.mark.parametrize("name, angle", [("LShoulderPitch", 0.0), ("RElbowRoll", 1.2), ("HeadPitch", 0.4)])
def test_a_joint_in_the_air_stays_within_half_a_degree_of_its_target(bench, name, angle):
    one = bench()
    one.aim(**{"RShoulderPitch": 0.5, name: angle})
    one.run(4.0)
    assert max(one.robot.joints.efforts) < 1.0
    assert one.joint(name) == pytest.approx(angle, abs=0.0087)
