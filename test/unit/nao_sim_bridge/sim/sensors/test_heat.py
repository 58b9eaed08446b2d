"""Hot motors: their status, and the torque they have left."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.sensors.heat import HOT, heat_shares, heat_status

MODEL = load_model()


@pytest.mark.parametrize("celsius, status", [(20.0, 0), (67.9, 0), (68.0, 1), (74.0, 2), (80.0, 3), (200.0, 3)])
def test_status_of_a_motor(celsius, status):
    assert heat_status(celsius) == status


def test_cold_motors_have_all_their_torque():
    assert heat_shares([30.0, HOT[0] + 1.0]) == ()


def test_a_very_hot_motor_loses_a_third_and_a_critical_one_everything():
    shares = heat_shares([30.0, HOT[0], HOT[1], HOT[2]])
    assert shares[:2] == (1.0, 1.0) and shares[3] == 0.0
    assert 0.0 < shares[2] < 0.7


# --- under physics ----------------------------------------------------------------------------------------------------


def test_a_motor_that_gets_critically_hot_goes_limp(bench):
    one = bench()
    one.robot.reflexes.diagnosis_enabled = False
    one.aim(2.0, LShoulderPitch=0.0)
    held = one.run(1.5).positions[MODEL.joint_index["LShoulderPitch"]]
    one.robot.warm_up("LShoulderPitch", 85.0)
    one.run(1.5)
    assert one.joint("LShoulderPitch") > held + 0.2
    assert one.robot.joints.stiffnesses[MODEL.joint_index["LShoulderPitch"]] == 1.0


def test_a_motor_cools_down_again(bench):
    one = bench()
    one.robot.warm_up("HeadYaw", 75.0)
    assert one.run(0.2).temperatures[0] > 74.0
    assert one.robot.joints.efforts[0] < 0.7
    one.run(6.0)
    assert one.now.temperatures[0] < 74.0


def test_a_joint_that_is_none_has_no_motor(bench):
    with pytest.raises(RuntimeError, match="unknown joint 'Tail'"):
        bench().robot.warm_up("Tail", 50.0)
