"""Broken devices: what can break, how bad it is, and what it does."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim.errors import UnknownName
from nao_sim_bridge.sim.faults import CRITICAL, NEGLIGIBLE, SERIOUS, severity
from nao_sim_bridge.sim.model import load_model

MODEL = load_model()
HEAD_YAW = MODEL.joint_index["HeadYaw"]


@pytest.mark.parametrize(
    "device, how",
    [
        ("LHipYawPitch", CRITICAL),
        ("RAnkleRoll", CRITICAL),
        ("HeadYaw", SERIOUS),
        ("LHand", SERIOUS),
        ("InertialSensor", SERIOUS),
        ("LFoot/FSR/RearLeft", SERIOUS),
        ("US/Left", NEGLIGIBLE),
        ("Head/Touch/Rear", NEGLIGIBLE),
        ("LFoot/Bumper/Left", NEGLIGIBLE),
        ("ChestBoard/Button", NEGLIGIBLE),
    ],
)
def test_how_bad_it_is(device, how):
    assert severity(device) == how


def test_a_broken_motor_gives_no_torque_until_it_is_repaired(bench):
    one = bench()
    one.robot.faults.break_device("HeadYaw")
    one.aim(3.0, HeadYaw=0.8)
    one.run(1.0)
    assert one.joint("HeadYaw") == pytest.approx(0.0, abs=0.02)
    assert one.robot.joints.efforts[HEAD_YAW] == 0.0
    one.robot.faults.repair("HeadYaw")
    one.run(1.0)
    assert one.joint("HeadYaw") == pytest.approx(0.8, abs=0.02)


def test_only_stiff_motors_are_found(bench):
    faults = bench().robot.faults
    faults.break_device("HeadYaw")
    faults.try_motors([0.0] * 26)
    assert faults.found == frozenset()
    faults.try_motors([1.0] * 26)
    assert faults.found == {HEAD_YAW}
    faults.repair("HeadYaw")
    assert faults.found == frozenset()


def test_a_broken_sonar_reads_an_error(bench):
    one = bench()
    one.robot.faults.break_device("US/Right")
    one.run(0.2)
    assert one.now.sonars[1] == 0.0
    assert one.now.currents  # what else the sensors tell is there


def test_a_foot_with_a_broken_corner_weighs_less(bench):
    one = bench()
    one.run(0.5)
    whole = one.now.right_foot
    one.robot.faults.break_device("RFoot/FSR/RearLeft")
    one.run(0.1)
    assert one.now.right_foot.forces[2] == 0.0
    assert one.now.right_foot.total == pytest.approx(whole.total - whole.forces[2], rel=0.05)
    assert one.now.left_foot.total > 5.0


def test_a_new_robot_is_whole(bench):
    one = bench()
    one.robot.faults.break_device("InertialSensor")
    one.robot.faults.break_device("LKneePitch")
    one.simulation.reset()
    assert (one.robot.faults.sensors, one.robot.faults.motors) == (frozenset(), frozenset())


@pytest.mark.parametrize("method", ["break_device", "repair"])
def test_an_unknown_device_is_named(bench, method):
    with pytest.raises(UnknownName, match="unknown device 'US/Middle'"):
        getattr(bench().robot.faults, method)("US/Middle")


def test_shots_of_sonars_that_work_are_told_apart_whatever_else_is_broken(bench):
    one = bench()
    one.robot.faults.break_device("Head/Touch/Rear")
    seen = one.watch(0.3)
    assert len({id(now.sonars) for now in seen}) == len({id(now.echoes) for now in seen}) in (3, 4)
