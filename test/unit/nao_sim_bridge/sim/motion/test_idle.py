"""Idle chains: breathing, idle posture, and that anybody else's motion comes first."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim.fall_manager import FallState
from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.motion.idle import BREATH, EASE_TIME, FIVE_DEGREES, GROUPS, Idle, Mode
from nao_sim_bridge.sim.motion.joints import JointCommands
from nao_sim_bridge.sim.postures import posture

MODEL = load_model()
INDEX = MODEL.joint_index
STAND = posture(MODEL, "Stand")
DT = 0.05
NOBODY = frozenset()


class Chains:
    """Idle chains on commands alone; the robot stands unless told otherwise."""

    def __init__(self):
        self.joints = JointCommands(MODEL, STAND)
        self.joints.set_stiffness({i: 1.0 for i in range(26)})
        self.standing, self.reference = True, "Stand"
        self.idle = Idle(MODEL, self.joints, lambda: self.reference, lambda: self.standing)

    def run(self, seconds, busy=NOBODY):
        """What the chains wish at each tick."""
        wishes = []
        for _ in range(round(seconds / DT)):
            wishes.append(dict(self.idle.wishes(busy, DT)))
            self.joints.step(wishes[-1], DT)
        return wishes


@pytest.fixture
def chains():
    return Chains()


def names(wishes):
    return {MODEL.joints[i].name for wish in wishes for i in wish}


def test_chains_do_nothing_by_themselves(chains):
    assert not chains.idle.active
    assert chains.run(1.0) == [{}] * 20


def test_modes_are_kept_for_each_chain_and_the_last_call_counts(chains):
    idle = chains.idle
    idle.set_mode("Body", Mode.BREATH)
    assert all(idle.has_mode(group, Mode.BREATH) for group in GROUPS)
    idle.set_mode("LArm", Mode.POSTURE)
    assert not idle.has_mode("Arms", Mode.BREATH) and not idle.has_mode("Body", Mode.BREATH)
    assert idle.has_mode("RArm", Mode.BREATH) and idle.has_mode("LArm", Mode.POSTURE)
    idle.set_mode("Body", Mode.NOTHING)
    assert not idle.active


@pytest.mark.parametrize("amplitude, most", [(0.0, FIVE_DEGREES), (1.0, 2 * FIVE_DEGREES)])
def test_a_breath_is_as_deep_as_its_amplitude_says(chains, amplitude, most):
    chains.idle.set_breath(5.0, amplitude)
    chains.idle.set_mode("Body", Mode.BREATH)
    chains.run(EASE_TIME)
    wishes = chains.run(12.0)
    swings = {i: max(w[i] for w in wishes) - min(w[i] for w in wishes) for i in wishes[0]}
    assert max(swings.values()) <= most + 1e-9
    assert max(swings.values()) == pytest.approx(max(BREATH.values()) * most / FIVE_DEGREES, rel=0.01)


def test_the_frequency_is_breaths_a_minute(chains):
    chains.idle.set_breath(15.0, 0.5)
    chains.idle.set_mode("Head", Mode.BREATH)
    chains.run(EASE_TIME)
    pitch = [wish[INDEX["HeadPitch"]] for wish in chains.run(11.0)]
    peaks = [k for k in range(1, len(pitch) - 1) if pitch[k - 1] < pitch[k] >= pitch[k + 1]]
    assert [b - a for a, b in zip(peaks, peaks[1:])] == [round(4.0 / DT)]


@pytest.mark.parametrize("bpm, asked, given", [(5.0, 1.0, 1.0), (30.0, 1.0, 0.0), (17.5, 1.0, 0.5), (17.5, 0.3, 0.3)])
def test_fast_breaths_are_flat(chains, bpm, asked, given):
    chains.idle.set_breath(bpm, asked)
    assert (chains.idle.bpm, chains.idle.amplitude) == (bpm, pytest.approx(given))


def test_only_the_chains_asked_for_breathe_and_both_arms_alike(chains):
    chains.idle.set_mode("Arms", Mode.BREATH)
    wishes = chains.run(4.0)
    assert names(wishes) == {name for arm in ("LArm", "RArm") for name in MODEL.chains[arm]}
    for kind, sign in (("ShoulderPitch", 1), ("ShoulderRoll", -1), ("ElbowRoll", -1)):
        left, right = (wishes[-1][INDEX[side + kind]] - STAND[INDEX[side + kind]] for side in "LR")
        assert left == pytest.approx(sign * right, abs=1e-3)
        assert left != 0.0


def test_a_robot_that_does_not_stand_does_not_breathe(chains):
    chains.standing = False
    chains.idle.set_mode("Body", Mode.BREATH)
    assert names(chains.run(1.0)) == set()
    chains.standing = True
    assert names(chains.run(1.0)) != set()


def test_idle_posture_leads_back_softly_and_then_asks_for_nothing(chains):
    chains.joints.step({INDEX["LShoulderPitch"]: 1.3}, 10.0)
    chains.idle.set_mode("LArm", Mode.POSTURE)
    wishes = chains.run(3.0)
    assert chains.joints.commands == pytest.approx(STAND)
    steps = [abs(b[INDEX["LShoulderPitch"]] - a[INDEX["LShoulderPitch"]]) for a, b in zip(wishes, wishes[1:]) if b]
    assert max(steps) < 0.01
    assert chains.run(1.0) == [{}] * 20


def test_without_a_posture_to_go_back_to_a_chain_stays(chains):
    chains.reference = None
    chains.joints.step({INDEX["HeadYaw"]: 1.0}, 10.0)
    chains.idle.set_mode("Head", Mode.POSTURE)
    chains.run(3.0)
    assert chains.joints.commands[INDEX["HeadYaw"]] == 1.0


def test_a_chain_somebody_moves_is_left_to_him_and_taken_up_from_there(chains):
    head = INDEX["HeadYaw"]
    chains.idle.set_mode("Body", Mode.POSTURE)
    chains.joints.step({head: 1.0}, 10.0)
    assert chains.run(2.0, busy={head}) == [{}] * 40
    wishes = chains.run(0.2)
    assert wishes[0][head] == pytest.approx(1.0, abs=0.01)
    chains.run(6.0)
    assert chains.joints.commands[head] == pytest.approx(STAND[head])


@pytest.mark.parametrize("why", ["limp", "suspended"])
def test_a_limp_chain_and_a_falling_robot_are_left_alone(chains, why):
    chains.idle.set_mode("Head", Mode.BREATH)
    if why == "limp":
        chains.joints.set_stiffness({INDEX["HeadPitch"]: 0.0})
    chains.idle.suspended = why == "suspended"
    assert chains.run(1.0) == [{}] * 20


# --- under physics ----------------------------------------------------------------------------------------------------


def test_a_breathing_robot_stays_on_its_feet_and_moves(bench):
    one = bench()
    one.run(0.3)
    one.robot.reflexes.idle.set_breath(5.0, 1.0)
    one.robot.reflexes.idle.set_mode("Body", Mode.BREATH)
    seen = one.watch(16.0)
    elbows = [snapshot.positions[INDEX["LElbowRoll"]] for snapshot in seen]
    assert max(elbows) - min(elbows) > FIVE_DEGREES
    assert max(abs(angle) for snapshot in seen for angle in snapshot.imu.angles[:2]) < 0.02
    assert one.robot.stability.on_feet and one.robot.stability.falls.state is not FallState.FALLING


def test_a_target_interrupts_the_breath_of_its_chain(bench):
    one = bench()
    one.run(0.3)
    one.robot.reflexes.idle.set_mode("Head", Mode.BREATH)
    one.run(1.0)
    one.aim(HeadYaw=0.5)
    one.run(0.55)
    assert one.joint("HeadYaw") == pytest.approx(0.5, abs=0.02)
    one.run(4.0)
    assert one.joint("HeadYaw") == pytest.approx(STAND[INDEX["HeadYaw"]], abs=0.01)
