"""ALMotion plays timed Bezier curves over the network; wrong ones are refused with what is allowed."""

from __future__ import annotations

import pytest

HEAD = ["HeadYaw", "HeadPitch"]
FLAT = [[3, -0.2, 0.0], [3, 0.2, 0.0]]


def head(robot):
    return robot.ALMotion.getAngles("Head", False)


def play(robot, names, times, points, after):
    return robot.finish("ALMotion", "angleInterpolationBezier", names, times, points, after=after)


def test_a_timeline_is_played_to_its_end_through_its_points(stiff_robot):
    points = [[[0.4, *FLAT], [-0.2, *FLAT]], [[0.3, *FLAT]]]
    future = stiff_robot.post("ALMotion", "angleInterpolationBezier", HEAD, [[0.6, 1.2], [0.6]], points)
    stiff_robot.handed_over("ALMotion")
    stiff_robot.advance(0.6)
    assert head(stiff_robot) == pytest.approx([0.4, 0.3], abs=2e-3)
    stiff_robot.advance(0.62)
    assert stiff_robot.answer(future) is None
    assert head(stiff_robot) == pytest.approx([-0.2, 0.3])
    assert stiff_robot.ALMotion.getAngles("Head", True) == pytest.approx([-0.2, 0.3], abs=0.01)


def test_flat_handles_are_slow_at_the_ends_and_linear_ones_are_not(stiff_robot):
    """A tenth of the way into the time."""
    reached = []
    for handles in (FLAT, [[1, 0.0, 0.0]]):
        stiff_robot.NaoSimulation.reset()
        stiff_robot.ALMotion.setStiffnesses("Body", 1.0)
        points = [[[1.0, *handles]]]
        future = stiff_robot.post("ALMotion", "angleInterpolationBezier", ["HeadYaw"], [[1.0]], points)
        stiff_robot.handed_over("ALMotion")
        stiff_robot.advance(0.1)
        reached.append(head(stiff_robot)[0])
        stiff_robot.ALMotion.killAll()
        stiff_robot.answer(future)
    assert reached[0] < 0.05 < 0.09 < reached[1]


@pytest.mark.parametrize(
    "names, times, points",
    [
        ("HeadYaw", [0.5], [[0.2, *FLAT]]),
        (["HeadYaw"], [[0.5]], [[[0.2, *FLAT]]]),
        (["HeadYaw"], [[0.5]], [[0.2]]),
        (["HeadYaw"], [[0.5]], [[[0.2, [3, -0.1, 0.0]]]]),
    ],
)
def test_control_points_in_all_shapes(stiff_robot, names, times, points):
    play(stiff_robot, names, times, points, after=0.6)
    assert head(stiff_robot)[0] == pytest.approx(0.2)


@pytest.mark.parametrize(
    "times, points, message",
    [
        ([[0.5]], [[0.1], [0.1]], "times"),
        ([[0.5], [0.5]], [[0.1, 0.2], [0.1]], "as many points as times for each joint: 1"),
        ([[0.5], [0.0]], [[0.1], [0.1]], "the first above 0 s"),
        ([[0.5], [0.5, 0.4]], [[0.1], [0.1, 0.1]], "times that rise"),
        ([[0.5], [0.5]], [[[0.1, [7, 0.0, 0.0]]], [0.1]], "type of a handle is 7"),
        ([[0.5], [0.5]], [[[0.1, [3, 0.2, 0.0], [3, 0.2, 0.0]]], [0.1]], "dTime of 0 or less"),
        ([[0.5], [0.5]], [[[0.1, [3, 0.2]]], [0.1]], "with the handles before and after"),
        ([[0.5], [0.5]], [["far"], [0.1]], "controlPoints is 'far'"),
    ],
)
def test_what_makes_no_curve_is_refused_and_moves_nothing(stiff_robot, times, points, message):
    with pytest.raises(RuntimeError, match=message):
        stiff_robot.ALMotion.angleInterpolationBezier(HEAD, times, points)
    assert stiff_robot.ALMotion.getTaskList() == []


def test_an_animation_may_count_from_where_the_joint_is(stiff_robot):
    play(stiff_robot, ["HeadYaw"], [[0.3]], [[0.3]], after=0.4)
    call = (["HeadYaw"], [[0.3, 0.6]], [[0.2, -0.1]], False, [])
    assert stiff_robot.finish("ALMotion", "animation", *call, after=0.7) is None
    assert head(stiff_robot)[0] == pytest.approx(0.2)


def test_an_animation_keeps_both_feet_on_the_ground(stiff_robot):
    with pytest.raises(RuntimeError, match="supportSequence"):
        stiff_robot.ALMotion.animation(["HeadYaw"], [[0.3]], [[0.2]], True, [[0.1, "LLeg"]])
