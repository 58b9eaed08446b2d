"""Walking over the network: to places and at velocities, its end in all ways, and the arms meanwhile."""

from __future__ import annotations

import math

import pytest

MOTION, POSTURE = "ALMotion", "ALRobotPosture"
LONGEST = 40.0


@pytest.fixture
def motion(walker):
    return walker.motion


# --- to a place -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "arguments, there",
    [
        ((0.15, 0.0, 0.0), (0.15, 0.0, 0.0)),
        ((0.0, 0.1, 0.5), (0.0, 0.1, 0.5)),
        (([[0.1, 0.0, 0.0], [0.15, 0.05, 0.3]],), (0.15, 0.05, 0.3)),
    ],
)
def test_a_move_answers_when_the_robot_stands_where_it_was_sent(walker, motion, arguments, there):
    assert walker.walk("moveTo", *arguments) is True
    assert motion.getRobotPosition(True) == pytest.approx(there, abs=0.03)
    x, y, turn = walker.truth
    assert turn == pytest.approx(there[2], abs=0.1)
    assert (x, y) == pytest.approx(there[:2], abs=0.05)
    assert walker.stands


def test_walk_to_is_an_older_name_of_move_to(walker):
    assert walker.walk("walkTo", 0.08, 0.0, 0.0, [["StepHeight", 0.03]]) is True
    assert walker.truth[0] == pytest.approx(0.08, abs=0.05)


def test_a_move_may_be_given_more_time_than_it_needs(walker):
    begun = walker.now.time
    assert walker.walk("moveTo", 0.1, 0.0, 0.0, 9.0, [["MaxStepX", 0.06]]) is True
    assert walker.now.time - begun > 9.0


def test_a_move_that_is_stopped_answers_false_and_ends_on_two_feet(walker):
    move = walker.begin("moveTo", 1.0, 0.0, 0.0, after=4.0)
    stop = walker.post(MOTION, "stopMove")
    walker.handed_over(MOTION)
    walker.until_it_stands()
    assert walker.answer(stop) is True
    assert walker.answer(move) is False
    assert walker.stands
    assert 0.05 < walker.truth[0] < 0.5


def test_the_next_place_replaces_the_one_before(walker):
    first = walker.begin("moveTo", 1.0, 0.0, 0.0)
    second = walker.begin("moveTo", 0.05, 0.05, 0.0, after=0.1)
    assert walker.answer(first) is False
    walker.until_it_stands()
    assert walker.answer(second) is True
    assert walker.truth[0] < 0.3


def test_a_cancelled_move_ends_on_two_feet(walker):
    move = walker.begin("moveTo", 1.0, 0.0, 0.0, after=4.0)
    move.cancel()
    with pytest.raises(RuntimeError):
        walker.answer(move)
    assert move.isCanceled()
    walker.settled()
    walker.until_it_stands()
    assert walker.stands
    assert walker.truth[0] < 0.5


def test_a_posted_move_is_stopped_by_its_number(walker, motion):
    number = motion.pCall("moveTo", 1.0, 0.0, 0.0)
    walker.advance(4.0)
    assert motion.isRunning(number) is True
    motion.stop(number)
    walker.settled()
    assert motion.isRunning(number) is False
    walker.until_it_stands()
    assert walker.stands


# --- at a velocity ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "method, arguments, least",
    [
        ("move", (0.06, 0.0, 0.0), (0.1, None, None)),
        ("move", (0.0, 0.0, 0.4, [["MaxStepTheta", 0.2], ["Frequency", 1.0]]), (None, None, 0.6)),
        ("moveToward", (-1.0, 0.0, 0.0), (-0.1, None, None)),
        ("moveToward", (0.0, -0.8, 0.0, [["LeftStepHeight", 0.03], ["RightStepHeight", 0.015]]), (None, -0.05, None)),
        ("setWalkTargetVelocity", (0.8, 0.0, 0.0, 1.0), (0.1, None, None)),
        ("setWalkTargetVelocity", (0.8, 0.0, 0.0, 0.0, [["MaxStepX", 0.06]]), (0.1, None, None)),
        ("setWalkTargetVelocity", (1.0, 0.0, 0.0, 1.0, [["MaxStepX", 0.03]], [["MaxStepX", 0.04]]), (0.1, None, None)),
    ],
)
def test_a_walk_at_a_velocity_goes_on_until_it_is_stopped(walker, motion, method, arguments, least):
    assert getattr(motion, method)(*arguments) is None
    assert motion.moveIsActive() and motion.walkIsActive()
    walker.advance(6.0)
    for came, wanted in zip(walker.truth, least):
        assert wanted is None or came / wanted > 1.0
    walker.walk("stopMove")
    assert walker.stands


def test_a_walk_takes_up_another_velocity(walker, motion):
    motion.move(0.06, 0.0, 0.0)
    walker.advance(4.0)
    motion.move(0.0, 0.0, 0.5)
    walker.advance(2.0)
    before = walker.truth
    walker.advance(2.0)
    after = walker.truth
    assert after[2] - before[2] > 0.4
    assert math.dist(after[:2], before[:2]) < 0.06
    velocity = motion.getRobotVelocity()
    assert velocity[2] == pytest.approx(0.5, abs=0.1)


def test_no_velocity_ends_a_walk(walker, motion):
    motion.moveToward(1.0, 0.0, 0.0)
    walker.advance(3.0)
    motion.moveToward(0.0, 0.0, 0.0)
    walker.until_it_stands()
    assert walker.stands


def test_a_place_replaces_a_velocity(walker, motion):
    motion.move(0.06, 0.0, 0.0)
    walker.advance(3.0)
    assert walker.walk("moveTo", 0.1, 0.0, 0.0) is True
    assert walker.stands


# --- the end of a walk ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("method", ["waitUntilMoveIsFinished", "waitUntilWalkIsFinished"])
def test_waiting_ends_with_the_walk(walker, method):
    move = walker.begin("moveTo", 0.1, 0.0, 0.0)
    wait = walker.post(MOTION, method)
    walker.handed_over(MOTION)
    assert wait.isRunning()
    walker.until_it_stands()
    assert walker.answer(wait) is None
    assert walker.answer(move) is True


def test_who_no_longer_waits_does_not_stop_the_walk(walker, motion):
    motion.move(0.05, 0.0, 0.0)
    wait = walker.begin("waitUntilMoveIsFinished")
    wait.cancel()
    walker.settled()
    walker.advance(2.0)
    assert motion.moveIsActive()
    assert motion.getRobotVelocity()[0] > 0.03


@pytest.mark.parametrize(
    "method", ["stopMove", "stopWalk", "killMove", "killWalk", "waitUntilMoveIsFinished", "waitUntilWalkIsFinished"]
)
def test_a_robot_that_stands_needs_no_end_of_a_walk(walker, method):
    answer = walker.answer(walker.post(MOTION, method))
    assert answer is (True if method.startswith("stop") else None)


@pytest.mark.parametrize("method", ["killMove", "killWalk", "killAll", "killTask", "killTasksUsingResources"])
def test_a_killed_walk_is_over_at_once(walker, motion, method):
    move = walker.begin("moveTo", 1.0, 0.0, 0.0, after=1.0)
    ((name, number),) = motion.getTaskList()
    assert name == "moveTo"
    assert motion.areResourcesAvailable(["LLeg"]) is False
    getattr(motion, method)(*{"killTask": (number,), "killTasksUsingResources": (["RLeg"],)}.get(method, ()))
    assert motion.moveIsActive() is False
    assert motion.getTaskList() == []
    assert walker.answer(move) is False
    before = motion.getAngles("Legs", False)
    walker.advance(0.5)
    assert motion.getAngles("Legs", False) == pytest.approx(before, abs=1e-3)


@pytest.mark.parametrize("module, method, arguments", [
    (MOTION, "rest", ()),
    (MOTION, "wakeUp", ()),
    (POSTURE, "goToPosture", ("Stand", 0.8)),
    (POSTURE, "goToPosture", ("Crouch", 1.0)),
    (POSTURE, "applyPosture", ("StandInit", 0.5)),
])  # fmt: skip
def test_changes_of_the_whole_body_bring_a_walk_to_its_end(walker, motion, module, method, arguments):
    move = walker.begin("moveTo", 1.0, 0.0, 0.0, after=3.3)
    change = walker.post(module, method, *arguments)
    walker.handed_over(module)
    begun = walker.now.time
    while change.isRunning() and walker.now.time < begun + LONGEST:
        walker.advance(0.5)
    assert walker.answer(change) in (None, True)
    assert walker.answer(move) is False
    assert not motion.moveIsActive()
    assert walker.now.torso.position[2] > (0.2 if method == "rest" or "Crouch" in arguments else 0.3)
    assert walker.ALMemory.getData("ALMotion/RobotIsStand") is True


# --- where it is ------------------------------------------------------------------------------------------------------


def test_the_robot_knows_where_it_stands_and_where_it_goes(walker, motion):
    assert motion.getRobotPosition(True) == pytest.approx([0.0, 0.0, 0.0], abs=0.01)
    assert motion.getRobotPosition(False) == pytest.approx([0.0, 0.0, 0.0], abs=0.01)
    assert motion.getNextRobotPosition() == pytest.approx(motion.getRobotPosition(False), abs=0.01)
    assert motion.getRobotVelocity() == [0.0, 0.0, 0.0]
    motion.move(0.07, 0.0, 0.0)
    walker.advance(5.0)
    here, next_ = motion.getRobotPosition(True), motion.getNextRobotPosition()
    assert here[0] == pytest.approx(walker.truth[0], abs=0.05)
    assert 0.0 < next_[0] - here[0] < 0.08
    assert motion.getRobotVelocity() == pytest.approx([0.07, 0.0, 0.0], abs=0.02)


# --- arms -------------------------------------------------------------------------------------------------------------


def test_arms_swing_unless_they_may_not(walker, motion):
    assert [motion.getMoveArmsEnabled(name) for name in ("LArm", "RArm", "Arms")] == [True, True, True]
    motion.setMoveArmsEnabled(True, False)
    assert [motion.getMoveArmsEnabled(name) for name in ("LArm", "RArm", "Arms")] == [True, False, False]
    assert motion.getWalkArmsEnabled() == [True, False]
    motion.move(0.08, 0.0, 0.0)
    walker.advance(4.0)
    left, right = set(), set()
    for _ in range(10):
        walker.advance(0.1)
        left.add(round(motion.getAngles("LShoulderPitch", False)[0], 2))
        right.add(round(motion.getAngles("RShoulderPitch", False)[0], 2))
    assert len(left) > 3 and len(right) == 1
    motion.setWalkArmsEnabled(True, True)
    assert motion.getMoveArmsEnabled("Arms") is True
