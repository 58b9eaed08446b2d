"""Reflexes on commands alone: arms keep off the body and slow down before obstacles, idle chains, smart stiffness."""

from __future__ import annotations

import numpy as np
import pytest

from nao_sim_bridge.body.joint_commands import JointCommands
from nao_sim_bridge.control.balance.external_collision import SLOWEST, ExternalCollision
from nao_sim_bridge.control.joints.idle import BREATH, EASE_TIME, FIVE_DEGREES, Idle, Mode
from nao_sim_bridge.control.joints.self_collision import CONTACT, SelfCollision, segment_distances
from nao_sim_bridge.control.joints.smart_stiffness import ALL, FACTOR, MOVED, SETTLING, SPARE, SmartStiffness
from nao_sim_bridge.model.kinematics import link_transforms
from nao_sim_bridge.model.model_reader import load_model
from nao_sim_bridge.model.postures import load_postures, posture

MODEL = load_model()
INDEX = MODEL.joint_index
STAND, AHEAD = posture(MODEL, "Stand"), posture(MODEL, "StandZero")
# The left forearm across the chest.
CHEST = {"LShoulderPitch": 0.8, "LShoulderRoll": -0.3, "LElbowYaw": -0.3, "LElbowRoll": -1.5}


def test_distances_of_capsules():
    zero, x, y = np.zeros(3), *np.eye(3)[:2]
    known = [(zero, zero, x, x, 1.0), (zero, x, 2 * x, 3 * x, 1.0), (zero, x, y, y + x, 1.0), (-x, x, -y, y, 0.0)]
    known += [(zero, zero, x - y, x + y, 1.0), (x - y, x + y, zero, zero, 1.0), (zero,) * 4 + (0.0,)]
    found = segment_distances(*(np.array([row[end] for row in known]) for end in range(4)))
    assert found == pytest.approx([row[4] for row in known], abs=1e-6)


@pytest.fixture
def guard():
    return SelfCollision(MODEL)


def posed(**angles):
    return tuple(angles.get(joint.name, angle) for joint, angle in zip(MODEL.joints, STAND))


def walk(guard, start, goal, steps=100):
    """Poses on the straight way from start to goal, each as the guard lets it."""
    seen = [tuple(start)]
    for k in range(1, steps + 1):
        wish = [a + k / steps * (b - a) for a, b in zip(start, goal)]
        for index in guard(seen[-1], wish):
            wish[index] = seen[-1][index]
        seen.append(tuple(wish))
    return seen


def test_no_posture_counts_as_a_collision_and_states_are_told(guard):
    for name in load_postures().by_name:
        angles = posture(MODEL, name)
        assert guard.distances(angles).min() > CONTACT, name
        assert {guard.state(arm, angles) for arm in ("LArm", "RArm")} <= {"none", "near"}, name
    assert guard.state("LArm", posed(LShoulderPitch=0.0, LShoulderRoll=1.0)) == "none"
    assert guard.state("LArm", posed(**CHEST)) == "collision"
    assert guard.state("RArm", posed(**CHEST)) == guard.state("RArm", STAND)


def test_an_arm_stops_before_the_chest_may_leave_it_and_the_other_arm_goes_on(guard):
    way = walk(guard, STAND, posed(**CHEST, RShoulderPitch=0.5))
    assert min(guard.distances(pose).min() for pose in way) > CONTACT - 1e-6
    assert way[-1][INDEX["LElbowRoll"]] > CHEST["LElbowRoll"] + 0.1
    assert way[-1][INDEX["RShoulderPitch"]] == pytest.approx(0.5)
    assert walk(guard, posed(**CHEST), STAND)[-1] == pytest.approx(STAND)


FAR = 5.0


def hand_to(sonar):
    """From the left hand of a robot with both arms ahead to a sonar, m."""
    place = MODEL.effectors["LArm"]
    link = link_transforms(MODEL, AHEAD)[place.parent_link]
    return float(np.linalg.norm(link[:3, :3] @ place.position + link[:3, 3] - MODEL.sonars[sonar].position))


def test_an_obstacle_is_on_the_axis_of_its_sonar_and_the_nearer_one_counts():
    external = ExternalCollision(MODEL)
    assert external.closest_obstacle("LArm", STAND, (FAR, FAR)) is None
    left = external.closest_obstacle("LArm", AHEAD, (0.5, FAR))
    assert np.linalg.norm(left - MODEL.sonars[0].position) == pytest.approx(0.5) and left[0] > 0.4 and left[1] > 0.0
    both = external.closest_obstacle("LArm", AHEAD, (0.9, 0.3))
    assert np.linalg.norm(both - MODEL.sonars[1].position) == pytest.approx(0.3)


def test_a_protected_arm_slows_down_as_it_comes_near():
    external, near = ExternalCollision(MODEL), hand_to(0)
    echoes = [(near + gap, FAR) for gap in (0.5, 0.11, 0.09, 0.06, 0.021, 0.0)]
    shares = [external.speed_shares(AHEAD, echo).get(INDEX["LShoulderPitch"], 1.0) for echo in echoes]
    assert shares[:2] == [1.0, 1.0] and shares[2] > shares[3] > shares[4] and shares[-1] == SLOWEST
    assert external.speed_shares(AHEAD, (FAR, FAR)) == external.speed_shares(STAND, (0.15, 0.15)) == {}
    external.enabled.discard("LArm")
    slowed = {MODEL.joints[i].name for i in external.speed_shares(AHEAD, (near, near))}
    assert slowed == set(MODEL.chains["RArm"])
    external.enabled.clear()
    assert external.speed_shares(AHEAD, (near, near)) == {}


DT = 0.05


class Chains:
    """Idle chains on commands alone; the robot stands unless told otherwise."""

    def __init__(self):
        self.joints = JointCommands(MODEL, STAND)
        self.joints.set_stiffness({i: 1.0 for i in range(26)})
        self.standing, self.reference = True, "Stand"
        self.idle = Idle(MODEL, self.joints, lambda: self.reference, lambda: self.standing)

    def run(self, seconds, busy=frozenset()):
        """What the chains wish at each tick."""
        wishes = []
        for _ in range(round(seconds / DT)):
            wishes.append(dict(self.idle.wishes(busy, DT)))
            self.joints.step(wishes[-1], DT)
        return wishes


@pytest.fixture
def chains():
    return Chains()


@pytest.mark.parametrize("amplitude, most", [(0.0, FIVE_DEGREES), (1.0, 2 * FIVE_DEGREES)])
def test_a_breath_is_as_deep_and_as_frequent_as_asked(chains, amplitude, most):
    chains.idle.set_breath(15.0 - 10.0 * amplitude, amplitude)
    chains.idle.set_mode("Body", Mode.BREATH)
    chains.run(EASE_TIME)
    wishes = chains.run(25.0)
    swings = [max(w[i] for w in wishes) - min(w[i] for w in wishes) for i in wishes[0]]
    assert max(swings) <= most + 1e-9 and max(swings) == pytest.approx(
        max(BREATH.values()) * most / FIVE_DEGREES, rel=0.01
    )
    pitch = [wish[INDEX["HeadPitch"]] for wish in wishes]
    peaks = [k for k in range(1, len(pitch) - 1) if pitch[k - 1] < pitch[k] >= pitch[k + 1]]
    assert {b - a for a, b in zip(peaks, peaks[1:])} == {round((12.0 if amplitude else 4.0) / DT)}


def test_only_the_chains_asked_for_breathe_both_arms_alike_and_only_while_it_stands(chains):
    chains.standing = False
    chains.idle.set_mode("Arms", Mode.BREATH)
    assert chains.run(1.0) == [{}] * 20
    chains.standing = True
    wishes = chains.run(4.2)
    assert {i for wish in wishes for i in wish} == {INDEX[n] for arm in ("LArm", "RArm") for n in MODEL.chains[arm]}
    for kind, sign in (("ShoulderPitch", 1), ("ShoulderRoll", -1), ("ElbowRoll", -1)):
        left, right = (wishes[-1][INDEX[side + kind]] - STAND[INDEX[side + kind]] for side in "LR")
        assert left == pytest.approx(sign * right, abs=1e-3) and left != 0.0


def test_a_static_posture_gets_what_it_needs_and_some_to_spare_until_something_moves():
    smart, dt = SmartStiffness([2.0, 1.0]), 0.1

    def after(seconds, moved=0.0):
        return [smart.shares(False, (0.0, moved), (1.0, -0.2), dt) for _ in range(round(seconds / dt))][-1]

    needed = pytest.approx((SPARE + FACTOR * 0.5, SPARE + FACTOR * 0.2))
    assert after(SETTLING - dt) == ALL and after(SETTLING + dt) == needed
    assert smart.shares(True, (0.0, 0.0), (1.0, -0.2), dt) == ALL == after(dt), "a command gives all back at once"
    assert after(SETTLING + dt) == needed == after(dt, 0.9 * MOVED)
    assert after(dt, 1.1 * MOVED) == ALL, "a push, too"
    smart.enabled = False
    assert after(SETTLING + dt) == ALL
