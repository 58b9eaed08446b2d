"""ALMotion's collision protection over the network."""

from __future__ import annotations

import pytest

ARM = ["LShoulderPitch", "LShoulderRoll", "LElbowYaw", "LElbowRoll"]
# The left forearm across, and into, the chest.
CHEST = [0.8, -0.3, -0.3, -1.5]


def into_the_chest(robot):
    robot.finish("ALMotion", "angleInterpolation", ARM, [[angle] for angle in CHEST], 1.0, True, after=1.1)
    return robot.ALMotion.getAngles("LElbowRoll", False)[0]


def test_an_arm_stops_short_of_the_chest_and_says_that_it_is_near(stiff_robot):
    motion = stiff_robot.ALMotion
    assert motion.isCollision("Arms") == "none"
    assert into_the_chest(stiff_robot) > CHEST[-1] + 0.1
    assert (motion.isCollision("LArm"), motion.isCollision("RArm"), motion.isCollision("Arms")) == (
        "near",
        "none",
        "near",
    )


def test_without_protection_it_goes_on_and_that_is_a_collision(stiff_robot):
    motion = stiff_robot.ALMotion
    assert motion.getCollisionProtectionEnabled("Arms")
    assert motion.setCollisionProtectionEnabled("LArm", False)
    assert not motion.getCollisionProtectionEnabled("LArm")
    assert not motion.getCollisionProtectionEnabled("Arms")
    assert motion.getCollisionProtectionEnabled("RArm")
    assert into_the_chest(stiff_robot) == pytest.approx(CHEST[-1])
    assert motion.isCollision("Arms") == "collision"
    # Where it is, it has protection or not; it cannot lose it.
    assert motion.setCollisionProtectionEnabled("LArm", True)
    assert motion.setCollisionProtectionEnabled("Arms", False) is False
    assert motion.getCollisionProtectionEnabled("LArm")


@pytest.mark.parametrize("method", ["isCollision", "getCollisionProtectionEnabled"])
def test_only_arms_have_it(robot, method):
    with pytest.raises(RuntimeError, match="unknown arm or group 'LLeg'"):
        robot.ALMotion.call(method, "LLeg")


def test_parts_of_the_external_protection(robot):
    motion = robot.ALMotion
    assert motion.getExternalCollisionProtectionEnabled("All")
    motion.setExternalCollisionProtectionEnabled("Move", False)
    assert not motion.getExternalCollisionProtectionEnabled("All")
    assert not motion.getExternalCollisionProtectionEnabled("Move")
    assert motion.getExternalCollisionProtectionEnabled("Arms")
    motion.setExternalCollisionProtectionEnabled("All", True)
    assert motion.getExternalCollisionProtectionEnabled("Move")


def test_security_distances_have_defaults_and_are_never_negative(robot):
    motion = robot.ALMotion
    assert motion.getOrthogonalSecurityDistance() == pytest.approx(0.4)
    assert motion.getTangentialSecurityDistance() == pytest.approx(0.1)
    motion.setOrthogonalSecurityDistance(0.25)
    motion.setTangentialSecurityDistance(-1.0)
    assert motion.getOrthogonalSecurityDistance() == pytest.approx(0.25)
    assert motion.getTangentialSecurityDistance() == 0.0


def test_with_nothing_in_front_there_is_no_obstacle(robot):
    robot.advance(0.2)
    assert robot.ALMotion.getChainClosestObstaclePosition("LArm", 0) == []
    with pytest.raises(RuntimeError, match="unknown arm"):
        robot.ALMotion.getChainClosestObstaclePosition("Head", 0)
