"""Motions of several steps: waking up, resting, going to postures, key frames; and the diagnosis that lets go."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim.diagnosis import SAFE_TIME, DiagnosisEffect
from nao_sim_bridge.sim.fall_manager import FallState
from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.motion import sequences
from nao_sim_bridge.sim.motion.posture_change import PostureChange
from nao_sim_bridge.sim.motion.sequences import posture_task, run_steps, stiffness_task
from nao_sim_bridge.sim.posture_moves import KeyFrame, Move, load_moves, play
from nao_sim_bridge.sim.posture_recognition import Recognition, recognise
from nao_sim_bridge.sim.postures import posture

MODEL = load_model()
LONGEST = 60.0
FALLEN = {"LyingBelly": (60.0, 0.0, 0.0), "LyingBack": (-60.0, 0.0, 0.0)}
"""Pushes of 0.2 s that make a standing robot lie like this, N."""
STIFF, LIMP = (1.0,) * 26, (0.0,) * 26


@pytest.fixture
def ended():
    return []


def wake_up(one, ended):
    return sequences.wake_up(one.robot, lambda: one.now, lambda: ended.append("awake"))


def rest(one, ended):
    return sequences.rest(one.robot, lambda: one.now, lambda: ended.append("asleep"))


def test_waking_up_from_a_limp_crouch_stands_stiff_without_a_jump_and_resting_crouches_and_lets_go(bench, ended):
    one = bench("Crouch", 0.0)
    one.run(0.5)
    before, task = one.now.positions, wake_up(one, ended)
    one.run(sequences.STIFFEN_TIME)
    assert max(abs(a - b) for a, b in zip(before, one.now.positions)) < 0.03
    one.run(2.5 - sequences.STIFFEN_TIME)
    assert task.finished and not task.killed and ended == ["awake"] and one.now.stiffnesses == STIFF
    assert one.now.torso.position[2] == pytest.approx(0.331, abs=0.005) and sequences.is_on_feet(one.robot, one.now)
    task = rest(one, ended)
    one.run(2.5)
    assert task.finished and ended == ["awake", "asleep"] and one.now.stiffnesses == LIMP
    assert one.now.torso.position[2] == pytest.approx(0.228, abs=0.01)
    commands = one.now.commands
    rest(one, ended)
    one.run(0.3)
    assert ended[2:] == ["asleep"] and one.now.commands == commands, "resting a limp robot moves nothing"


@pytest.mark.parametrize("posture", ["SitRelax", "LyingBelly", "LyingBack"])
def test_off_its_feet_it_only_stiffens_and_lets_go(bench, ended, posture):
    one = bench(posture, 0.0)
    one.run(0.5)
    # Where the weight of the body presses limp fingers to is no command they can have.
    before = [one.robot.joints.clamp_alone(i, angle) for i, angle in enumerate(one.now.positions)]
    wake_up(one, ended)
    one.run(1.5)
    commands = one.now.commands
    assert commands == pytest.approx(before, abs=0.03) and one.now.stiffnesses == STIFF
    assert not sequences.is_on_feet(one.robot, one.now)
    rest(one, ended)
    one.run(1.0)
    assert one.now.commands == commands and one.now.stiffnesses == LIMP and ended == ["awake", "asleep"]


@pytest.mark.parametrize("seconds", [0.1, 1.0])
def test_a_killed_awakening_stops_in_whatever_step_it_is(bench, ended, seconds):
    one, other = bench("Crouch", 0.0), bench("Crouch", 0.0)
    task, same = wake_up(one, ended), wake_up(other, ended)
    for each in (one, other):
        each.run(seconds)
    assert task.kill() and one.robot.motion.tasks() == []
    commands = one.now.commands
    one.run(1.0)
    assert task.killed and one.now.commands == commands
    other.robot.motion.kill_all()
    assert same.killed and same.finished and ended == [], "killing the step ends the whole"


def test_steps_run_in_order_each_after_the_end_of_the_one_before(bench):
    one, order = bench(), []

    def step(name, target=None):
        def run():
            order.append((name, one.simulation.ticks))
            return target and stiffness_task(one.robot, name, [0], target, 0.1)

        return run

    task = run_steps(one.robot, "story", [step("a"), step("b", 0.5), step("c"), step("d", 0.8)])
    assert [name for name, _ in order] == ["a", "b"]
    one.run(0.3)
    assert [name for name, _ in order] == ["a", "b", "c", "d"]
    assert order[2][1] == order[3][1] >= order[1][1] + round(0.1 / one.simulation.settings.tick_s)
    assert task.finished and task.name == "story" and one.now.stiffnesses[0] == 0.8
    assert run_steps(one.robot, "nothing", []).finished


def test_postures_and_key_frames_are_reached_exactly_in_their_time(bench):
    one, tick = bench("Stand"), 1 / 120
    task = posture_task(one.robot, "goToPosture", "Crouch", duration=1.0)
    one.run(1.0 - 2 * tick)
    assert not task.finished
    one.run(3 * tick)
    assert task.finished and one.now.commands == pytest.approx(posture(MODEL, "Crouch"), abs=1e-12)
    head, wrist, other = (MODEL.joint_index[name] for name in ("HeadYaw", "LWristYaw", "RWristYaw"))
    frames = (KeyFrame(0.25, {head: 0.3}), KeyFrame(0.25, {wrist: 0.2}), KeyFrame(0.5, {head: -0.2}))
    task = play(one.robot, "goToPosture", Move("Stand", "Stand", frames))
    one.aim(RWristYaw=1.0)
    one.run(0.5)
    assert one.now.commands[wrist] == pytest.approx(0.2) and -0.2 < one.now.commands[head] < 0.3
    one.run(0.5)
    expected = [{head: -0.2, wrist: 0.2}.get(i, angle) for i, angle in enumerate(posture(MODEL, "Crouch"))]
    assert task.finished and one.now.commands == pytest.approx(expected), "it holds the whole body"
    assert one.robot.motion.tasks() == [] and one.now.commands[other] == expected[other]


@pytest.fixture
def change():
    def make(one, goal, speed=1.0, tries=3, moves=()):
        return PostureChange(one.robot, lambda: one.now, goal, speed, tries, moves)

    return make


@pytest.fixture
def fallen(bench):
    def make(family):
        one = bench("Stand")
        one.push(FALLEN[family], 0.2)
        one.run(1.5)
        assert recognise(one.model, one.now).family == family
        return one

    return make


def finish(one, task, look=lambda: None):
    """Let time pass until the task ends, looking at each tick; how long that took, s."""
    begun = one.simulation.time
    while not task.finished and one.simulation.time < begun + LONGEST:
        one.simulation.tick()
        look()
    assert task.finished
    return one.simulation.time - begun


def nod(duration=0.4):
    """A move that only shakes the head, whatever it says."""
    return [Move("LyingBack", "Stand", (KeyFrame(duration, {0: 0.2}),))]


@pytest.mark.parametrize("start, goal", [("Crouch", "StandZero"), ("StandZero", "Crouch"), ("StandInit", "Stand")])
def test_it_goes_there_knows_it_and_stays_there(bench, change, start, goal):
    one = bench(start)
    older = [posture_task(one.robot, "old", "Crouch"), stiffness_task(one.robot, "old", [3], 0.0, 5.0)]
    one.aim(HeadYaw=1.0)
    way, up = change(one, goal), []
    task = way.start()
    assert [done.killed for done in older] == [True, True], "what moved the joints before ends"
    assert finish(one, task, lambda: up.append(one.robot.getting_up)) < 3.0 and not any(up)
    assert task.value is True and way.reached and way.failure == ""
    assert recognise(one.model, one.now).posture == goal and one.robot.motion.tasks() == []
    assert one.now.commands == pytest.approx(posture(one.model, goal))
    before = one.now.commands
    assert finish(one, change(one, goal).start()) < 0.5 and one.now.commands == before
    one.aim(LShoulderPitch=1.2, HeadYaw=0.5)
    one.run(0.5)
    finish(one, change(one, goal).start())
    assert one.now.commands == pytest.approx(posture(one.model, goal)), "nearly there is not there"


def test_a_limp_robot_gets_stiff_first_unless_it_goes_straight_and_slow_is_slower(bench, change):
    one, limp = bench("Crouch", 0.0), bench("Crouch", 0.0)
    one.run(0.3)
    task, straight = change(one, "Stand").start(), change(limp, "Stand").start_straight()
    finish(one, task)
    finish(limp, straight)
    assert (task.value, straight.value) == (True, False) and (one.now.stiffnesses, limp.now.stiffnesses) == (
        STIFF,
        LIMP,
    )
    quick, slow = (
        finish(each, change(each, "Stand", s).start()) for each, s in ((bench("Crouch"), 1.0), (bench("Crouch"), 0.25))
    )
    assert slow > 2.5 * quick


@pytest.mark.parametrize("seconds", [0.1, 0.7])
def test_killed_or_overtaken_it_stops_where_it_is(bench, change, seconds):
    one = bench("Crouch")
    way = change(one, "Stand")
    task = way.start()
    one.run(seconds)
    assert task.kill() and task.value is False and not way.reached
    before = one.now.commands
    one.run(0.5)
    assert one.now.commands == before and one.robot.motion.tasks() == []
    first = change(one, "Stand").start()
    one.run(seconds)
    second = change(one, "Crouch").start()
    assert first.finished and first.value is False
    finish(one, second)
    assert second.value is True and recognise(one.model, one.now).posture == "Crouch"


def test_off_its_feet_it_says_that_it_gets_up_and_gives_up_after_its_tries(fallen, change):
    one, up = fallen("LyingBack"), []
    way = change(one, "Stand", tries=2, moves=nod())
    finish(one, way.start())
    assert not way.reached and way.misses == 2
    assert way.failure == "LyingBack -> Stand ended in LyingBack, miss 2 of 2"
    task = change(one, "Stand", tries=1, moves=nod(1.0)).start()
    finish(one, task, lambda: up.append(one.robot.getting_up))
    assert 1.0 <= sum(up) * one.simulation.settings.tick_s <= 3.2 and not one.robot.getting_up
    task = change(one, "Stand", moves=nod(2.0)).start()
    one.run(1.5)
    assert one.robot.getting_up
    task.kill()
    assert not one.robot.getting_up
    way = change(one, "Stand")
    finish(one, way.start())
    assert not way.reached and way.failure == "no way leads there from LyingBack"
    task = change(one, "StandZero").start_straight()  # asks nobody where it is
    finish(one, task)
    assert task.value is True and one.now.commands == pytest.approx(posture(MODEL, "StandZero"))
    assert recognise(one.model, one.now) == Recognition("Unknown", "LyingBack")


@pytest.mark.parametrize("family", FALLEN)
def test_a_robot_that_fell_gets_up_and_is_watched_again(bench, change, family):
    one = bench("Stand")
    one.run(0.8)
    one.push(FALLEN[family], 0.1)
    one.run(3.0)
    falls = one.robot.stability.falls
    assert falls.state is FallState.FALLEN and recognise(one.model, one.now).family == family
    task = change(one, "Stand", moves=load_moves()).start()
    finish(one, task)
    one.run(1.0)
    assert task.value is True and recognise(one.model, one.now) == Recognition("Stand", "Standing")
    assert falls.state is FallState.WATCHING
    one.push(FALLEN["LyingBack"], 0.1)
    one.run(1.0)
    assert falls.state is not FallState.WATCHING


@pytest.mark.parametrize("start, goal", [("Stand", "Sit"), ("SitRelax", "LyingBack"), ("Crouch", "LyingBelly")])
def test_it_leaves_its_feet_and_its_seat_without_a_crash(bench, change, start, goal):
    one, felt = bench(start), []
    one.run(1.0)
    task = change(one, goal, moves=load_moves()).start()
    finish(one, task, lambda: felt.append(max(map(abs, one.now.imu.accelerometer))))
    assert task.value is True and recognise(one.model, one.now).posture == goal and max(felt) < 10 * 9.81


def test_the_arms_of_who_sits_make_way_for_the_legs(bench, change):
    one = bench("Sit")
    one.run(1.0)
    for goal in ("SitRelax", "Sit"):
        task = change(one, goal).start()
        finish(one, task)
        assert task.value is True and recognise(one.model, one.now) == Recognition(goal, "Sitting")


VERY_HOT, CRITICAL, COLD = 79.0, 95.0, 40.0
# Looks a few times a second, and rests: posture, then stiffness.
SOON, RESTED = 0.2, SAFE_TIME + 0.6


@pytest.fixture
def one(bench):
    return bench()


@pytest.fixture
def effect(one):
    made = DiagnosisEffect(lambda: one.robot, lambda: made.rests.append(True))
    made.rests = []
    one.simulation.after_tick.append(made)
    return made


def heat(one, celsius, *names, after=SOON):
    for name in names:
        one.robot.warm_up(name, celsius)
    one.run(after)


def stiffness(one, *chains):
    return {one.robot.joints.stiffnesses[MODEL.joint_index[joint]] for name in chains for joint in MODEL.chains[name]}


def test_a_very_hot_arm_goes_to_a_safe_posture_before_it_lets_go_and_a_critical_one_lets_go_at_once(one, effect):
    heat(one, VERY_HOT, "LElbowRoll")
    assert effect.disabled == {"LArm"} and stiffness(one, "LArm") == {1.0}
    one.run(RESTED)
    assert stiffness(one, "LArm") == {0.0} and stiffness(one, "RArm", "LLeg") == {1.0}
    for name in MODEL.chains["LArm"]:
        index = MODEL.joint_index[name]
        assert one.now.commands[index] == pytest.approx(posture(MODEL, "Crouch")[index])
    heat(one, CRITICAL, "RShoulderPitch")
    assert stiffness(one, "RArm") == {0.0}


def test_a_hot_chain_stays_limp_whatever_anybody_wants_until_it_is_cold(one, effect):
    heat(one, CRITICAL, "HeadYaw", after=1.0)
    one.stiffen(1.0, "HeadYaw", "HeadPitch", "LShoulderPitch")
    one.run(SOON)
    assert stiffness(one, "Head") == {0.0} and stiffness(one, "LArm") == {1.0}
    heat(one, COLD, "HeadYaw")
    assert effect.disabled == frozenset() and stiffness(one, "Head") == {0.0}, "somebody has to ask for it"
    one.stiffen(1.0, "HeadYaw", "HeadPitch")
    assert stiffness(one, "Head") == {1.0}
    heat(one, CRITICAL, "HeadYaw")
    one.simulation.reset()
    one.run(SOON)
    assert effect.disabled == frozenset(), "a new robot is cold"


def test_very_hot_legs_crouch_and_the_whole_robot_rests(one, effect):
    heat(one, VERY_HOT, "LKneePitch", after=RESTED)
    assert effect.disabled == {"Legs"} and effect.rests == [True] and set(one.robot.joints.stiffnesses) == {0.0}
    assert one.joint("LKneePitch") == pytest.approx(posture(MODEL, "Crouch")[MODEL.joint_index["LKneePitch"]], abs=0.1)
    assert one.robot.reflexes.wake_forbidden
    heat(one, COLD, "LKneePitch")
    assert not one.robot.reflexes.wake_forbidden


def test_switched_off_it_only_watches_and_sees_when_it_is_switched_on(one, effect):
    one.robot.reflexes.diagnosis_enabled = False
    heat(one, CRITICAL, "RWristYaw")
    assert effect.disabled == frozenset() and stiffness(one, "RArm") == {1.0}
    one.robot.reflexes.diagnosis_enabled = True
    one.run(SOON)
    assert effect.disabled == {"RArm"}
