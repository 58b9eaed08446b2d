"""What a chain of motions would do, worked out before anything moves: joints, heat, battery, gait."""

from __future__ import annotations

import math

import pytest

from nao_library_modules.core.errors import BadGoal, NotFit
from nao_library_modules.core.geometry import Place
from nao_library_modules.motion.motion_plan import Health, JointLimits, JointState, MotionFacts, MotionPlan, one_each
from nao_library_modules.motion.walk_fields import GaitRange, read_gait, walk_time

HEAD = ["HeadYaw", "HeadPitch"]
LIMITS = {"HeadYaw": (-2.0, 2.0, 8.0), "HeadPitch": (-0.7, 0.5, 7.0), "LShoulderRoll": (-0.3, 1.3, 7.0),
          "RHand": (0.0, 1.0, 8.0)}  # fmt: skip
FACTS = MotionFacts(
    {"Head": HEAD, "Body": list(LIMITS)}, {joint: JointLimits(*limits) for joint, limits in LIMITS.items()}
)


def make(stiffness=1.0, **angles):
    state = JointState({**dict.fromkeys(LIMITS, 0.0), **angles}, dict.fromkeys(LIMITS, stiffness))
    plan = MotionPlan(lambda: FACTS, lambda: state)
    plan.begin_function(1)
    return plan


def refused(text, function, *arguments, error=BadGoal, **fields):
    with pytest.raises(error, match=text):
        function(*arguments, **fields)


def test_chains_and_joints_expand_in_order_and_one_value_is_for_all():
    assert FACTS.joints(["RHand", "Head"]) == ["RHand", *HEAD]
    refused(r"'HeadYow' is no joint.*'HeadYaw'", FACTS.joints, ["HeadYow"])
    assert one_each([0.5], HEAD, "angles") == [0.5, 0.5] and one_each([0.5, 1.0], HEAD, "angles") == [0.5, 1.0]
    refused("3 values for 2 joints", one_each, [1, 2, 3], HEAD, "angles")


def test_targets_are_within_the_limits_as_the_robot_rounds_them():
    text = r"LShoulderRoll cannot go to 1.5000 rad: -0.3000 to 1.3000 rad"
    refused(text, make().targets, {"LShoulderRoll": 1.5}, relative=False)
    refused(
        "HeadYaw cannot go to 45.0000 rad: .* rad; 45 degrees are 0.7854 rad",
        make().targets,
        {"HeadYaw": 45.0},
        False,
    )
    text = r"3.4907 rad: -2.0000 to 2.0000 rad; in degrees -114.6 to 114.6"
    refused(text, make().targets, {"HeadYaw": math.radians(200.0)}, relative=False)
    make().targets({"LShoulderRoll": 1.3 + 5e-8, "HeadYaw": -2.0}, relative=False)
    plan = make(HeadYaw=0.5)
    plan.move(plan.targets({"HeadYaw": 1.0}, relative=True), 0.0)
    assert plan.angles["HeadYaw"] == pytest.approx(1.5), "relative targets start where earlier functions end"
    refused("HeadYaw cannot go to 2.5000", plan.targets, {"HeadYaw": 1.0}, relative=True)
    plan.forget(["HeadYaw"])
    assert plan.targets({"HeadYaw": 5.0}, relative=True) == {"HeadYaw": None}, "nobody knows where it is"


def test_every_step_of_a_path_takes_the_time_that_the_joint_needs():
    text = r"from 0.000 to 1.000 in 0.100 s: at least 0.125 s"
    refused(text, make().follow, {"HeadYaw": [1.0]}, [0.1], relative=False)
    make().follow({"HeadYaw": [1.0]}, [0.126], relative=False)
    refused("from 1.000 to -1.000 in 0.100 s", make().follow, {"HeadYaw": [1.0, -1.0]}, [1.0, 1.1], relative=False)


def test_limp_joints_cannot_move_unless_they_are_stiffened():
    plan = make(stiffness=0.0)
    refused("no stiffness in HeadYaw", plan.require_stiff, ["HeadYaw"], 0.0)
    plan.require_stiff(["HeadYaw"], 0.6)
    plan.require_stiff(["HeadYaw"], 0.0)
    assert plan.limp(HEAD) == ["HeadPitch"]


def test_durations_add_up_for_each_function_and_touched_joints_come_once():
    plan = make()
    plan.follow({"HeadYaw": [1.0, 0.0]}, [1.0, 3.0], relative=False)
    plan.begin_function(2)
    plan.move_with_speed({"HeadYaw": 1.6, "HeadPitch": 0.4}, dict.fromkeys(HEAD, 0.5))
    assert plan.durations == {1: pytest.approx(3.0), 2: pytest.approx(1.6 / 4.0)}
    plan = make()
    plan.touch(HEAD[::-1])
    plan.move({"HeadYaw": 1.0, "RHand": 0.5}, 0.0)
    assert list(plan.touched) == ["HeadPitch", "HeadYaw", "RHand"]


# Health

KNEE = "LKneePitch"


def warm(celsius):
    return Health({KNEE: celsius, "HeadYaw": 30.0})


def test_a_hot_joint_is_slow_and_a_very_hot_one_is_refused():
    assert (warm(67.9).careful([KNEE], 1.0), warm(68.0).careful([KNEE], 1.0)) == (1.0, 0.5)
    assert (warm(68.0).careful([KNEE], 0.2), warm(90.0).careful(["HeadYaw"], 1.0)) == (0.2, 1.0)
    warm(73.9).require_fit([KNEE])
    warm(90.0).require_fit(["HeadYaw"])
    text = "too hot to move: LKneePitch 74 degC: rest until they are below 74 degC"
    refused(text, warm(74.0).require_fit, [KNEE, "HeadYaw"], error=NotFit)


# Gait

RANGES = {
    "MaxStepX": GaitRange(0.04, 0.001, 0.08), "MaxStepY": GaitRange(0.14, 0.101, 0.16),
    "MaxStepTheta": GaitRange(0.349, 0.001, 0.524), "MaxStepFrequency": GaitRange(1.0, 0.0, 1.0),
    "StepHeight": GaitRange(0.02, 0.005, 0.035), "TorsoWx": GaitRange(0.0, -0.122, 0.122),
    "TorsoWy": GaitRange(0.0, -0.122, 0.122),
}  # fmt: skip


def test_parameters_of_a_walk_have_ranges_also_for_one_foot():
    rounded = {"MaxStepX": GaitRange(0.04, 0.0010000000475, 0.0799999982)}
    assert read_gait(["MaxStepX"], [0.08], rounded, False) == [["MaxStepX", 0.08]]
    refused("MaxStepX cannot be 0.081: 0.001 to 0.08", read_gait, ["MaxStepX"], [0.081], rounded, False)
    feet = read_gait(["RightStepHeight", "Frequency"], [0.035, 0.0], RANGES, True)
    assert feet == [["RightStepHeight", 0.035], ["Frequency", 0.0]]
    refused("RightStepHeight cannot be 0.1: 0.005 to 0.035", read_gait, ["RightStepHeight"], [0.1], RANGES, True)


def test_longer_steps_are_quicker_and_lower_frequencies_slower():
    way = [Place(1.0, 0.0, 0.0)]
    assert walk_time(way, [], RANGES) == pytest.approx(2.0 + 25 * 0.42)
    assert walk_time(way, [["MaxStepX", 0.08]], RANGES) == pytest.approx(2.0 + 12.5 * 0.42)
    assert walk_time(way, [["MaxStepFrequency", 0.0]], RANGES) == pytest.approx(2.0 + 25 * 0.6)
    there_and_back = [Place(0.5, 0.0, 0.0), Place(0.0, 0.0, 0.0)]
    assert walk_time(there_and_back, [], RANGES) == pytest.approx(walk_time(way, [], RANGES))
    assert walk_time([Place(0.0, 0.0, 0.0)], [], RANGES) == 0.0
