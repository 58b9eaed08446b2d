"""Balance, falls and pushes: what the law answers, what keeps a robot on its feet, and how it falls when it must."""

import math

import pytest

from nao_sim_bridge.body.touch_parts import LimbTouch
from nao_sim_bridge.control.balance.balance import Balance, load_balance
from nao_sim_bridge.control.balance.capture_point import BodyMotion
from nao_sim_bridge.control.balance.fall_manager import FallState
from nao_sim_bridge.control.balance.posture_recognition import recognise
from nao_sim_bridge.control.balance.push_detection import PushDetector
from nao_sim_bridge.control.balance.stance import StanceReader
from nao_sim_bridge.core import sequences
from nao_sim_bridge.core.sequences import posture_task
from nao_sim_bridge.model.model_reader import load_model
from nao_sim_bridge.model.postures import posture

MODEL = load_model()
READER, STAND = StanceReader(MODEL), posture(MODEL, "Stand")
SIDES = {"front": (1, 0), "back": (-1, 0), "left": (0, 1), "right": (0, -1)}
BODY = ("torso", "Head", "LBicep", "RBicep")
DT, DEGREE = 1 / 120, math.radians(1.0)
WATCHING, FALLING, FALLEN, RESTING = FallState.WATCHING, FallState.FALLING, FallState.FALLEN, FallState.RESTING


def ticks(one, seconds):
    """Each snapshot of the next `seconds` as it comes, so that the robot can be looked at in between."""
    for _ in range(round(seconds / one.simulation.settings.tick_s)):
        yield one.simulation.tick()


def shove(one, side, force=60.0):
    x, y = SIDES[side]
    one.push((force * x, force * y, 0.0), 0.1)


def falls(one):
    return one.robot.stability.falls


@pytest.fixture
def watched(bench):
    """Makes simulations whose robot has stood for a while."""

    def make(posture="Stand", **scene):
        one = bench(posture, **scene)
        one.run(0.8)
        assert falls(one).state is WATCHING and one.robot.stability.on_feet
        return one

    return make


def index(name):
    return MODEL.joint_index[name]


def body(lean=0.0, velocity=(0.0, 0.0)):
    """A body in Stand that leans by so much, rad, and moves at m/s."""
    roll, pitch = READER.lean(STAND)
    return BodyMotion(READER.read(STAND, roll, pitch + lean), velocity, 6.0)


@pytest.fixture
def law():
    """Balance of a robot that stands on a level floor."""
    made = Balance(load_balance(MODEL), READER)
    made.corrections(body(), STAND, DT)
    return made


@pytest.mark.parametrize("lean, velocity, sign", [(0.1, 0.0, 1), (-0.1, 0.0, -1), (0.0, 0.3, 1), (0.0, -0.3, -1)])
def test_a_swing_ahead_presses_the_toes_down_and_one_back_the_heels_until_it_is_over(law, lean, velocity, sign):
    found = law.corrections(body(lean, velocity=(velocity, 0.0)), STAND, DT)
    assert found[index("LAnklePitch")] == found[index("RAnklePitch")] and sign * found[index("LAnklePitch")] > 0.04
    assert law.acting
    for _ in range(30):
        found = law.corrections(body(), STAND, DT)
    assert found == {} and not law.acting
    law.corrections(body(0.1), STAND, DT)
    law.release()
    assert not law.acting and law.corrections(body(), STAND, DT) == {}


def test_swings_to_left_and_right_are_answered_alike_and_within_the_limit(law):
    left = law.corrections(body(velocity=(0.0, 0.4)), STAND, DT)
    law.release()
    right = law.corrections(body(velocity=(0.0, -0.4)), STAND, DT)
    assert set(left) == set(right) == {index("LAnkleRoll"), index("RAnkleRoll")}
    assert left == pytest.approx({joint: -value for joint, value in right.items()}, rel=0.05)
    for _ in range(20):
        found = law.corrections(body(0.8, velocity=(2.0, 0.0)), STAND, DT)
    assert max(map(abs, found.values())) == pytest.approx(load_balance(MODEL).limit, abs=1e-3)


@pytest.mark.parametrize(
    "name, side", [("Stand", "front"), ("StandInit", "back"), ("Stand", "left"), ("StandInit", "right")]
)
def test_a_push_of_two_newton_seconds_is_survived_unseen_in_commands_and_the_posture_comes_back(watched, name, side):
    one = watched(name)
    before, moved, corrected = one.now, 0.0, 0
    shove(one, side, 20.0)
    for snapshot in ticks(one, 2.5):
        assert snapshot.commands == pytest.approx(posture(MODEL, name)) and falls(one).state is WATCHING
        corrected += bool(one.robot.joints.corrections)
        moved = max(moved, *(abs(a - b) for a, b in zip(snapshot.imu.angles[:2], before.imu.angles)))
    assert moved > 0.01 and corrected and one.robot.joints.corrections == {}
    assert snapshot.imu.angles[:2] == pytest.approx(before.imu.angles[:2], abs=DEGREE / 2)
    assert snapshot.torso.position[2] == pytest.approx(before.torso.position[2], abs=0.003)
    assert snapshot.positions == pytest.approx(before.positions, abs=DEGREE / 2)


def test_balance_keeps_out_of_motions_of_the_legs_of_soft_legs_and_of_a_walk(watched):
    one = watched("StandInit")
    task = posture_task(one.robot, "test", "Stand")
    while not task.finished:
        one.simulation.tick()
        assert task.finished or one.robot.joints.corrections == {}
    soft, walking = watched("Crouch"), watched("StandInit")
    soft.stiffen(0.2)
    shove(soft, "front", 20.0)
    assert all(soft.robot.joints.corrections == {} for _ in ticks(soft, 0.5))
    shove(walking, "front", 25.0)
    walking.run(0.1)
    assert walking.robot.stability.balance.acting
    walking.robot.stability.walk = lambda: (0.0, 0.0)
    walking.run(0.3)
    assert not walking.robot.stability.balance.acting and walking.robot.joints.corrections == {}
    assert not falls(walking).falling


@pytest.mark.parametrize("side", SIDES)
def test_a_fall_is_noticed_well_before_the_impact_and_made_gentle(watched, side):
    one = watched()
    x, y = SIDES[side]
    head = [index("HeadYaw")]
    task = one.robot.motion.follow("test", head, lambda now: {head[0]: sequences.Ramp(now[head[0]], 1.0, 0.01)})
    shove(one, side)
    start, seen, noticed, impact, limp, families = one.now.torso.position, [], None, None, None, []
    for snapshot in ticks(one, 4.0):
        seen.append(falls(one).state)
        families += [recognise(MODEL, snapshot).family] if snapshot.tick % 12 == 0 else []
        if noticed is None and falls(one).falling:
            noticed = snapshot.time
            assert task.killed and one.robot.motion.tasks() == [], "a fall ends every motion"
        if limp is None and max(snapshot.stiffnesses) == 0.0:
            limp = snapshot
        if impact is None and any(one.robot.link_name(contact.link) in BODY for contact in snapshot.contacts):
            impact = snapshot.time
            assert max(snapshot.stiffnesses) == 0.0, "motors let go before the body hits the floor"
    assert list(dict.fromkeys([WATCHING, *seen])) == [WATCHING, FALLING, FALLEN]
    assert impact is None or impact - noticed > 0.2
    assert falls(one).direction[0] * x + falls(one).direction[1] * y > 0.8
    assert (one.now.torso.position[0] - start[0]) * x + (one.now.torso.position[1] - start[1]) * y > 0.1
    assert set(one.now.stiffnesses) == {0.0} and one.now.torso.position[2] < 0.15
    angle = dict(zip((joint.name for joint in MODEL.joints), limp.positions))
    if side == "front":
        assert max(angle["LShoulderPitch"], angle["RShoulderPitch"]) < 0.6 and angle["HeadPitch"] < -0.3
        assert families[-1] == "LyingBelly"
    elif side == "back":
        assert families[-1] == "LyingBack"
    else:
        lower, other = ("L", "R") if side == "left" else ("R", "L")
        assert abs(angle[f"{lower}ElbowRoll"]) > 1.2 and abs(angle[f"{other}ElbowRoll"]) < 0.6
        assert {"left": "LyingLeft", "right": "LyingRight"}[side] in families
        assert {"left": "LyingRight", "right": "LyingLeft"}[side] not in families


def test_legs_that_walk_out_from_under_the_body_and_a_lost_walk_make_a_fall(watched):
    one = watched("StandInit")
    one.aim(2.0, LAnklePitch=-0.9, RAnklePitch=-0.9)
    assert any(falls(one).falling for _ in ticks(one, 2.0))
    one = watched("StandInit")
    one.robot.stability.walk = lambda: (-0.05, 0.0)
    one.run(0.1)
    assert not falls(one).falling
    one.robot.stability.walk = lambda: (-0.3, 0.0)
    one.simulation.tick()
    assert falls(one).falling and falls(one).direction == (-1.0, 0.0)


@pytest.fixture
def pushes(bench):
    """A robot that has stood for a while, and the pushes that it has noticed."""
    one, found = bench(), []
    detector = PushDetector(one.model.total_mass)

    def look(snapshot):
        found.extend(filter(None, [detector.look(snapshot, lambda: not any(one.robot.joints.velocities))]))

    one.simulation.after_tick.append(look)
    one.run(1.5)
    return one, found


@pytest.mark.parametrize("angle", [0.0, 90.0, -90.0, 180.0])
def test_a_push_is_noticed_once_with_where_it_went_and_how_hard_it_was(pushes, angle):
    (one, found), turn = pushes, math.radians(angle)
    for force in (15.0, 19.0):
        one.push((force * math.cos(turn), force * math.sin(turn), 0.0), 0.1)
        one.run(2.0)
    assert len(found) == 2 and found[1].energy > 1.3 * found[0].energy
    for push in found:
        assert abs(math.remainder(push.angle - turn, 2.0 * math.pi)) < 0.4 and 0.003 < push.energy < 1.0


def held(one, seconds):
    """What limbs are told as touched in the next seconds."""
    limbs, told = LimbTouch(one.model), [None]
    for snapshot in one.watch(seconds):
        now = limbs.look(snapshot)
        told += [now] * (now != told[-1])
    return told[1:]


def test_an_arm_that_is_pulled_is_touched_until_it_is_let_go_and_nothing_else_looks_like_that(bench):
    one, moving, limp = bench(), bench(), bench()
    one.run(0.2)
    one.push((12.0, 0.0, 0.0), 1.5, "l_wrist")
    assert held(one, 3.0) == [frozenset(), {"LArm"}, frozenset()]
    moving.run(1.0)
    moving.aim(1.0, RShoulderPitch=0.0, RElbowRoll=1.2)
    limp.stiffen(0.0, *limp.model.chains["LArm"])
    limp.run(0.2)
    limp.push((4.0, 0.0, 0.0), 1.0, "l_wrist")
    for untouched in (moving, limp):
        assert held(untouched, 1.0) == [frozenset()]
