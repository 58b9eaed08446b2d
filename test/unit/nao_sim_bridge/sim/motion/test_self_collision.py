"""Arms keep away from the rest of the robot: distances, the guard of the commands, and what the body really does."""

from __future__ import annotations

import numpy as np
import pytest

from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.motion.curves import SmoothCurve
from nao_sim_bridge.sim.motion.self_collision import CONTACT, REACH, SelfCollision
from nao_sim_bridge.sim.postures import load_postures, posture

MODEL = load_model()
INDEX = MODEL.joint_index
STAND = posture(MODEL, "Stand")
# The left forearm across the chest.
CHEST = {"LShoulderPitch": 0.8, "LShoulderRoll": -0.3, "LElbowYaw": -0.3, "LElbowRoll": -1.5}
LEFT = frozenset(INDEX[name] for name in MODEL.chains["LArm"])


@pytest.fixture
def guard():
    return SelfCollision(MODEL)


def posed(**angles):
    pose = list(STAND)
    for name, angle in angles.items():
        pose[INDEX[name]] = angle
    return tuple(pose)


def walk(guard, start, goal, steps=100):
    """Poses on the straight way from start to goal, each as the guard lets it."""
    now = tuple(start)
    seen = []
    for k in range(1, steps + 1):
        wish = [a + k / steps * (b - a) for a, b in zip(start, goal)]
        for index in guard(now, wish):
            wish[index] = now[index]
        now = tuple(wish)
        seen.append(now)
    return seen


@pytest.mark.parametrize("name", sorted(load_postures().by_name))
def test_no_posture_counts_as_a_collision(guard, name):
    angles = posture(MODEL, name)
    assert guard.distances(angles).min() > CONTACT
    assert {guard.state(arm, angles) for arm in ("LArm", "RArm")} <= {"none", "near"}


def test_states_of_an_arm(guard):
    aside = posed(LShoulderPitch=0.0, LShoulderRoll=1.0)
    assert guard.state("LArm", aside) == "none"
    assert guard.state("LArm", posed(**CHEST)) == "collision"
    assert guard.state("RArm", posed(**CHEST)) == guard.state("RArm", STAND)


def test_no_joint_brings_shapes_closer_than_the_guard_reckons(guard):
    chance = np.random.default_rng(5)
    lower, upper = MODEL.limits_array().T
    for _ in range(150):
        before = chance.uniform(lower, upper)
        index = int(chance.integers(26))
        after = before.copy()
        after[index] = np.clip(before[index] + 0.02, lower[index], upper[index])
        kind = MODEL.joints[index].name
        reach = REACH.get(kind if kind.startswith("Head") else kind[1:], 0.0)
        come = np.abs(guard.distances(after) - guard.distances(before)).max()
        assert come <= reach * (after[index] - before[index]) + 1e-9, kind


def test_an_arm_stops_before_the_chest_and_the_other_arm_goes_on(guard):
    goal = posed(**CHEST, RShoulderPitch=0.5)
    way = walk(guard, STAND, goal)
    assert min(guard.distances(pose).min() for pose in way) > CONTACT - 1e-6
    assert way[-1][INDEX["LElbowRoll"]] > CHEST["LElbowRoll"] + 0.1
    assert way[-1][INDEX["RShoulderPitch"]] == pytest.approx(0.5)


def test_an_arm_that_is_too_close_may_leave(guard):
    close = posed(**CHEST)
    way = walk(guard, close, STAND)
    assert way[-1] == pytest.approx(STAND)


def test_without_protection_nothing_is_kept(guard):
    goal = posed(**CHEST)
    guard.enabled.discard("LArm")
    assert walk(guard, STAND, goal)[-1] == pytest.approx(goal)
    guard.enabled.add("LArm")
    guard.suspended = True
    assert walk(guard, STAND, goal)[-1] == pytest.approx(goal)
    guard.suspended = False
    assert walk(guard, STAND, goal)[-1] != pytest.approx(goal)


def test_two_hands_in_one_place_both_stop(guard):
    both = {f"{side}{kind}": sign * angle
            for side, sign in (("L", 1), ("R", -1))
            for kind, angle in (("ShoulderRoll", -0.3), ("ElbowYaw", -0.2), ("ElbowRoll", -0.6))}  # fmt: skip
    goal = posed(**both, LShoulderPitch=0.0, RShoulderPitch=0.0)
    start = posed(LShoulderPitch=0.0, RShoulderPitch=0.0)
    assert guard.distances(goal).min() < CONTACT
    end = walk(guard, start, goal)[-1]
    for name in ("LShoulderRoll", "RShoulderRoll"):
        assert end[INDEX[name]] != pytest.approx(goal[INDEX[name]], abs=0.05)


# --- under physics ----------------------------------------------------------------------------------------------------


def test_an_interpolation_into_the_chest_ends_in_time_with_the_arm_short_of_it(bench):
    one = bench()
    one.run(0.3)
    goals = {INDEX[name]: angle for name, angle in CHEST.items()}
    task = one.robot.motion.follow(
        "glide", goals, lambda now: {i: SmoothCurve((0.0, 1.0), (now[i], angle)) for i, angle in goals.items()}
    )
    guard = one.robot.reflexes.self_collision
    least = min(guard.distances(snapshot.positions).min() for snapshot in one.watch(1.1))
    assert task.finished
    assert one.joint("LElbowRoll") > CHEST["LElbowRoll"] + 0.1
    # Motors swing past their command by a little.
    assert least > CONTACT - 0.004
    assert guard.state("LArm", one.now.commands) == "near"
