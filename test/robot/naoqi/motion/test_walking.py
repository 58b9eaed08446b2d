"""Walking: to places and at velocities, its end in all ways, footsteps, and what keeps a walk from beginning."""

import re

import pytest

from nao_sim_bridge.naoqi.motion.move_config import gait_list

WITH_SPEED = "setFootStepsWithSpeed"
MARCH = (["LLeg", "RLeg"] * 6, [[0.04, 0.1, 0.0], [0.04, -0.1, 0.0]] * 6)
LONGEST = 20.0
"""No walk of steps here takes longer, s of simulated time."""
WALL = "{name: wall, box: [0.1, 2.0, 1.0], position: [1.0, 0.0, 0.5]}"


@pytest.mark.parametrize("end", ["stopMove", "cancel"])
def test_a_move_that_is_stopped_ends_on_two_feet(walker, end):
    move = walker.begin("moveTo", 1.0, 0.0, 0.0)
    if end == "cancel":
        move.cancel()
        with pytest.raises(RuntimeError):
            walker.answer(move)
        assert move.isCanceled()
        walker.settled()
    else:
        stop = walker.begin("stopMove", after=0.0)
    walker.until_it_stands()
    if end == "stopMove":
        assert walker.answer(stop) is True and walker.answer(move) is False
    assert walker.stands and 0.02 < walker.truth[0] < 0.5


@pytest.mark.parametrize(
    "method, arguments, least",
    [
        ("move", (0.0, 0.0, 0.4, [["MaxStepTheta", 0.2], ["Frequency", 1.0]]), (None, None, 0.25)),
        ("moveToward", (0.0, -0.8, 0.0, [["LeftStepHeight", 0.03], ["RightStepHeight", 0.015]]), (None, -0.02, None)),
        ("setWalkTargetVelocity", (0.8, 0.0, 0.0, 1.0), (0.03, None, None)),
        ("setWalkTargetVelocity", (0.8, 0.0, 0.0, 1.5), (0.03, None, None)),
        ("setWalkTargetVelocity", (1.0, 0.0, 0.0, 1.0, [["MaxStepX", 0.03]], [["MaxStepX", 0.04]]), (0.02, None, None)),
    ],
)
def test_a_walk_at_a_velocity_goes_where_it_is_told_to(walker, motion, method, arguments, least):
    assert getattr(motion, method)(*arguments) is None
    assert motion.moveIsActive() and motion.walkIsActive()
    walker.advance(3.0)
    assert all(wanted is None or came / wanted > 1.0 for came, wanted in zip(walker.truth, least)), walker.truth


@pytest.mark.parametrize("method", ["killMove", "killTask"])
def test_a_killed_walk_is_over_at_once(walker, motion, method):
    move = walker.begin("moveTo", 1.0, 0.0, 0.0, after=1.0)
    ((name, number),) = motion.getTaskList()
    assert name == "moveTo" and motion.areResourcesAvailable(["LLeg"]) is False
    getattr(motion, method)(*[number] * (method == "killTask"))
    assert motion.moveIsActive() is False and motion.getTaskList() == [] and walker.answer(move) is False
    before = motion.getAngles("Legs", False)
    walker.advance(0.3)
    assert motion.getAngles("Legs", False) == pytest.approx(before, abs=1e-3)


def test_a_rest_brings_a_walk_to_its_end(walker, motion):
    move = walker.begin("moveTo", 1.0, 0.0, 0.0, after=2.3)
    change = walker.begin("rest", after=0.0)
    walker.advance_until(lambda: not change.isRunning(), 20.0, 0.5)
    assert walker.answer(change) is None and walker.answer(move) is False
    assert not motion.moveIsActive() and walker.now.torso.position[2] > 0.2
    assert walker.value("ALMotion/RobotIsStand") is True


def test_arms_swing_unless_they_may_not(walker, motion):
    motion.setMoveArmsEnabled(True, False)
    assert [motion.getMoveArmsEnabled(name) for name in ("LArm", "RArm", "Arms")] == [True, False, False]
    assert motion.getWalkArmsEnabled() == [True, False]
    motion.move(0.08, 0.0, 0.0)
    walker.advance(2.0)
    arms = []
    for _ in range(5):
        walker.advance(0.15)
        arms.append([round(angle, 2) for angle in motion.getAngles(["LShoulderPitch", "RShoulderPitch"], False)])
    assert [len(set(angles)) > 1 for angles in zip(*arms)] == [True, False]
    motion.setWalkArmsEnabled(True, True)
    assert motion.getMoveArmsEnabled("Arms") is True


@pytest.mark.parametrize("replaced", [True, False])
def test_steps_that_are_not_begun_can_be_replaced_and_stopped(walker, motion, replaced):
    future = walker.begin(WITH_SPEED, *MARCH, [1.0], False, after=2.0)
    if replaced:
        steps = (["LLeg", "RLeg"], [[0.0, 0.1, 0.0], [0.0, -0.1, 0.0]], [1.0], True)
        end = walker.begin(WITH_SPEED, *steps, after=0.1)
    else:
        end = walker.begin("stopMove", after=0.0)
    walker.until_it_stands()
    assert walker.answer(end) is (None if replaced else True) and walker.answer(future) is None
    assert walker.now.torso.position[0] < 0.3


def timed(period, since=0, count=6):
    """Arguments of setFootSteps: steps of 4 cm from number `since` on, each `period` s after the one before."""
    steps = range(since, count)
    places = [[0.04, -0.1 if n % 2 else 0.1, 0.0] for n in steps]
    return ["RLeg" if n % 2 else "LLeg" for n in steps], places, [period * (n + 1) for n in steps]


def test_slow_steps_go_as_far_as_fast_ones(walker, motion):
    motion.setFootSteps(*timed(2.0), False)
    walker.until_it_stands()
    assert walker.stands and walker.truth[0] == pytest.approx(0.22, abs=0.02)


@pytest.mark.parametrize("clock", ["of the walk", "of each call"])
def test_steps_that_are_planned_again_and_again_keep_their_pace(walker, motion, clock):
    motion.setFootSteps(*timed(0.6), False)
    assert [len(part) for part in motion.getFootSteps()] == [2, 0, 6]
    begun, plans, speeds = walker.now.time, 0, []
    while motion.moveIsActive() and walker.now.time < begun + LONGEST:
        walker.advance(0.1)
        _, made, further = motion.getFootSteps()
        speeds.append(motion.getRobotVelocity()[0])
        if made and further:
            legs, places, times = timed(0.6, since=6 - len(further))
            late = 0.0 if clock == "of the walk" else times[0] - 0.6
            motion.setFootSteps(legs, places, [time - late for time in times], True)
            plans += 1
    assert plans > 20 and walker.now.time - begun < 6.0 and max(speeds) == pytest.approx(0.04 / 0.6, rel=0.01)
    assert walker.stands and walker.truth[0] == pytest.approx(0.22, abs=0.02)


def test_limp_legs_do_not_walk_and_that_is_told(walker, motion, caplog):
    motion.setStiffnesses("Body", 0.0)
    moves = [("moveTo", False, 0.1, 0.0, 0.0), ("moveInit", None), ("move", None, 0.1, 0.0, 0.0)]
    for count, (method, answer, *arguments) in enumerate(moves, 1):
        assert motion.call(method, *arguments) is answer and motion.moveIsActive() is False
        (warning,) = [record.getMessage() for record in caplog.records if record.name == "nao_sim.walk"]
        assert "ALMotion::moveTo does not move the robot: stiffness of LHipYawPitch" in warning
        cause, status, obstacle = walker.failures[-1]
        assert len(walker.failures) == count and "LHipYawPitch" in cause and (status, obstacle) == (0, None)


def test_an_obstacle_ends_a_walk_before_it_unless_the_protection_is_off(walker, motion):
    walker.NaoSimulation.placeObject(WALL)
    assert walker.walk("moveTo", 1.5, 0.0, 0.0) is False
    ((cause, status, obstacle),) = walker.failures
    assert "obstacle" in cause and status == 1 and obstacle[0] == pytest.approx(0.95, abs=0.1)
    gap = 0.95 - walker.truth[0]
    assert 0.2 < gap <= motion.getOrthogonalSecurityDistance() + 0.1 and walker.stands
    motion.setExternalCollisionProtectionEnabled("Move", False)
    there = walker.truth[0] + 0.1
    assert walker.walk("moveTo", 0.1, 0.0, 0.0) is True and walker.truth[0] == pytest.approx(there, abs=0.05)


def test_a_walk_at_a_velocity_begins_only_where_the_sonars_see_a_way(walker, motion, caplog):
    walker.NaoSimulation.placeObject(WALL)
    for _ in range(5):  # as a program that goes on commanding does
        walker.walk("moveToward", 1.0, 0.0, 0.0)
    gap = 0.95 - walker.truth[0]
    assert 0.3 < gap <= motion.getOrthogonalSecurityDistance() + 0.1
    assert [status for _, status, _ in walker.failures] == [1, 0, 0, 0, 0]
    (warning,) = [record.getMessage() for record in caplog.records if record.name == "nao_sim.walk"]
    assert re.search(r"moveToward does not move the robot: an obstacle 0\.\d+ m ahead", warning)
    walker.answer(walker.begin("moveToward", -1.0, 0.0, 0.0))
    assert 0.95 - walker.truth[0] > gap, "away from it"


def test_what_cannot_be_walked_is_refused_and_nothing_moves(walker, motion, refuses):
    assert motion.getMoveConfig("Max") == [[name, pytest.approx(value)] for name, value in gait_list("Max")]
    refuses("ALMotion", r"""
        moveTo(0.1, 0.0, 0.0, -1.0) -> time is -1.0, allowed is 0 or more
        moveTo([]) -> controlPoint is .*, allowed is a list of at least one
        move(1e300, 0.0, 0.0) -> x is 1e\+300, allowed is a finite number, -1e\+06 to 1e\+06
        move(0.1, 0.0, 0.0, [['MaxStpX', 0.04]]) -> unknown gait parameter 'MaxStpX': did you mean 'MaxStepX'
        moveToward(1.1, 0.0, 0.0) -> x is 1.1.*, allowed is -1 to 1
        setWalkTargetVelocity(1.0, 0.0, 0.0, -0.5) -> frequency is -0.5, allowed is 0 to 1
        setFootSteps(['LLeg', 'RLeg'], [[0, 0.1, 0], [0, -0.1, 0]], [0.6], False) -> timeList is .* as many as steps: 2
        setFootSteps(['LLeg'] * 2, [[0, 0.1, 0]] * 2, [0.6, 1.2], False) -> allowed is LLeg and RLeg in turns
        setFootStepsWithSpeed(['LLeg'], [[0, 0.1, 0]], [1.5], False) -> fractionMaxSpeed\[0\] is 1.5, allowed is 0 to 1
    """)  # fmt: skip
    assert motion.moveIsActive() is False
