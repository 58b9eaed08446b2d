"""What motors lose as heat and draw from the battery."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.sensors.motors import Motors, motor_of
from nao_sim_bridge.sim.settings import load_settings

MODEL, SETTINGS = load_model(), load_settings()
STILL, STIFF, LIMP = [0.0] * 26, [1.0] * 26, [0.0] * 26
KNEE = MODEL.joint_index["LKneePitch"]


@pytest.fixture
def motors():
    return Motors(MODEL, SETTINGS)


def one(joint, value):
    return [value if index == joint else 0.0 for index in range(26)]


def test_a_stalled_motor_takes_battery_voltage_times_its_current(motors):
    motor, ratio = motor_of(MODEL, "LKneePitch")
    torque = motor.stall_torque * ratio * SETTINGS.motor.gear_efficiency
    (amps,) = motors.currents(one(KNEE, torque))[KNEE : KNEE + 1]
    work = motors.work(one(KNEE, torque), STILL, STIFF)
    assert work.losses[KNEE] == pytest.approx(SETTINGS.battery.voltage_v * amps)
    assert work.drawn == pytest.approx(sum(work.losses))


def test_twice_the_torque_makes_four_times_the_heat(motors):
    single, double = (motors.work(one(KNEE, t), STILL, STIFF).losses[KNEE] for t in (0.5, 1.0))
    assert double == pytest.approx(4.0 * single)


def test_lifting_draws_more_than_holding_and_lowering_gives_nothing_back(motors):
    torques = one(KNEE, 1.0)
    lifting, holding, lowering = (motors.work(torques, one(KNEE, v), STIFF).drawn for v in (2.0, 0.0, -2.0))
    assert lifting == pytest.approx(holding + 2.0 / SETTINGS.motor.gear_efficiency)
    assert lowering == 0.0


def test_a_limp_motor_neither_draws_nor_warms(motors):
    work = motors.work([1.0] * 26, [1.0] * 26, LIMP)
    assert (work.drawn, work.stiff, set(work.losses)) == (0.0, 0, {0.0})
    assert motors.work(STILL, STILL, STIFF).stiff == 26


def test_legs_have_the_big_motors(motors):
    big = {joint.name for joint, heat in zip(MODEL.joints, motors.heat_capacities) if heat > 20.0}
    assert big == {joint for leg in ("LLeg", "RLeg") for joint in MODEL.chains[leg]}


def test_nothing_drives_a_tail():
    with pytest.raises(KeyError, match="Tail"):
        motor_of(MODEL, "Tail")
