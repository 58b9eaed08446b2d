"""Noise has the size that it should have, steps are steps, and what is late is whole."""

from __future__ import annotations

import random
from statistics import fmean, pstdev

import pytest

from nao_sim_bridge.base.readings import Contact, JointReadings, Pose
from nao_sim_bridge.body.sensors.imperfection import Delay, Felt, Imperfection, Noise, load_noise
from nao_sim_bridge.body.sensors.snapshot import Imu

LEFT, RIGHT, HAND = 3, 7, 12
SETTINGS = load_noise()
POSE = Pose((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
TRUTH = Felt(
    JointReadings((0.1, -0.2), (0.0, 0.5), (1.0, 2.0)),
    Imu((0.0, 0.0, 9.81), (0.0, 0.1, 0.0), (0.01, 0.02, 0.5)),
    tuple(Contact(link, (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 25.0) for link in (LEFT, RIGHT, HAND)),
    {LEFT: POSE, RIGHT: POSE, HAND: POSE},
)


def spoilt(scale=1.0, count=4000, seed=0):
    source = Noise(SETTINGS, scale, random.Random(seed), (LEFT, RIGHT), 1 / 120)
    return [source.spoil(TRUTH) for _ in range(count)]


@pytest.fixture(scope="module")
def felt():
    """4000 readings of each scale of the noise."""
    return {scale: spoilt(scale) for scale in (0.5, 2.0)}


def test_the_same_seed_makes_the_same_errors_and_what_is_true_stays_true():
    first, again, other = spoilt(count=5), spoilt(count=5), spoilt(count=5, seed=1)
    assert first == again != other
    for felt in first:
        assert felt.joints.torques == TRUTH.joints.torques and felt.link_poses is TRUTH.link_poses
        assert [c[:3] for c in felt.contacts] == [c[:3] for c in TRUTH.contacts]
        steps = [angle / SETTINGS.joints.angle_step for angle in felt.joints.positions]
        assert steps == pytest.approx([round(step) for step in steps])


@pytest.mark.parametrize("scale", [0.5, 2.0])
@pytest.mark.parametrize(
    "of, truth, size, step",
    [
        (lambda felt: felt.joints.positions[1], -0.2, SETTINGS.joints.angle, SETTINGS.joints.angle_step),
        (lambda felt: felt.joints.velocities[1], 0.5, SETTINGS.joints.speed, 0.0),
        (lambda felt: felt.imu.gyroscope[1], 0.1, SETTINGS.inertial.gyroscope, 0.0),
        (lambda felt: felt.imu.accelerometer[2], 9.81, SETTINGS.inertial.accelerometer, 0.0),
    ],
    ids=["joint angle", "joint speed", "gyroscope", "accelerometer"],
)
def test_fast_noise_has_its_size_and_no_bias(felt, of, truth, size, step, scale):
    seen = [of(one) for one in felt[scale]]
    assert fmean(seen) == pytest.approx(truth, abs=max(scale * size / 15, 1e-4))
    # Steps add what rounding adds.
    assert pstdev(seen) == pytest.approx(scale * (size**2 + step**2 / 12) ** 0.5, rel=0.1 if step else 0.05)


def test_angles_of_the_inertial_unit_wander_slowly(felt):
    """Within a tick by little, in the long run as far as they should, and never further and further."""
    starts = [spoilt(count=1, seed=seed)[0].imu.angles[0] - 0.01 for seed in range(80)]
    long = [one.imu.angles[0] - 0.01 for one in spoilt(count=30_000)]
    jumps = [after - before for before, after in zip(long, long[1:])]
    wander = SETTINGS.inertial.angle_wander
    assert (pstdev(starts), pstdev(long)) == pytest.approx((wander, wander), rel=0.35) and pstdev(jumps) < 0.2 * wander


def test_late_readings_arrive_whole_and_in_order():
    delay, sent = Delay(3), [TRUTH._replace(link_poses={index: POSE}) for index in range(10)]
    arrived = [delay.arrive(felt) for felt in sent]
    assert arrived[3:] == sent[:7] and arrived[:3] == [sent[0]] * 3, "nothing older than the first is there"
    late = Imperfection(None, Delay(1))
    assert [late.of(*TRUTH), late.of(*TRUTH._replace(contacts=()))] == [TRUTH, TRUTH]
