"""Planned steps over the network: made as they were asked for, read while they are made."""

from __future__ import annotations

import math

import pytest

MOTION, WITH_SPEED = "ALMotion", "setFootStepsWithSpeed"
LONGEST = 30.0
# Six times two steps ahead.
MARCH = (["LLeg", "RLeg"] * 6, [[0.04, 0.1, 0.0], [0.04, -0.1, 0.0]] * 6)
AHEAD = [[0.04, 0.1, 0.0], [0.04, -0.1, 0.0], [0.0, 0.1, 0.0]]
LEGS = ["LLeg", "RLeg", "LLeg"]


@pytest.fixture
def motion(walker):
    return walker.motion


def feet(robot):
    """Poses of the feet in the world of the robot, and the steps to come."""
    return robot.ALMotion.getFootSteps()


def beside(foot, other):
    """A foot [x, y, theta] in the frame of the other one."""
    x, y, c, s = foot[0] - other[0], foot[1] - other[1], math.cos(other[2]), math.sin(other[2])
    return [c * x + s * y, -s * x + c * y, foot[2] - other[2]]


def test_a_robot_that_stands_has_feet_and_no_steps(walker):
    (left, right), fixed, further = feet(walker)
    # In this posture toes point outwards.
    assert left == pytest.approx([0.0, 0.073, 0.134], abs=0.01)
    assert right == pytest.approx([0.0, -0.073, -0.134], abs=0.01)
    assert fixed == [] and further == []


@pytest.mark.parametrize("speed", [[1.0], [0.5, 1.0, 0.0]])
def test_steps_with_a_speed_answer_when_they_are_made(walker, motion, speed):
    future = walker.begin(WITH_SPEED, LEGS, AHEAD, speed, False, after=0.1)
    assert future.isRunning()
    walker.until_it_stands()
    assert walker.answer(future) is None
    (left, right), _, _ = feet(walker)
    assert beside(left, right) == pytest.approx(AHEAD[-1], abs=0.02)
    assert 0.05 < left[0] < 0.11
    assert walker.now.torso.position[0] == pytest.approx((left[0] + right[0]) / 2.0, abs=0.04)


def test_steps_at_times_return_at_once_and_are_listed(walker, motion):
    walker.walk("moveInit")  # from other stances, a step more brings the feet side by side
    begun = walker.now.time
    assert motion.setFootSteps(LEGS, AHEAD, [0.8, 1.6, 2.4], False) is None
    assert walker.now.time == begun
    assert motion.moveIsActive()
    seen = []
    while motion.moveIsActive() and walker.now.time < begun + LONGEST:
        walker.advance(0.1)
        _, fixed, further = feet(walker)
        assert len(fixed) <= 1
        seen.append([(leg, move) for leg, _, move in [*fixed, *further]])
        times = [time for _, time, _ in [*fixed, *further]]
        assert times == sorted(times)
        assert [b - a for a, b in zip(times, times[1:])] == pytest.approx([0.8] * (len(times) - 1), abs=0.01)
    longest = max(seen, key=len)
    assert [leg for leg, _ in longest] == LEGS
    for (_, move), asked in zip(longest, AHEAD):
        assert move == pytest.approx(asked, abs=0.01)
    assert seen[-1] == []


def test_a_slow_step_takes_longer_than_a_quick_one(walker, motion):
    walker.walk("moveInit")

    def duration(fraction):
        begun = walker.now.time
        steps = [[0.03, 0.1, 0.0], [0.0, -0.1, 0.0]]
        future = walker.begin(WITH_SPEED, ["LLeg", "RLeg"], steps, [fraction], False, after=0.1)
        walker.until_it_stands(0.05)
        walker.answer(future)
        return walker.now.time - begun

    assert duration(0.0) - duration(1.0) == pytest.approx(2 * 0.18, abs=0.11)


def test_a_foot_that_steps_twice_waits_for_the_other_one(walker, motion):
    first = walker.begin(WITH_SPEED, ["LLeg"], [[0.0, 0.14, 0.0]], [1.0], False, after=0.1)
    second = walker.begin(WITH_SPEED, ["LLeg"], [[0.0, 0.1, 0.0]], [1.0], False, after=0.1)
    walker.until_it_stands()
    walker.answer(first), walker.answer(second)
    (left, right), _, _ = feet(walker)
    assert beside(left, right) == pytest.approx([0.0, 0.1, 0.0], abs=0.02)


def test_steps_can_replace_those_that_are_not_begun(walker, motion):
    walker.begin(WITH_SPEED, *MARCH, [1.0], False, after=2.2)
    future = walker.begin(WITH_SPEED, ["LLeg", "RLeg"], [[0.0, 0.1, 0.0], [0.0, -0.1, 0.0]], [1.0], True, after=0.1)
    walker.until_it_stands()
    walker.answer(future)
    assert walker.now.torso.position[0] < 0.25


def test_stopped_steps_answer_and_leave_the_robot_standing(walker, motion):
    future = walker.begin(WITH_SPEED, *MARCH, [1.0], False, after=2.0)
    stop = walker.post(MOTION, "stopMove")
    walker.handed_over(MOTION)
    walker.until_it_stands()
    assert walker.answer(stop) is True
    assert walker.answer(future) is None
    assert walker.now.torso.position[0] < 0.3


def test_steps_that_legs_cannot_make_are_clipped(walker, motion):
    walker.walk("moveInit")
    motion.setFootSteps(["LLeg"], [[0.3, 0.4, 2.0]], [1.0], False)
    planned = []
    for _ in range(10):
        walker.advance(0.1)
        _, fixed, _ = feet(walker)
        planned += [move for _, _, move in fixed]
    x, y, turn = planned[0]
    assert 0.0 < x <= 0.08 and 0.088 <= y <= 0.16 and 0.0 < turn <= 0.524
    walker.until_it_stands()


@pytest.mark.parametrize(
    "method, arguments, message",
    [
        ("setFootSteps", ([], [], [], False), "legName is .*, allowed is a list of LLeg and RLeg, at least one"),
        ("setFootSteps", (["LArm"], [[0.0, 0.1, 0.0]], [0.6], False), "legName is .*, allowed is a list of LLeg"),
        ("setFootSteps", (["LLeg"], [], [0.6], False), "footSteps is .*, allowed is as many steps .* 1 here"),
        ("setFootSteps", (["LLeg"], [[0.0, 0.1]], [0.6], False), r"footSteps\[0\] is .*, allowed is x, y in m"),
        ("setFootSteps", (["LLeg"], [0.0], [0.6], False), r"footSteps\[0\] is 0.0, allowed is a list of numbers"),
        ("setFootSteps", (["LLeg"], [[0.0, math.nan, 0.0]], [0.6], False), r"footSteps\[0\]\[1\] is nan"),
        ("setFootSteps", (LEGS[:2], AHEAD[:2], [0.6], False), "timeList is .*, allowed is as many as steps: 2 here"),
        ("setFootSteps", (LEGS[:2], AHEAD[:2], [0.6, 0.6], False), "timeList is .*, allowed is times that rise"),
        ("setFootSteps", (["LLeg"], AHEAD[:1], [0.0], False), "timeList is .*, allowed is times that rise"),
        ("setFootSteps", (["LLeg", "LLeg"], AHEAD[:2], [0.6, 1.2], False), "allowed is LLeg and RLeg in turns"),
        (
            "setFootStepsWithSpeed",
            (["LLeg"], AHEAD[:1], [1.5], False),
            r"fractionMaxSpeed\[0\] is 1.5, allowed is 0 to 1",
        ),
        ("setFootStepsWithSpeed", (LEGS, AHEAD, [1.0, 1.0], False), "allowed is as many as steps: 3 here"),
        ("setFootStepsWithSpeed", (LEGS, AHEAD[:2], [1.0], False), "footSteps is .*, allowed is as many steps"),
    ],
)
def test_what_is_no_plan_is_refused_and_nothing_moves(walker, motion, method, arguments, message):
    with pytest.raises(RuntimeError, match=f"ALMotion::{method} .*{message}"):
        motion.call(method, *arguments)
    assert motion.moveIsActive() is False


def test_limp_legs_make_no_steps(walker, motion):
    motion.setStiffnesses("Body", 0.0)
    with pytest.raises(RuntimeError, match="ALMotion::setFootSteps stiffness of LHipYawPitch.* wakeUp first"):
        motion.setFootSteps(["LLeg"], [[0.0, 0.1, 0.0]], [0.6], False)
