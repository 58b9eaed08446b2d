"""What is true of a real NAO on its feet: it stands, weighs what it weighs, and falls when it must."""

from __future__ import annotations

import math

import pybullet
import pytest

from nao_sim_bridge.sim import led_animations
from nao_sim_bridge.sim.simulation import Scene, Simulation
from nao_sim_bridge.sim.snapshot import Snapshot

WEIGHT = 5.36 * 9.81
MINUTE = 60.0


@pytest.fixture(scope="module")
def standing():
    """Snapshots of a robot that stands for a minute: as put there, settled, and at the end."""
    simulation = Simulation(Scene(posture="Stand"))
    simulation.robot.motion.set_stiffness_now({i: 1.0 for i in range(26)})
    seen = [simulation.snapshot, simulation.run(1.0), simulation.run(MINUTE)]
    simulation.close()
    return seen


def loads(snapshot: Snapshot) -> tuple[float, float]:
    return snapshot.left_foot.total, snapshot.right_foot.total


def tilt(snapshot: Snapshot) -> float:
    """Largest of roll and pitch of the torso, rad."""
    return max(abs(angle) for angle in snapshot.imu.angles[:2])


# --- standing ---------------------------------------------------------------------------------------------------------


def test_it_stands_for_a_minute_within_a_millimetre(standing):
    _, settled, end = standing
    assert end.time == pytest.approx(MINUTE + 1.0)
    assert math.dist(settled.torso.position, end.torso.position) < 1e-3
    assert abs(settled.imu.angles[2] - end.imu.angles[2]) < math.radians(0.1)
    assert tilt(end) < math.radians(1.0)


def test_putting_it_down_is_no_fall(standing):
    start, settled, _ = standing
    assert math.dist(start.torso.position, settled.torso.position) < 2e-3


def test_at_rest_the_accelerometer_feels_gravity_and_the_gyroscope_nothing(standing):
    for snapshot in standing[1:]:
        x, y, z = snapshot.imu.accelerometer
        assert math.sqrt(x * x + y * y + z * z) == pytest.approx(9.81, rel=1e-3)
        assert z == pytest.approx(9.81, rel=1e-3)
        assert snapshot.imu.gyroscope == pytest.approx((0.0, 0.0, 0.0), abs=1e-3)


def test_the_feet_carry_its_weight_evenly(standing):
    left, right = loads(standing[-1])
    assert left + right == pytest.approx(WEIGHT, rel=0.01)
    assert left == pytest.approx(right, rel=0.1)


def test_each_foot_shares_its_load_over_its_four_sensors(standing):
    for foot in (standing[-1].left_foot, standing[-1].right_foot):
        assert sum(foot.forces) == pytest.approx(foot.total)
        # The centre of pressure of somebody who stands is under the ankle, well within the sole.
        assert -0.03 < foot.center_of_pressure[0] < 0.07
        assert abs(foot.center_of_pressure[1]) < 0.03


def test_the_joints_are_where_they_were_told_to_be(standing):
    end = standing[-1]
    errors = [abs(a - b) for a, b in zip(end.positions, end.commands)]
    assert max(errors) < math.radians(0.5)


def test_standing_warms_the_motors_and_empties_the_battery_a_little(standing):
    _, settled, end = standing
    assert max(end.temperatures) > max(settled.temperatures) >= 27.0
    assert max(end.temperatures) < 40.0
    assert 0.95 < end.battery.charge < settled.battery.charge <= 1.0


def test_nothing_but_the_soles_touches_anything(standing):
    assert len(standing[-1].link_poses) == 2
    assert standing[-1].touched == frozenset()


@pytest.mark.parametrize("version, mass", [("V6", 5.35975), ("V5", 5.30535)])
def test_the_engine_weighs_the_published_mass(bench, version, mass):
    physics = bench(version=version).simulation._physics
    links = range(-1, pybullet.getNumJoints(physics.robot, physicsClientId=physics.client))
    masses = [pybullet.getDynamicsInfo(physics.robot, i, physicsClientId=physics.client)[0] for i in links]
    assert sum(masses) == pytest.approx(mass, abs=1e-5)
    feet = sum(loads(bench(version=version).run(1.0)))
    assert feet == pytest.approx(mass * 9.81, rel=0.01)


# --- leaning and lifting ----------------------------------------------------------------------------------------------


def lean(one, roll):
    """Shift the body sideways over the feet; a positive roll goes to the left."""
    joints = ("LHipRoll", "RHipRoll", "LAnkleRoll", "RAnkleRoll")
    shift = {name: one.joint(name, of="commands") + (roll if "Ankle" in name else -roll) for name in joints}
    one.aim(0.5, **shift)
    return one.run(1.5)


@pytest.mark.parametrize("roll", [0.05, -0.05])
def test_leaning_to_a_side_loads_that_foot(bench, roll):
    one = bench()
    one.run(0.5)
    snapshot = lean(one, roll)
    left, right = loads(snapshot)
    heavy, light = (left, right) if roll > 0.0 else (right, left)
    assert heavy > 1.5 * light
    assert heavy + light == pytest.approx(WEIGHT, rel=0.02)


def test_a_lifted_foot_carries_nothing_and_the_other_one_everything(bench):
    one = bench()
    one.run(0.5)
    lean(one, 0.38)
    one.aim(1.0, RKneePitch=0.6, RHipPitch=-0.3, RAnklePitch=-0.3)
    end = one.run(2.5)
    assert end.right_foot.forces == (0.0,) * 4
    assert end.right_foot.center_of_pressure == (0.0, 0.0)
    assert end.left_foot.total == pytest.approx(WEIGHT, rel=0.02)
    assert tilt(end) < math.radians(5.0)


# --- limp -------------------------------------------------------------------------------------------------------------


def test_a_raised_arm_falls_when_its_stiffness_is_gone(bench):
    one = bench()
    one.aim(2.0, LShoulderPitch=0.0)
    one.run(1.5)
    assert one.joint("LShoulderPitch") == pytest.approx(0.0, abs=0.02)
    one.stiffen(0.0, "LShoulderPitch")
    one.run(1.0)
    assert one.joint("LShoulderPitch") > 1.2
    assert one.joint("LShoulderPitch", of="velocities") == pytest.approx(0.0, abs=0.05)
    assert one.joint("RShoulderPitch") == pytest.approx(1.4426, abs=0.02)


def test_a_limp_robot_with_bent_knees_collapses(bench):
    one = bench("StandInit", 0.0)
    start = one.now.torso.position[2]
    assert one.run(1.5).torso.position[2] < start - 0.07


def test_a_crouching_robot_rests_without_stiffness(bench):
    one = bench("Crouch", 0.0)
    settled = one.run(1.0)
    end = one.run(3.0)
    assert math.dist(settled.torso.position, end.torso.position) < 1e-3
    assert tilt(end) < math.radians(10.0)
    assert sum(loads(end)) == pytest.approx(WEIGHT, rel=0.02)


# --- pushed -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("direction", [(1, 0), (-1, 0), (0, 1), (0, -1)])
def test_a_small_push_leaves_it_on_its_feet(bench, direction):
    one = bench()
    one.run(0.3)
    one.push((5.0 * direction[0], 5.0 * direction[1], 0.0), 0.2)
    assert tilt(one.run(1.5)) < math.radians(3.0)


@pytest.mark.parametrize("direction", [(1, 0), (-1, 0), (0, 1), (0, -1)])
def test_a_big_push_throws_it_over_that_way(bench, direction):
    one = bench()
    one.run(0.3)
    one.push((60.0 * direction[0], 60.0 * direction[1], 0.0), 0.2)
    end = one.run(2.0)
    assert end.torso.position[2] < 0.12
    assert tilt(end) > 1.0
    moved = [end.torso.position[axis] for axis in (0, 1)]
    assert moved[0] * direction[0] + moved[1] * direction[1] > 0.2


def test_a_fall_is_felt_by_the_inertial_unit(bench):
    one = bench()
    one.run(0.3)
    one.push((60.0, 0.0, 0.0), 0.2)
    seen = one.watch(1.5)
    assert max(snapshot.imu.gyroscope[1] for snapshot in seen) > 2.0
    assert max(math.hypot(*snapshot.imu.accelerometer) for snapshot in seen) > 20.0


def test_on_its_face_gravity_lies_along_another_axis(bench):
    one = bench()
    one.run(0.3)
    one.push((60.0, 0.0, 0.0), 0.2)
    one.run(2.0)
    one.stiffen(0.0)
    x, _, z = one.run(2.0).imu.accelerometer
    # What holds it up pushes towards its back.
    assert x == pytest.approx(-9.81, abs=0.5)
    assert abs(z) < 3.0


# --- lights -----------------------------------------------------------------------------------------------------------


def test_lights_do_not_disturb_the_body(bench):
    dark, bright = bench(), bench()
    layout = bright.simulation.led_layout
    bright.robot.leds.animate("eyes", led_animations.rasta(layout, 1.0), bright.robot.time, step=True)
    bright.robot.leds.set({0: 0.3})
    assert bright.watch(0.5) == dark.watch(0.5)
