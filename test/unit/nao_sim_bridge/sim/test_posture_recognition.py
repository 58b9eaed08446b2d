"""Postures and families: of the predefined postures, of poses that are none, and of a robot that fell."""

from __future__ import annotations

import random
from math import radians

import pytest

from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.posture_recognition import (
    FAMILIES,
    UNKNOWN,
    Recognition,
    lean_of,
    recognise,
    recognise_readings,
    up_in_torso,
)
from nao_sim_bridge.sim.postures import load_postures, posture

MODEL = load_model()
# Roll and pitch of the torso (degrees) with flat feet, on the seat, or lying; share of the weight on the feet.
READINGS = {
    "Stand": (0, 0, 1.0),
    "StandInit": (0, 6, 1.0),
    "StandZero": (0, 0, 1.0),
    "Crouch": (0, -3, 1.0),
    "Sit": (0, -10, 0.4),
    "SitRelax": (0, -15, 0.2),
    "LyingBelly": (0, 85, 0.2),
    "LyingBack": (0, -85, 0.2),
}


def seen(angles, roll=0, pitch=0, load=1.0):
    """Recognition with angles of the torso in degrees."""
    return recognise_readings(MODEL, angles, radians(roll), radians(pitch), load)


def changed(name, **joints):
    """The angles of a posture, some of them others (rad)."""
    angles = list(posture(MODEL, name))
    for joint, angle in joints.items():
        angles[MODEL.joint_index[joint]] = angle
    return angles


def legs(name, **joints):
    """The angles of a posture, joints of both legs changed alike (pitches only)."""
    return changed(name, **{f"{side}{joint}": angle for joint, angle in joints.items() for side in "LR"})


def test_the_readings_below_are_of_all_predefined_postures():
    assert set(READINGS) == set(load_postures().by_name)


@pytest.mark.parametrize("name", READINGS)
def test_a_predefined_posture_is_recognised(name):
    assert seen(posture(MODEL, name), *READINGS[name]) == Recognition(name, load_postures().by_name[name].family)


@pytest.mark.parametrize("name", READINGS)
def test_noise_does_not_hide_a_posture(name):
    chance = random.Random(name)
    roll, pitch, load = READINGS[name]
    for _ in range(40):
        angles = [angle + chance.uniform(-0.1, 0.1) for angle in posture(MODEL, name)]
        noisy = seen(
            angles, roll + chance.uniform(-5, 5), pitch + chance.uniform(-5, 5), load * chance.uniform(0.9, 1.1)
        )
        assert noisy == Recognition(name, load_postures().by_name[name].family)


def test_every_family_of_a_predefined_posture_can_be_recognised():
    assert {entry.family for entry in load_postures().by_name.values()} <= set(FAMILIES)


@pytest.mark.parametrize("turned", [{"HeadYaw": 1.0}, {"LHand": 1.0, "RHand": 1.0}, {"LWristYaw": 1.5}])
def test_head_and_hands_make_no_posture(turned):
    assert seen(changed("Stand", **turned)).posture == "Stand"


@pytest.mark.parametrize(
    "angles, family",
    [
        (changed("Stand", LShoulderPitch=-1.5, RShoulderPitch=-1.5), "Standing"),
        (legs("StandInit", HipPitch=-0.6, KneePitch=1.1, AnklePitch=-0.5), "Standing"),
        (legs("StandInit", HipPitch=-0.9, KneePitch=1.8, AnklePitch=-0.9), "Crouching"),
        (legs("Crouch", HipPitch=-0.8, KneePitch=2.0, AnklePitch=-1.1), "Crouching"),
    ],
)
def test_families_go_beyond_the_predefined_postures(angles, family):
    assert seen(angles).family == family


def test_a_pose_far_from_every_posture_has_a_family_only():
    arms_up = changed("Stand", LShoulderPitch=-1.5, RShoulderPitch=-1.5)
    assert seen(arms_up) == Recognition(UNKNOWN, "Standing")


def test_standing_on_one_leg_is_standing():
    one_leg = changed("StandInit", RHipPitch=-1.0, RKneePitch=1.6, RAnklePitch=-0.6)
    assert seen(one_leg, pitch=6).family == "Standing"


def test_a_chair_takes_the_weight_off_bent_legs():
    on_chair = legs("StandZero", HipPitch=-1.5, KneePitch=1.5, AnklePitch=0.0)
    assert seen(on_chair, load=0.35).family == "SittingOnChair"
    assert seen(legs("StandInit", HipPitch=-1.0, KneePitch=2.0, AnklePitch=-1.0), load=1.0).family == "Crouching"


@pytest.mark.parametrize("name", ["Stand", "StandInit", "Crouch"])
def test_a_robot_in_the_air_neither_stands_nor_crouches(name):
    roll, pitch, _ = READINGS[name]
    assert seen(posture(MODEL, name), roll, pitch, load=0.0) == Recognition(UNKNOWN, UNKNOWN)


@pytest.mark.parametrize(
    "roll, pitch, family",
    [
        (0, 20, "Standing"),
        (0, 40, UNKNOWN),
        (0, 60, "LyingBelly"),
        (0, -60, "LyingBack"),
        (60, 0, "LyingRight"),
        (-60, 0, "LyingLeft"),
        (-100, 0, "LyingLeft"),
        (180, 80, "LyingBelly"),
        (20, -70, "LyingBack"),
    ],
)
def test_leaning_too_far_is_lying_on_that_side(roll, pitch, family):
    # Feet stay flat as far as the ankles let them.
    angles = legs("StandZero", AnklePitch=-radians(pitch)) if abs(pitch) < 50 else posture(MODEL, "StandZero")
    assert seen(angles, roll, pitch, load=0.8).family == family


def test_a_robot_on_the_edges_of_its_feet_does_not_stand():
    assert seen(posture(MODEL, "StandZero"), roll=25).family == UNKNOWN


@pytest.mark.parametrize(
    "roll, pitch, up, lean",
    [
        (0, 0, (0, 0, 1), 0),
        (0, 90, (-1, 0, 0), 90),
        (0, -90, (1, 0, 0), 90),
        (90, 0, (0, 1, 0), 90),
        (180, 0, (0, 0, -1), 180),
    ],
)
def test_the_way_up_as_the_torso_sees_it(roll, pitch, up, lean):
    assert up_in_torso(radians(roll), radians(pitch)) == pytest.approx(up, abs=1e-12)
    assert lean_of(radians(roll), radians(pitch)) == pytest.approx(radians(lean), abs=1e-7)


@pytest.mark.parametrize("name", ["Stand", "StandInit", "StandZero", "Crouch"])
def test_a_standing_robot_knows_its_posture(bench, name):
    one = bench(name)
    one.run(0.5)
    assert recognise(one.model, one.now) == Recognition(name, load_postures().by_name[name].family)


@pytest.mark.parametrize("force, family", [((60.0, 0.0, 0.0), "LyingBelly"), ((-60.0, 0.0, 0.0), "LyingBack")])
def test_a_robot_that_fell_lies(bench, force, family):
    one = bench("Stand")
    one.push(force, 0.2)
    one.run(1.5)
    assert recognise(one.model, one.now).family == family


@pytest.mark.parametrize("force, side, other", [(40.0, "LyingLeft", "LyingRight"), (-40.0, "LyingRight", "LyingLeft")])
def test_a_robot_that_falls_aside_lies_on_that_side_before_it_rolls_over(bench, force, side, other):
    one = bench("Stand")
    one.push((0.0, force, 0.0), 0.2)
    families = [recognise(one.model, snapshot).family for snapshot in one.watch(2.0)[::6]]
    assert side in families
    assert other not in families
    assert families[0] == "Standing" and families[-1] == "LyingBack"


def test_a_robot_that_collapses_stands_no_longer(bench):
    one = bench("StandZero", 0.0)
    one.run(2.0)
    assert recognise(one.model, one.now).family not in ("Standing", UNKNOWN)
