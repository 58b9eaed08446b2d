"""What heat, battery and ground decide about motions: pure."""

from __future__ import annotations

import pytest
from fake_robot import FakeRobot

from nao_library_modules.body_devices import CHARGE, CURRENT, PREFIX
from nao_library_modules.body_devices import FOOT_CONTACT as CONTACT
from nao_library_modules.errors import CannotWalk, NotFit
from nao_library_modules.motion_health import Health, HealthAccess, in_chain

KNEE = "LKneePitch"


def warm(celsius, **rest):
    return Health({KNEE: celsius, "HeadYaw": 30.0}, **rest)


def test_a_cool_joint_is_fit_and_a_hot_one_is_slow_and_a_very_hot_one_is_refused():
    assert warm(67.9).careful([KNEE], 1.0) == 1.0
    assert warm(68.0).careful([KNEE], 1.0) == 0.5
    assert warm(68.0).careful([KNEE], 0.2) == 0.2
    warm(73.9).require_fit([KNEE])
    with pytest.raises(NotFit, match="too hot to move: LKneePitch 74 degC: rest until they are below 74 degC"):
        warm(74.0).require_fit([KNEE, "HeadYaw"])


def test_a_hot_knee_is_nothing_to_the_head():
    warm(90.0).require_fit(["HeadYaw"])
    assert warm(90.0).careful(["HeadYaw"], 1.0) == 1.0


@pytest.mark.parametrize("charge, charging, fit", [(0.02, False, False), (0.03, False, True), (0.0, True, True)])
def test_an_empty_battery_moves_nothing_until_it_is_charged(charge, charging, fit):
    health = Health(charge=charge, charging=charging)
    if fit:
        health.require_fit([KNEE])
    else:
        with pytest.raises(NotFit, match=r"the battery is empty \(2% left\): plug the charger in"):
            health.require_fit([KNEE])


def test_a_low_battery_is_enough_to_move_and_too_low_to_walk():
    health = Health(charge=0.04)
    health.require_fit([KNEE])
    with pytest.raises(CannotWalk, match=r"the battery is too low to walk \(4% left\): plug the charger in"):
        health.require_walk([KNEE], moved=False)
    Health(charge=0.06).require_walk([KNEE], moved=False)


def test_nobody_walks_in_the_air():
    with pytest.raises(CannotWalk, match="no foot touches the ground: put the robot on its feet first"):
        Health(on_ground=False).require_walk([KNEE], moved=False)
    Health(on_ground=True).require_walk([KNEE], moved=False)
    Health(on_ground=False).require_walk([KNEE], moved=True)  # it is put on its feet before


def test_a_robot_that_tells_nothing_is_fit():
    Health().require_walk([KNEE], moved=False)
    assert Health().careful([KNEE], 1.0) == 1.0


@pytest.fixture
def read():
    robot = FakeRobot()
    robot.memory.data.update(
        {
            CHARGE: 0.5,
            CURRENT: -1.5,
            CONTACT: 1.0,
            f"{PREFIX}HeadYaw/Temperature/Sensor/Value": 41.0,
        }
    )
    access = HealthAccess(robot, lambda _, method, *arguments: getattr(robot.memory, method)(*arguments))
    return robot, lambda: access.read(["HeadYaw", "RHipYawPitch"])


def test_health_comes_from_memory(read):
    robot, health = read
    assert health() == Health({"HeadYaw": 41.0}, 0.5, False, True)
    robot.memory.data.update({CURRENT: 0.8, CONTACT: 0.0})
    assert health() == Health({"HeadYaw": 41.0}, 0.5, True, False)


@pytest.mark.parametrize(
    "joint, chain, inside",
    [
        ("HeadYaw", "Head", True),
        ("LHand", "LArm", True),
        ("LHand", "RArm", False),
        ("LHipRoll", "LArm", False),
        ("LHipRoll", "LLeg", True),
        ("RAnklePitch", "LLeg", False),
        ("RElbowYaw", "RArm", True),
        ("RElbowYaw", "Body", True),
        ("LHipRoll", "Head", False),
    ],
)
def test_chains_of_the_protection(joint, chain, inside):
    assert in_chain(joint, chain) is inside
