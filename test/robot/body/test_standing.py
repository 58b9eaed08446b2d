"""What is true of a real NAO on its feet: it stands, weighs what it weighs, and moves as its motors can."""

import math

import pytest

from nao_sim_bridge.control.balance.fall_manager import FallState
from nao_sim_bridge.control.balance.posture_recognition import recognise
from nao_sim_bridge.core import sequences
from nao_sim_bridge.model.model_reader import load_model
from nao_sim_bridge.model.postures import load_postures

MODEL = load_model()
FAMILY = {name: entry.family for name, entry in load_postures().by_name.items()}
OFF_THE_FEET = ("Sit", "SitRelax", "LyingBelly", "LyingBack")
G, LONG = 9.81, 20.0
# A motor's sum of torques is exact, its solver is iterative.
SLACK = 1e-6


def loads(snapshot):
    return snapshot.left_foot.total, snapshot.right_foot.total


def tilt(snapshot):
    """Largest of roll and pitch of the torso, rad."""
    return max(abs(angle) for angle in snapshot.imu.angles[:2])


def test_it_stands_for_twenty_seconds_within_a_millimetre(bench):
    one = bench()
    start, settled, end = one.now, one.run(1.0), one.run(LONG)
    assert end.time == pytest.approx(LONG + 1.0)
    assert math.dist(start.torso.position, settled.torso.position) < 2e-3, "putting it down is no fall"
    assert math.dist(settled.torso.position, end.torso.position) < 1e-3
    assert abs(settled.imu.angles[2] - end.imu.angles[2]) < math.radians(0.1) and tilt(end) < math.radians(1.0)
    for snapshot in (settled, end):
        assert math.hypot(*snapshot.imu.accelerometer) == pytest.approx(9.81, rel=1e-3)
        assert snapshot.imu.accelerometer[2] == pytest.approx(9.81, rel=1e-3)
        assert snapshot.imu.gyroscope == pytest.approx((0.0, 0.0, 0.0), abs=1e-3)
    left, right = loads(end)
    assert left + right == pytest.approx(5.36 * G, rel=0.01) and left == pytest.approx(right, rel=0.1)
    assert end.foot_loads == pytest.approx((left, right), rel=0.01)
    for foot in (end.left_foot, end.right_foot):
        assert sum(foot.forces) == pytest.approx(foot.total)
        # The centre of pressure of somebody who stands is under the ankle, well within the sole.
        assert -0.03 < foot.center_of_pressure[0] < 0.07 and abs(foot.center_of_pressure[1]) < 0.03
    assert max(abs(a - b) for a, b in zip(end.positions, end.commands)) < math.radians(0.5)
    assert len(end.link_poses) == 2 and end.touched == frozenset(), "nothing but the soles touches anything"


@pytest.mark.parametrize("version, mass", [("V6", 5.35975), ("V5", 5.30535)])
def test_it_weighs_the_published_mass_and_its_payload_also_after_a_reset(bench, version, mass):
    one = bench(version=version)
    assert (one.model.total_mass, one.simulation.led_layout.version) == (pytest.approx(mass), version)
    assert sum(loads(one.run(1.0))) == pytest.approx(mass * G, rel=0.01)
    one = bench(version=version, payload=1.0)
    for _ in range(2):
        one.stiffen(1.0)
        assert sum(loads(one.run(1.0))) == pytest.approx((mass + 1.0) * G, rel=0.01)
        one.simulation.reset()


def test_feet_hold_below_the_friction_and_slide_above(bench):
    def slide(force, **scene):
        """How far the first foot slides when both are pushed forward with this share of the weight, m."""
        one = bench(**scene)
        foot = min(contact.link for contact in one.run(1.0).contacts)
        before = one.now.link_poses[foot].position[0]
        for ankle in ("l_ankle", "r_ankle"):
            one.push((force * one.model.total_mass * G / 2, 0.0, 0.0), 0.25, ankle)
        return one.run(0.25).link_poses[foot].position[0] - before

    assert abs(slide(0.25, friction=0.4)) < 2e-3 and slide(0.55, friction=0.4) > 5e-3 and abs(slide(0.55)) < 2e-3


def lean(one, roll):
    """Shift the body sideways over the feet; a positive roll goes to the left."""
    joints = ("LHipRoll", "RHipRoll", "LAnkleRoll", "RAnkleRoll")
    shift = {name: one.joint(name, of="commands") + (roll if "Ankle" in name else -roll) for name in joints}
    one.aim(0.5, **shift)
    return one.run(1.5)


def test_leaning_to_a_side_loads_that_foot_until_it_carries_everything(bench):
    for roll in (0.05, -0.05):
        one = bench()
        one.run(0.5)
        left, right = loads(lean(one, roll))
        heavy, light = (left, right) if roll > 0.0 else (right, left)
        assert heavy > 1.5 * light and heavy + light == pytest.approx(5.36 * G, rel=0.02)
    one = bench()
    one.run(0.5)
    lean(one, 0.38)
    one.aim(1.0, RKneePitch=0.6, RHipPitch=-0.3, RAnklePitch=-0.3)
    end = one.run(2.5)
    assert (end.right_foot.forces, end.right_foot.center_of_pressure) == ((0.0,) * 4, (0.0, 0.0))
    assert end.left_foot.total == pytest.approx(5.36 * G, rel=0.02) and tilt(end) < math.radians(5.0)
    assert one.robot.stability.falls.state is FallState.WATCHING, "standing on one foot is no fall"


@pytest.mark.parametrize("name", FAMILY)
def test_a_stiff_robot_stays_in_the_posture_it_starts_in_and_a_limp_one_in_its_family(bench, name):
    one = bench(name)
    start = one.watch(0.03)
    assert start[-1].contacts and max(tick.linear_velocity[2] for tick in start) < 0.1
    assert all(tick.torso.position[2] == pytest.approx(start[0].torso.position[2], abs=0.01) for tick in start)
    one.run(2.0)
    seen = recognise(one.model, one.now)
    assert (seen.posture, seen.family) == (name, FAMILY[name])
    assert one.robot.stability.on_feet == (name not in OFF_THE_FEET)
    limp = bench(name, stiffness=0.0)
    height, settled, end = limp.now.torso.position[2], limp.run(1.5), limp.run(1.0)
    if name in ("Sit", "SitRelax", "LyingBelly", "LyingBack", "Crouch"):  # what stands upright slumps
        assert recognise(limp.model, end).family == FAMILY[name]
    if name == "StandInit":
        assert settled.torso.position[2] < height - 0.07, "with bent knees it collapses"
        assert limp.robot.stability.falls.state is FallState.RESTING, "which is no fall"


@pytest.mark.parametrize("stiffness", [1.0, 0.5])
def test_no_motor_gives_more_than_its_torque_however_hard_the_task(bench, stiffness):
    def ratios(seen):
        return [max(abs(s.torques[i]) for s in seen) / joint.max_torque for i, joint in enumerate(MODEL.joints)]

    one, limp = bench("Stand", stiffness), bench("StandInit", 0.0)
    one.run(0.3)
    sequences.posture_task(one.robot, "hurry", "Crouch", duration=0.5)
    one.push((40.0, 0.0, 0.0), 0.5)
    # The limit was in the way, so it was tested.
    assert max(ratios(one.watch(1.5))) == pytest.approx(stiffness, abs=SLACK)
    motor = limp.simulation.settings.motor
    friction = max(motor.limp_friction, motor.limp_hip_pitch_friction)
    assert max(ratios(limp.watch(1.0))) <= friction + SLACK, "a limp joint has only the friction of its gears"


def test_no_motor_turns_faster_than_it_can_and_each_follows_its_command(bench):
    one = bench()
    one.run(0.3)
    targets = {"HeadYaw": -2.0, "LShoulderPitch": -1.0, "LElbowYaw": -2.0, "RWristYaw": 1.5, "LHand": 1.0}
    for name, target in targets.items():
        one.aim(MODEL.joint(name).max_velocity, **{name: target})
    seen = one.watch(0.8)
    for name, target in targets.items():
        index, top_speed = MODEL.joint_index[name], MODEL.joint(name).max_velocity
        # As fast as it can: the move was at the limit.
        assert 0.9 * top_speed <= max(abs(s.velocities[index]) for s in seen) <= 1.02 * top_speed, name
        assert seen[-1].positions[index] == pytest.approx(target, abs=0.02)


def hips(snapshot):
    return [snapshot.positions[MODEL.joint_index[name]] for name in ("LHipYawPitch", "RHipYawPitch")]


def test_both_hips_are_one_motor_for_commands_and_for_pulls(bench):
    for name in ("LHipYawPitch", "RHipYawPitch"):
        one = bench("Crouch")
        one.run(0.3)
        one.aim(1.0, **{name: -0.6})
        assert hips(one.run(0.8)) == pytest.approx([-0.6, -0.6], abs=0.01)
    one = bench("LyingBack", 0.0)
    one.run(0.5)
    one.push((0.0, 15.0, 25.0), 1.2, "l_ankle")  # lift one foot, and pull it outwards
    seen = [hips(snapshot) for snapshot in one.watch(1.2)]
    lefts = [left for left, _ in seen]
    assert max(lefts) - min(lefts) > 0.2 and max(abs(left - right) for left, right in seen) < 0.01
