"""Trajectories as clients of nao_robot send them, and those that cannot be carried out."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from nao_library_modules.errors import BadGoal
from nao_library_modules.joint_trajectory import H25_BODY, check_range, expand_names, one_each, read_trajectory

CHAINS = {"Body": ("HeadYaw", "HeadPitch", "LHand"), "Head": ("HeadYaw", "HeadPitch"), "LArm": ("LHand",)}


def point(time, positions, velocities=()):
    return SimpleNamespace(time_from_start=time, positions=positions, velocities=velocities)


def trajectory(names, *points):
    return SimpleNamespace(joint_names=names, points=list(points))


def test_many_points_for_many_joints():
    frames = read_trajectory(trajectory(["Head"], point(1, [0.1, 0.2]), point(2.5, [0.3, 0.4])), CHAINS)
    assert frames.interpolation_arguments() == (
        ["HeadYaw", "HeadPitch"],
        [[0.1, 0.3], [0.2, 0.4]],
        [[1.0, 2.5], [1.0, 2.5]],
        True,
    )
    assert frames.duration == 2.5
    assert frames.targets == {"HeadYaw": 0.3, "HeadPitch": 0.4}


def test_one_value_serves_all_joints():
    frames = read_trajectory(trajectory(["Body"], point(1.5, [1.0])), CHAINS)
    assert frames.targets == {"HeadYaw": 1.0, "HeadPitch": 1.0, "LHand": 1.0}


def test_a_first_point_at_time_0_is_where_the_robot_is_anyway():
    frames = read_trajectory(trajectory(["HeadYaw"], point(0, [0.0]), point(1, [0.5])), CHAINS)
    assert frames.times == (1.0,)
    assert frames.values == ((0.5,),)


def test_relative_values_are_told_to_the_robot_or_added_to_the_start():
    frames = read_trajectory(trajectory(["Head"], point(1, [0.1, -0.1])), CHAINS, relative=True)
    assert frames.interpolation_arguments()[-1] is False
    assert frames.absolute([1.0, 2.0]).values == ((1.1,), (1.9,))
    assert frames.absolute([1.0, 2.0]).interpolation_arguments()[-1] is True


def bezier(start, end, share):
    """Angle of a cubic Bezier segment between two control points; (time, angle) relative to the start time."""
    length, (value, _, (_, dt_out, da_out)) = end[0], start[1]
    target, (_, dt_in, da_in), _ = end[1]
    points = [(0.0, value), (dt_out, value + da_out), (length + dt_in, target + da_in), (length, target)]
    s, t = share, 1.0 - share
    weights = (t**3, 3 * t * t * s, 3 * t * s * s, s**3)
    return tuple(sum(w * p[axis] for w, p in zip(weights, points)) for axis in (0, 1))


def test_bezier_points_have_the_velocities_asked_for():
    asked = trajectory(["HeadYaw"], point(1, [0.2], [0.3]), point(3, [0.6], [-0.1]))
    names, times, points = read_trajectory(asked, CHAINS).bezier_arguments()
    assert (names, times) == (["HeadYaw"], [[1.0, 3.0]])
    start, end = (1.0, points[0][0]), (2.0, points[0][1])
    step = 1e-5
    for share, velocity in ((0.0, 0.3), (1.0 - step, -0.1)):
        (t0, a0), (t1, a1) = bezier(start, end, share), bezier(start, end, share + step)
        assert (a1 - a0) / (t1 - t0) == pytest.approx(velocity, abs=1e-4)
    assert bezier(start, end, 0.5)[0] == pytest.approx(1.0)  # time runs evenly along the segment


def test_bezier_needs_velocities_and_absolute_values():
    plain = read_trajectory(trajectory(["HeadYaw"], point(1, [0.2])), CHAINS)
    relative = read_trajectory(trajectory(["HeadYaw"], point(1, [0.2], [0.0])), CHAINS, relative=True)
    for frames in (plain, relative):
        with pytest.raises(ValueError, match="velocities and absolute"):
            frames.bezier_arguments()
    assert relative.absolute([0.5]).bezier_arguments()[2][0][0][0] == 0.7


def test_a_pose_of_the_whole_h25_body_fits_a_robot_without_wrists_and_hands():
    without = [name for name in H25_BODY if not name.endswith(("Hand", "WristYaw"))]
    chains = {"Body": without}
    pose = [float(i) for i in range(len(H25_BODY))]
    frames = read_trajectory(trajectory(["Body"], point(1, pose)), chains)
    assert frames.targets == {name: float(H25_BODY.index(name)) for name in without}
    assert one_each(pose, ["Body"], chains, "joint_angles") == tuple(float(H25_BODY.index(name)) for name in without)


@pytest.mark.parametrize(
    "names, points, field, words",
    [
        ([], [point(1, [0.0])], "trajectory.joint_names", "no joint is named"),
        (["HeadJaw"], [point(1, [0.0])], "trajectory.joint_names", "did you mean 'HeadYaw'"),
        (["Head", "HeadYaw"], [point(1, [0.0])], "trajectory.joint_names", "named twice: HeadYaw"),
        (["Head"], [], "trajectory.points", "no point"),
        (["Body"], [point(1, [0.0, 0.0])], "trajectory.points[0].positions", "2 values for 3 joints"),
        (["Head"], [point(1, [0, 0]), point(2, [])], "trajectory.points[1].positions", "0 values for 2 joints"),
        (["HeadYaw"], [point(0, [0.0])], "trajectory.points[0].time_from_start", "above 0 s"),
        (["HeadYaw"], [point(-1, [0.0])], "trajectory.points[0].time_from_start", "above 0 s"),
        (["HeadYaw"], [point(2, [0]), point(2, [1])], "trajectory.points[1].time_from_start", "2 s after 2 s"),
        (["HeadYaw"], [point(1, [float("nan")])], "trajectory.points[0].positions", "finite"),
        (["HeadYaw"], [point(1, [0], [1]), point(2, [0])], "trajectory.points[1].velocities", "point 1 has no"),
        (["Head"], [point(1, [0, 0], [1, 2, 3])], "trajectory.points[0].velocities", "3 values for 2"),
    ],
)
def test_what_is_wrong_is_named(names, points, field, words):
    with pytest.raises(BadGoal) as caught:
        read_trajectory(trajectory(names, *points), CHAINS)
    assert caught.value.field == field
    assert words in str(caught.value)


def test_names_are_expanded_in_order():
    assert expand_names(["LArm", "HeadPitch"], CHAINS) == ("LHand", "HeadPitch")


def test_stiffness_has_a_range():
    frames = read_trajectory(trajectory(["Head"], point(1, [0.5, 1.2])), CHAINS)
    with pytest.raises(BadGoal, match=r"HeadPitch is to be 1.2: 0 to 1"):
        check_range(frames, 0.0, 1.0)
    check_range(frames, 0.0, 1.2)
