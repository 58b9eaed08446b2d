"""Balance while standing: what the law answers, and that it keeps a pushed robot on its feet."""

from __future__ import annotations

import math

import pytest

from nao_sim_bridge.sim import balance as module
from nao_sim_bridge.sim.balance import FILE, Balance, load_balance
from nao_sim_bridge.sim.capture_point import BodyMotion
from nao_sim_bridge.sim.errors import ConfigError
from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.motion.sequences import posture_task
from nao_sim_bridge.sim.postures import posture
from nao_sim_bridge.sim.stance import StanceReader

MODEL = load_model()
READER = StanceReader(MODEL)
STAND = posture(MODEL, "Stand")
SIDES = {"front": (1, 0), "back": (-1, 0), "left": (0, 1), "right": (0, -1)}
# 2 N s within 0.1 s.
FORCE, PUSH_TIME = 20.0, 0.1
DT = 1 / 120


def index(name):
    return MODEL.joint_index[name]


def body(lean=0.0, roll=0.0, velocity=(0.0, 0.0)):
    """A body in Stand that leans by so much, rad, and moves at m/s."""
    flat_roll, flat_pitch = READER.lean(STAND)
    return BodyMotion(READER.read(STAND, flat_roll + roll, flat_pitch + lean), velocity, 6.0)


def law_at_rest():
    """Balance of a robot that stands on a level floor."""
    law = Balance(load_balance(MODEL), READER)
    law.corrections(body(), STAND, DT)
    return law


@pytest.fixture
def law():
    return law_at_rest()


@pytest.fixture
def load_changed(change_file):
    """Reads the file of the package after a change of its content."""

    def load(change):
        change_file(module, change)
        return load_balance(MODEL)

    return load


# --- the law ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("motion", [body(), body(lean=0.015), body(velocity=(0.03, -0.03))])
def test_a_body_at_home_or_nearly_so_gets_no_correction(law, motion):
    assert law.corrections(motion, STAND, DT) == {}
    assert not law.acting


@pytest.mark.parametrize("lean, velocity, sign", [(0.1, 0.0, 1), (-0.1, 0.0, -1), (0.0, 0.3, 1), (0.0, -0.3, -1)])
def test_a_swing_ahead_presses_the_toes_down_and_one_back_the_heels(law, lean, velocity, sign):
    found = law.corrections(body(lean, velocity=(velocity, 0.0)), STAND, DT)
    assert found[index("LAnklePitch")] == found[index("RAnklePitch")]
    assert sign * found[index("LAnklePitch")] > 0.04
    assert law.acting


def test_swings_to_left_and_right_are_answered_alike(law):
    mirrored = law_at_rest()
    left = law.corrections(body(velocity=(0.0, 0.4)), STAND, DT)
    right = mirrored.corrections(body(velocity=(0.0, -0.4)), STAND, DT)
    assert set(left) == set(right) == {index("LAnkleRoll"), index("RAnkleRoll")}
    assert left == pytest.approx({joint: -value for joint, value in right.items()}, rel=0.05)


def test_a_posture_that_leans_by_itself_is_no_swing(law):
    leaning = posture(MODEL, "StandInit")
    stance = READER.read(leaning, *READER.lean(leaning))
    assert law.corrections(BodyMotion(stance, (0.0, 0.0), 6.0), leaning, DT) == {}


def test_where_the_body_has_come_to_rest_it_belongs(law):
    law.settle()
    assert law.corrections(body(0.05), STAND, DT) == {}
    assert law.corrections(body(0.05), STAND, DT) == {}
    assert law.corrections(body(0.15), STAND, DT)[index("LAnklePitch")] > 0.0


def test_a_place_where_the_body_stays_is_learned(law):
    law.corrections(body(0.05), STAND, DT)
    assert law.acting
    for _ in range(600):
        found = law.corrections(body(0.05), STAND, DT)
    assert found == {}


def test_corrections_stay_within_their_limit(law):
    for _ in range(20):
        found = law.corrections(body(0.8, velocity=(2.0, 0.0)), STAND, DT)
    assert max(map(abs, found.values())) == pytest.approx(load_balance(MODEL).limit, abs=1e-3)


def test_corrections_fade_when_the_body_is_back(law):
    law.corrections(body(0.1), STAND, DT)
    assert law.acting
    for _ in range(30):
        found = law.corrections(body(), STAND, DT)
    assert found == {}
    assert not law.acting


def test_released_corrections_are_gone(law):
    law.corrections(body(0.1), STAND, DT)
    law.release()
    assert not law.acting
    assert law.corrections(body(), STAND, DT) == {}


# --- the file ---------------------------------------------------------------------------------------------------------


def test_an_unknown_joint_is_refused(load_changed):
    with pytest.raises(ConfigError, match=f"{FILE}: pitch: unknown key 'AnkleRoll'"):
        load_changed(lambda content: content["pitch"].update(AnkleRoll=[1.0, 1.0]))


def test_a_gain_needs_two_numbers(load_changed):
    with pytest.raises(ConfigError, match=r"pitch.HipPitch: is \[1.0\], not 2"):
        load_changed(lambda content: content["pitch"].update(HipPitch=[1.0]))


# --- the robot --------------------------------------------------------------------------------------------------------


def ticks(one, seconds):
    """Each snapshot of the next `seconds` as it comes, so that the robot can be looked at in between."""
    for _ in range(round(seconds / one.simulation.settings.tick_s)):
        yield one.simulation.tick()


def shove(one, side, force=FORCE):
    x, y = SIDES[side]
    one.push((force * x, force * y, 0.0), PUSH_TIME)


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("name", ["Stand", "StandInit"])
def test_a_push_of_two_newton_seconds_is_survived_and_the_posture_comes_back(bench, name, side):
    one = bench(name)
    before = one.run(0.5)
    shove(one, side)
    seen = one.watch(2.5)
    assert any(abs(a - b) > 0.01 for s in seen for a, b in zip(s.imu.angles[:2], before.imu.angles))
    end = seen[-1]
    assert end.imu.angles[:2] == pytest.approx(before.imu.angles[:2], abs=math.radians(0.5))
    assert end.torso.position[2] == pytest.approx(before.torso.position[2], abs=0.003)
    assert end.positions == pytest.approx(before.positions, abs=math.radians(0.5))
    assert one.robot.joints.corrections == {}


def test_without_push_recovery_the_same_push_throws_it_over(bench):
    one = bench()
    one.robot.stability.balance.enabled = False
    one.run(0.5)
    shove(one, "back")
    assert one.run(2.5).torso.position[2] < 0.15


def test_nobody_sees_corrections_in_the_commands(bench):
    one = bench()
    one.run(0.5)
    shove(one, "front")
    corrected = False
    for snapshot in ticks(one, 0.6):
        assert snapshot.commands == pytest.approx(STAND)
        corrected |= bool(one.robot.joints.corrections)
    assert corrected


@pytest.mark.parametrize("name", ["Stand", "StandInit", "StandZero", "Crouch"])
def test_a_robot_that_nobody_disturbs_stands_still_without_corrections(bench, name):
    one = bench(name)
    before = one.run(1.0)
    for _ in ticks(one, 10.0):
        assert one.robot.joints.corrections == {}
    assert math.dist(one.now.torso.position, before.torso.position) < 2e-4
    assert one.now.imu.angles == pytest.approx(before.imu.angles, abs=math.radians(0.05))


def test_arms_that_move_slowly_call_for_next_to_nothing(bench):
    one = bench()
    one.run(0.5)
    one.aim(1.5, LShoulderPitch=-1.0, RShoulderPitch=-1.0)
    largest = 0.0
    for snapshot in ticks(one, 3.0):
        largest = max([largest, *map(abs, one.robot.joints.corrections.values())])
        assert max(map(abs, snapshot.imu.angles[:2])) < math.radians(1.5)
    assert largest < math.radians(1.0)


def test_arms_thrown_about_do_not_throw_the_robot(bench):
    one = bench()
    one.run(0.5)
    for turn in range(6):
        angle = (-1.2, 1.4)[turn % 2]
        one.aim(8.0, LShoulderPitch=angle, RShoulderPitch=angle)
        end = one.run(0.4)
    assert end.torso.position[2] == pytest.approx(0.331, abs=0.01)


def test_it_keeps_out_of_motions_of_the_legs(bench):
    one = bench("StandInit")
    one.run(0.5)
    task = posture_task(one.robot, "test", "Stand")
    while not task.finished:
        one.simulation.tick()
        assert task.finished or one.robot.joints.corrections == {}


def test_legs_that_are_not_stiff_get_no_corrections(bench):
    one = bench("Crouch")
    one.run(0.5)
    one.stiffen(0.2)
    shove(one, "front")
    for _ in ticks(one, 0.5):
        assert one.robot.joints.corrections == {}
