"""Noise has the size that it should have, steps are steps, and what is late is whole."""

from __future__ import annotations

import random
from statistics import fmean, pstdev

import pytest

from nao_sim_bridge.sim.readings import Contact, JointReadings, Pose
from nao_sim_bridge.sim.rotations import roll_pitch_yaw
from nao_sim_bridge.sim.sensors.imperfection import Delay, Felt, Imperfection, Noise
from nao_sim_bridge.sim.sensors.noise_settings import load_noise
from nao_sim_bridge.sim.snapshot import Imu

DT = 1 / 120
LEFT, RIGHT, HAND = 3, 7, 12
SETTINGS = load_noise()
POSE = Pose((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
TRUTH = Felt(
    JointReadings((0.1, -0.2), (0.0, 0.5), (1.0, 2.0)),
    Imu((0.0, 0.0, 9.81), (0.0, 0.1, 0.0), (0.01, 0.02, 0.5)),
    tuple(Contact(link, (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 25.0) for link in (LEFT, RIGHT, HAND)),
    {LEFT: POSE, RIGHT: POSE, HAND: POSE},
)


def noise(scale=1.0, seed=0):
    return Noise(SETTINGS, scale, random.Random(seed), (LEFT, RIGHT), DT)


def spoilt(scale=1.0, count=4000, seed=0):
    source = noise(scale, seed)
    return [source.spoil(TRUTH) for _ in range(count)]


def test_the_same_seed_makes_the_same_errors_and_another_one_others():
    assert spoilt(count=5) == spoilt(count=5)
    assert spoilt(count=5) != spoilt(count=5, seed=1)


@pytest.mark.parametrize("scale", [0.5, 1.0])
def test_angles_of_joints_err_around_the_truth_as_far_as_they_should(scale):
    seen = [felt.joints.positions[1] for felt in spoilt(scale)]
    assert fmean(seen) == pytest.approx(-0.2, abs=1e-4)
    # Steps add what rounding adds.
    joints = SETTINGS.joints
    expected = scale * (joints.angle**2 + joints.angle_step**2 / 12) ** 0.5
    assert pstdev(seen) == pytest.approx(expected, rel=0.1)


def test_angles_of_joints_are_whole_steps_of_the_encoder():
    for felt in spoilt(count=20):
        steps = [angle / SETTINGS.joints.angle_step for angle in felt.joints.positions]
        assert steps == pytest.approx([round(step) for step in steps])


@pytest.mark.parametrize("scale", [1.0, 2.0])
@pytest.mark.parametrize(
    "of, truth, size",
    [
        (lambda felt: felt.joints.velocities[1], 0.5, SETTINGS.joints.speed),
        (lambda felt: felt.imu.gyroscope[1], 0.1, SETTINGS.inertial.gyroscope),
        (lambda felt: felt.imu.accelerometer[2], 9.81, SETTINGS.inertial.accelerometer),
    ],
    ids=["joint speed", "gyroscope", "accelerometer"],
)
def test_fast_noise_has_its_size_and_no_bias(of, truth, size, scale):
    seen = [of(felt) for felt in spoilt(scale)]
    assert fmean(seen) == pytest.approx(truth, abs=scale * size / 15)
    assert pstdev(seen) == pytest.approx(scale * size, rel=0.05)


def test_angles_of_the_inertial_unit_wander_slowly():
    """Within a tick by little, in the long run as far as they should, and never further and further."""
    errors = [felt.imu.angles[0] - 0.01 for seed in range(40) for felt in spoilt(count=240, seed=seed)[::240]]
    assert pstdev(errors) == pytest.approx(SETTINGS.inertial.angle_wander, rel=0.35)
    source = noise()
    long = [source.spoil(TRUTH).imu.angles[0] - 0.01 for _ in range(60_000)]
    assert pstdev(long) == pytest.approx(SETTINGS.inertial.angle_wander, rel=0.35)
    jumps = [after - before for before, after in zip(long, long[1:])]
    assert pstdev(jumps) < 0.2 * SETTINGS.inertial.angle_wander


def test_forces_of_the_feet_err_each_in_its_own_way_and_other_contacts_do_not():
    seen = spoilt()
    left, right, hand = ([felt.contacts[i].force for felt in seen] for i in range(3))
    assert set(hand) == {25.0}
    assert pstdev(left) / fmean(left) == pytest.approx(SETTINGS.feet.force, rel=0.1)
    assert fmean(left) != pytest.approx(fmean(right), rel=1e-3)
    means = [fmean(felt.contacts[0].force for felt in spoilt(count=40, seed=seed)) for seed in range(150)]
    assert pstdev(means) / 25.0 == pytest.approx(SETTINGS.feet.calibration, rel=0.25)


def test_a_foot_never_pulls():
    assert min(felt.contacts[0].force for felt in spoilt(scale=100.0)) == 0.0


def test_motor_torques_and_places_of_contacts_stay_true():
    (felt,) = spoilt(count=1)
    assert felt.joints.torques == TRUTH.joints.torques
    assert [c[:3] for c in felt.contacts] == [c[:3] for c in TRUTH.contacts]
    assert felt.link_poses is TRUTH.link_poses


def test_late_readings_arrive_whole_and_in_order():
    delay = Delay(3)
    sent = [TRUTH._replace(link_poses={index: POSE}) for index in range(10)]
    arrived = [delay.arrive(felt) for felt in sent]
    assert arrived[3:] == sent[:7]
    # Nothing older than the first is there.
    assert arrived[:3] == [sent[0]] * 3


def test_without_noise_only_the_delay_is_left():
    late = Imperfection(None, Delay(1))
    assert [late.of(TRUTH), late.of(TRUTH._replace(contacts=()))] == [TRUTH, TRUTH]


def test_a_robot_with_noise_feels_errors_but_the_truth_stays_true(bench):
    noisy, quiet = bench("Crouch", sensor_noise=1.0), bench("Crouch")
    ours, true = noisy.run(0.5), quiet.run(0.5)
    assert ours.positions != true.positions and ours.positions == pytest.approx(true.positions, abs=0.01)
    assert ours.imu.angles != true.imu.angles
    assert roll_pitch_yaw(ours.torso.orientation) == pytest.approx(true.imu.angles, abs=2e-3)
    assert max(map(abs, ours.angular_velocity)) < 0.01 < max(map(abs, ours.imu.gyroscope))
    assert ours.odometry != true.odometry


def test_a_late_robot_feels_what_was(bench):
    one = bench("Stand", sensor_delay=0.05)
    one.run(1.0)
    one.aim(3.0, HeadYaw=1.0)
    seen = one.watch(0.5)
    yaw = one.model.joint_index["HeadYaw"]
    angles = [snapshot.positions[yaw] for snapshot in seen]
    prompt = bench("Stand")
    prompt.run(1.0)
    prompt.aim(3.0, HeadYaw=1.0)
    truth = [snapshot.positions[yaw] for snapshot in prompt.watch(0.5)]
    assert angles[6:] == pytest.approx(truth[:-6], abs=1e-3)
    assert abs(angles[10] - truth[10]) > 0.02


def test_all_late_readings_of_the_feet_are_of_one_time(bench):
    one = bench("Stand", sensor_delay=0.1)
    one.push((60.0, 0.0, 0.0), 0.2)
    for snapshot in one.watch(1.5):
        assert set(snapshot.link_poses) == {contact.link for contact in snapshot.contacts}
        assert snapshot.left_foot.total >= 0.0


def test_the_seed_decides_about_a_noisy_run(bench):
    first, second, other = (bench("Crouch", sensor_noise=1.0, seed=seed).run(0.3) for seed in (1, 1, 2))
    assert first == second
    assert first.imu != other.imu
