"""Motions of several steps: waking up, resting, going to postures, key frames; and the diagnosis that lets go."""

import pytest

from nao_sim_bridge.control.balance.fall_manager import FallState
from nao_sim_bridge.control.balance.posture_recognition import Recognition, recognise
from nao_sim_bridge.core import posture_change, sequences
from nao_sim_bridge.core.diagnosis import SAFE_TIME, DiagnosisEffect
from nao_sim_bridge.core.posture_change import PostureChange
from nao_sim_bridge.core.posture_moves import KeyFrame, Move, load_moves, play
from nao_sim_bridge.core.sequences import posture_task, stiffness_task
from nao_sim_bridge.model.model_reader import load_model
from nao_sim_bridge.model.postures import posture

MODEL = load_model()
LONGEST = 60.0
FALLEN = {"LyingBelly": (60.0, 0.0, 0.0), "LyingBack": (-60.0, 0.0, 0.0)}
"""Pushes of 0.2 s that make a standing robot lie like this, N."""
STIFF, LIMP = (1.0,) * 26, (0.0,) * 26


def test_off_its_feet_it_only_stiffens_and_lets_go(bench):
    ended, one = [], bench("LyingBack", 0.0)
    one.run(0.5)
    # Where the weight of the body presses limp fingers to is no command they can have.
    before = [one.robot.joints.clamp_alone(i, angle) for i, angle in enumerate(one.now.positions)]
    sequences.wake_up(one.robot, lambda: one.now, lambda: ended.append("awake"))
    one.run(1.5)
    commands = one.now.commands
    assert commands == pytest.approx(before, abs=0.03) and one.now.stiffnesses == STIFF
    assert not sequences.is_on_feet(one.robot, one.now)
    posture_change.rest(one.robot, lambda: one.now, lambda: ended.append("asleep"))
    one.run(1.0)
    assert one.now.commands == commands and one.now.stiffnesses == LIMP and ended == ["awake", "asleep"]


def test_who_sits_leans_on_the_hands_before_it_lets_go(bench):
    one = bench("Sit")
    one.run(0.3)
    resting = posture_change.rest(one.robot, lambda: one.now, lambda: None)
    while not resting.finished and one.now.time < LONGEST:
        one.run(0.2)
    one.run(2.0)
    assert recognise(MODEL, one.now) == Recognition("SitRelax", "Sitting") and one.now.stiffnesses == LIMP


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


@pytest.mark.parametrize("name, angle", [("LElbowYaw", -1.0), ("LWristYaw", 0.8), ("HeadPitch", 0.2)])
def test_a_joint_in_the_air_with_less_torque_stays_within_half_a_degree_of_its_target(bench, name, angle):
    one = bench()
    one.aim(**{"RShoulderPitch": 0.5, name: angle})
    one.run(4.0)
    assert max(one.robot.joints.efforts) < 1.0
    assert one.joint(name) == pytest.approx(angle, abs=0.0087)


@pytest.fixture
def change():
    def make(one, goal, speed=1.0, tries=3, moves=()):
        return PostureChange(one.robot, lambda: one.now, goal, speed, tries, moves)

    return make


def finish(one, task, look=lambda: None):
    """Let time pass until the task ends, looking at each tick; how long that took, s."""
    begun = one.simulation.time
    while not task.finished and one.simulation.time < begun + LONGEST:
        one.simulation.tick()
        look()
    assert task.finished
    return one.simulation.time - begun


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


def test_lying_it_says_that_it_gets_up_and_gives_up_after_its_tries(bench, change):
    one = bench("LyingBack")
    nod = Move("LyingBack", "Stand", (KeyFrame(0.4, {0: 0.2}),))  # it only shakes its head
    way = change(one, "Stand", tries=2, moves=[nod])
    task = way.start()
    one.run(1.2)
    assert one.robot.getting_up
    finish(one, task)
    assert not way.reached and way.misses == 2 and not one.robot.getting_up
    assert way.failure == "LyingBack -> Stand ended in LyingBack, miss 2 of 2"
    way = change(one, "Stand")
    finish(one, way.start())
    assert not way.reached and way.failure == "no way leads there from LyingBack"


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


VERY_HOT, CRITICAL = 79.0, 95.0
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
