"""What a chain of motions would do, worked out before anything moves."""

from __future__ import annotations

import math

import pytest
from fake_motion import CHAINS, LIMITS

from nao_library_modules.errors import BadGoal
from nao_library_modules.motion_facts import JointLimits, JointState, MotionFacts, one_each
from nao_library_modules.motion_plan import MotionPlan, require_fraction, require_rising

FACTS = MotionFacts(CHAINS, {joint: JointLimits(*row[:3]) for joint, row in LIMITS.items()})


def make(stiffness=1.0, **angles):
    state = JointState({**dict.fromkeys(CHAINS["Body"], 0.0), **angles}, dict.fromkeys(CHAINS["Body"], stiffness))
    plan = MotionPlan(lambda: FACTS, lambda: state)
    plan.begin_function(1)
    return plan


def test_chains_and_joints_expand_in_order():
    assert FACTS.joints(["RHand", "Head"]) == ["RHand", "HeadYaw", "HeadPitch"]


def test_an_unknown_joint_is_named_with_the_closest_ones():
    with pytest.raises(BadGoal, match=r"'HeadYow' is no joint.*'HeadYaw'"):
        FACTS.joints(["HeadYow"])


def test_one_value_is_for_all_joints():
    assert one_each([0.5], ["a", "b"], "angles") == [0.5, 0.5]
    assert one_each([0.5, 1.0], ["a", "b"], "angles") == [0.5, 1.0]
    with pytest.raises(BadGoal, match="3 values for 2 joints"):
        one_each([1, 2, 3], ["a", "b"], "angles")


def test_an_angle_out_of_reach_is_told_with_the_limits():
    with pytest.raises(BadGoal, match=r"LShoulderRoll cannot go to 1.5000: -0.3000 to 1.3000"):
        make().targets({"LShoulderRoll": 1.5}, relative=False)


def test_the_limits_themselves_are_allowed_as_the_robot_rounds_them():
    make().targets({"LShoulderRoll": 1.3 + 5e-8, "RShoulderRoll": -2.0}, relative=False)


def test_relative_targets_start_where_earlier_functions_end():
    plan = make(HeadYaw=0.5)
    plan.move(plan.targets({"HeadYaw": 1.0}, relative=True), 0.0)
    assert plan.angle("HeadYaw") == pytest.approx(1.5)
    with pytest.raises(BadGoal, match="HeadYaw cannot go to 2.5000"):
        plan.targets({"HeadYaw": 1.0}, relative=True)


def test_a_relative_target_of_a_joint_that_is_nobody_knows_where_is_taken_on_trust():
    plan = make()
    plan.forget(["HeadYaw"])
    assert plan.targets({"HeadYaw": 5.0}, relative=True) == {"HeadYaw": None}


@pytest.mark.parametrize(
    "times, problem", [([0.1], r"from 0.000 to 1.000 in 0.100 s: at least 0.125 s"), ([0.126], None)]
)
def test_key_frames_faster_than_the_joint_are_told_with_the_least_time(times, problem):
    if problem is None:
        make().follow({"HeadYaw": [1.0]}, times, relative=False)
        return
    with pytest.raises(BadGoal, match=problem):
        make().follow({"HeadYaw": [1.0]}, times, relative=False)


def test_every_step_of_a_path_must_be_possible():
    with pytest.raises(BadGoal, match="from 1.000 to -1.000 in 0.100 s"):
        make().follow({"HeadYaw": [1.0, -1.0]}, [1.0, 1.1], relative=False)


def test_limp_joints_cannot_move_unless_they_are_stiffened():
    plan = make(stiffness=0.0)
    with pytest.raises(BadGoal, match="no stiffness in HeadYaw"):
        plan.require_stiff(["HeadYaw"], 0.0)
    plan.require_stiff(["HeadYaw"], 0.6)
    plan.require_stiff(["HeadYaw"], 0.0)
    assert plan.limp(["HeadYaw", "HeadPitch"]) == ["HeadPitch"]


@pytest.mark.parametrize("stiffness", [-0.1, 1.1, math.nan])
def test_a_stiffness_is_from_0_to_1(stiffness):
    with pytest.raises(BadGoal, match="stiffness"):
        make().require_stiff(["HeadYaw"], stiffness)


def test_durations_add_up_for_each_function():
    plan = make()
    plan.follow({"HeadYaw": [1.0, 0.0]}, [1.0, 3.0], relative=False)
    plan.begin_function(2)
    plan.move_with_speed({"HeadYaw": 1.6, "HeadPitch": 0.4}, dict.fromkeys(["HeadYaw", "HeadPitch"], 0.5))
    assert plan.durations == {1: pytest.approx(3.0), 2: pytest.approx(1.6 / 4.0)}


def test_touched_joints_keep_their_order_and_come_once():
    plan = make()
    plan.touch(["HeadPitch", "HeadYaw"])
    plan.move({"HeadYaw": 1.0, "RHand": 0.5}, 0.0)
    assert list(plan.touched) == ["HeadPitch", "HeadYaw", "RHand"]


def test_nothing_is_asked_of_the_robot_before_a_function_needs_it():
    def fail():
        raise AssertionError("the robot was asked")

    plan = MotionPlan(lambda: FACTS, fail)
    plan.begin_function(1)
    plan.touch(["HeadYaw"])
    plan.takes(1.0)
    with pytest.raises(AssertionError):
        plan.angle("HeadYaw")


@pytest.mark.parametrize("times", [[], [0.0], [1.0, 1.0], [2.0, 1.0], [math.inf]])
def test_times_rise_from_above_0(times):
    with pytest.raises(BadGoal, match="times"):
        require_rising(times)


def test_a_fraction_of_0_is_the_default():
    assert require_fraction("speed", 0.0, 0.3) == 0.3
    assert require_fraction("speed", 1.0, 0.3) == 1.0
    for value in (-0.1, 1.1, math.nan):
        with pytest.raises(BadGoal, match="speed"):
            require_fraction("speed", value, 0.3)
