"""What ALMotion tells about the body."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim.model import load_model

MODEL = load_model()


@pytest.fixture
def motion(shared_robot):
    return shared_robot.ALMotion


@pytest.mark.parametrize(
    "name, expected",
    [
        ("Head", ["HeadYaw", "HeadPitch"]),
        ("HeadYaw", ["HeadYaw"]),
        ("Body", [joint.name for joint in MODEL.joints]),
        ("Joints", list(MODEL.chains["Joints"])),
        ("Legs", [*MODEL.chains["LLeg"], *MODEL.chains["RLeg"]]),
        ("Chains", ["Head", "LArm", "LLeg", "RLeg", "RArm"]),
    ],
)
def test_names_of_the_body(motion, name, expected):
    assert motion.getBodyNames(name) == motion.getJointNames(name) == expected


def test_an_unknown_part_offers_the_closest(motion):
    with pytest.raises(RuntimeError, match="ALMotion::getBodyNames unknown joint or chain 'Hed': did you mean 'Head'"):
        motion.getBodyNames("Hed")


def test_limits_are_those_of_the_tables(motion):
    joint = MODEL.joint("LElbowRoll")
    expected = [joint.lower, joint.upper, joint.max_velocity, joint.max_torque]
    assert motion.getLimits("LElbowRoll") == [pytest.approx(expected)]
    assert len(motion.getLimits("Body")) == 26


def test_the_cycle_is_the_tick(shared_robot):
    tick_ms = 1000 * shared_robot.server.simulation.settings.tick_s
    assert shared_robot.ALMotion.getMotionCycleTime() == pytest.approx(tick_ms, abs=0.5)


def test_the_configuration_is_a_nao_h25_v6(motion):
    names, values = motion.getRobotConfig()
    config = dict(zip(names, values))
    assert config["Model Type"] == "naoH25"
    assert config["Head Version"] == config["Body Version"] == "VERSION_60"
    assert (config["Number of Legs"], config["Number of Hands"]) == (2, 2)


def test_the_summary_has_a_line_for_each_joint(robot):
    robot.ALMotion.setStiffnesses("HeadYaw", 0.5)
    robot.finish("ALMotion", "angleInterpolation", "HeadYaw", 0.25, 0.5, True, after=1.0)
    table = robot.ALMotion.getSummary()
    (line,) = [line for line in table.splitlines() if line.split()[:1] == ["HeadYaw"]]
    stiffness, command, sensor = map(float, line.split()[1:])
    assert (stiffness, command) == (0.5, 0.25)
    assert sensor == pytest.approx(0.25, abs=0.01)
    assert all(joint.name in table for joint in MODEL.joints)
