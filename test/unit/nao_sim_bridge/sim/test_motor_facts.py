"""What motors can and cannot: torque, speed, stiffness, and the two hips on one of them."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.motion import sequences

MODEL = load_model()
LIMITS = [joint.max_torque for joint in MODEL.joints]
# A motor's sum of torques is exact, its solver is iterative.
SLACK = 1e-6


def torque_ratios(snapshots):
    """Largest torque of each joint as a share of its limit."""
    return [max(abs(s.torques[i]) for s in snapshots) / limit for i, limit in enumerate(LIMITS)]


@pytest.mark.parametrize("stiffness", [1.0, 0.5])
def test_no_motor_gives_more_than_its_torque_however_hard_the_task(bench, stiffness):
    one = bench("Stand", stiffness)
    one.run(0.3)
    sequences.posture_task(one.robot, "hurry", "Crouch", duration=0.5)
    one.push((40.0, 0.0, 0.0), 0.5)
    ratios = torque_ratios(one.watch(1.5))
    assert max(ratios) <= stiffness + SLACK
    # The limit was in the way, so it was tested.
    assert max(ratios) >= stiffness - SLACK


def test_a_limp_joint_gives_only_the_friction_of_its_gears(bench):
    one = bench("StandInit", 0.0)
    friction = one.simulation.settings.motor.limp_friction
    assert max(torque_ratios(one.watch(1.0))) <= friction + SLACK


def test_stiffness_decides_on_what_a_motor_can_hold(bench):
    one = bench()
    one.aim(2.0, LShoulderPitch=0.0)
    held = one.run(1.5).positions[MODEL.joint_index["LShoulderPitch"]]
    needed = abs(one.joint("LShoulderPitch", of="torques"))
    too_little = 0.5 * needed / MODEL.joint("LShoulderPitch").max_torque
    one.stiffen(too_little, "LShoulderPitch")
    one.run(1.0)
    assert one.joint("LShoulderPitch") > held + 0.2


@pytest.mark.parametrize(
    "name, target",
    [("HeadYaw", -2.0), ("LShoulderPitch", -1.0), ("LElbowYaw", -2.0), ("RWristYaw", 1.5), ("LHand", 1.0)],
)
def test_no_motor_turns_faster_than_it_can(bench, name, target):
    one = bench()
    one.run(0.3)
    top_speed = MODEL.joint(name).max_velocity
    one.aim(top_speed, **{name: target})
    seen = one.watch(0.8)
    index = MODEL.joint_index[name]
    assert max(abs(s.velocities[index]) for s in seen) <= 1.02 * top_speed
    # As fast as that, though: the move was at the limit.
    assert max(abs(s.velocities[index]) for s in seen) >= 0.9 * top_speed
    assert seen[-1].positions[index] == pytest.approx(target, abs=0.02)


def test_a_joint_follows_its_command_closely_through_a_motion(bench):
    one = bench()
    one.run(0.3)
    one.aim(1.0, HeadYaw=1.0, LElbowRoll=-1.2, RShoulderRoll=-0.6)
    for name in ("HeadYaw", "LElbowRoll", "RShoulderRoll"):
        index = MODEL.joint_index[name]
        assert max(abs(s.positions[index] - s.commands[index]) for s in one.watch(0.2)) < 0.01


def test_a_hand_opens_and_closes(bench):
    one = bench()
    for opening in (1.0, 0.0):
        one.aim(5.0, LHand=opening, RHand=opening)
        one.run(0.6)
        assert (one.joint("LHand"), one.joint("RHand")) == pytest.approx((opening, opening), abs=0.02)


# --- both HipYawPitch -------------------------------------------------------------------------------------------------


def hips(snapshot):
    return [snapshot.positions[MODEL.joint_index[name]] for name in ("LHipYawPitch", "RHipYawPitch")]


def test_both_hips_move_when_one_leg_is_pulled(bench):
    one = bench()
    one.push((-60.0, 0.0, 0.0), 0.2)
    one.run(2.0)
    one.stiffen(0.0)
    one.run(0.5)
    # On its back and limp: lift one foot, and pull it outwards.
    one.push((0.0, 15.0, 25.0), 1.2, "l_ankle")
    seen = [hips(snapshot) for snapshot in one.watch(1.2)]
    lefts = [left for left, _ in seen]
    assert max(lefts) - min(lefts) > 0.2
    assert max(abs(left - right) for left, right in seen) < 0.01


@pytest.mark.parametrize("name", ["LHipYawPitch", "RHipYawPitch"])
def test_a_command_to_either_hip_moves_both(bench, name):
    one = bench("Crouch")
    one.run(0.3)
    one.aim(1.0, **{name: -0.6})
    assert hips(one.run(0.8)) == pytest.approx([-0.6, -0.6], abs=0.01)
