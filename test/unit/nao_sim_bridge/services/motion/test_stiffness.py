"""ALMotion's stiffness over the network."""

from __future__ import annotations

import pytest

HEAD = ["HeadYaw", "HeadPitch"]


def test_the_robot_boots_limp(robot):
    assert robot.ALMotion.getStiffnesses("Body") == [0.0] * 26


@pytest.mark.parametrize(
    "names, stiffnesses, expected",
    [("Head", 0.5, [0.5, 0.5]), (HEAD, [0.25, 1.0], [0.25, 1.0]), ("HeadYaw", [0.5], [0.5, 0.0])],
)
def test_stiffness_is_set_at_once(robot, names, stiffnesses, expected):
    robot.ALMotion.setStiffnesses(names, stiffnesses)
    assert robot.ALMotion.getStiffnesses("Head") == expected


def test_either_hip_stiffens_both(robot):
    robot.ALMotion.setStiffnesses("RHipYawPitch", 0.5)
    assert robot.ALMotion.getStiffnesses(["LHipYawPitch", "RHipYawPitch"]) == [0.5, 0.5]


def test_stiffening_a_limp_joint_does_not_make_it_jump(robot):
    robot.ALMotion.setAngles("HeadYaw", 1.0, 1.0)
    robot.advance(0.5)
    robot.ALMotion.setStiffnesses("HeadYaw", 1.0)
    robot.advance(0.5)
    assert robot.ALMotion.getAngles("HeadYaw", True) == pytest.approx([0.0], abs=0.01)


def test_changing_the_stiffness_of_a_stiff_joint_keeps_its_command(stiff_robot):
    stiff_robot.finish("ALMotion", "angleInterpolation", "HeadYaw", 0.5, 0.5, True, after=0.6)
    stiff_robot.ALMotion.setStiffnesses("HeadYaw", 0.6)
    assert stiff_robot.ALMotion.getAngles("HeadYaw", False) == [0.5]


def test_an_interpolation_passes_through_the_middle_and_arrives_exactly(robot):
    future = robot.post("ALMotion", "stiffnessInterpolation", HEAD, [[1.0, 0.0], [0.5]], [[1.0, 2.0], [1.0]])
    robot.handed_over("ALMotion")
    robot.advance(0.5)
    assert robot.ALMotion.getStiffnesses("Head") == pytest.approx([0.5, 0.25], abs=0.01)
    robot.advance(1.51)
    assert robot.answer(future) is None
    assert robot.ALMotion.getStiffnesses("Head") == [0.0, 0.5]


def test_one_value_and_one_time_serve_the_whole_body(robot):
    robot.finish("ALMotion", "stiffnessInterpolation", "Body", 1.0, 1.0, after=1.01)
    assert robot.ALMotion.getStiffnesses("Body") == [1.0] * 26


def test_setting_stiffness_ends_an_interpolation_of_it(robot):
    future = robot.post("ALMotion", "stiffnessInterpolation", "HeadYaw", 1.0, 5.0)
    robot.handed_over("ALMotion")
    robot.advance(0.5)
    robot.ALMotion.setStiffnesses("HeadYaw", 0.25)
    robot.answer(future)
    robot.advance(0.5)
    assert robot.ALMotion.getStiffnesses("HeadYaw") == [0.25]


@pytest.mark.parametrize(
    "method, arguments, message",
    [
        ("setStiffnesses", ("Head", 1.5), "stiffnesses is 1.5, allowed is 0 to 1"),
        ("setStiffnesses", (HEAD, [0.1, 0.2, 0.3]), "allowed is one number or 2, one for each joint"),
        ("setStiffnesses", ("Had", 1.0), "unknown joint or chain 'Had': did you mean 'Head'"),
        ("getStiffnesses", ("Had",), "unknown joint or chain 'Had'"),
        ("stiffnessInterpolation", ("HeadYaw", -0.5, 1.0), "stiffnessLists is -0.5, allowed is 0 to 1"),
        ("stiffnessInterpolation", ("HeadYaw", [0.5, 1.0], 1.0), "as many times as values for each joint: 2"),
    ],
)
def test_wrong_arguments_name_what_is_allowed_and_stiffen_nothing(shared_robot, method, arguments, message):
    before = shared_robot.ALMotion.getStiffnesses("Body")
    with pytest.raises(RuntimeError, match=message):
        getattr(shared_robot.ALMotion, method)(*arguments)
    shared_robot.advance(0.05)
    assert shared_robot.ALMotion.getStiffnesses("Body") == before
