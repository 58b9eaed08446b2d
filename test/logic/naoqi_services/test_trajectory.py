"""What ALNavigation.moveAlong is told, as poses to go through."""

import math

import pytest

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.naoqi.navigation.trajectory import read_trajectory

FORTH, BACK = (["Holonomic", ["Line", [x, 0.0]], 0.0, time] for x, time in ((1.0, 5.0), (-1.0, 10.0)))
BAD = [
    ("Line", "trajectory is 'Line'"),
    ([], "trajectory is"),
    (["Holonomic", ["Line", [1.0, 0.0]], 0.0], "trajectory is"),
    (["Holonomic", ["Line", [1.0]], 0.0, 1.0], r"trajectory\[1\]\[1\] is"),
    (["Holonomic", ["Spiral", [1.0, 0.0]], 0.0, 1.0], r"trajectory\[1\] is .*Circle"),
    (["Composed", FORTH, ["Holonomic", ["Line", [1.0, 0.0]], 0.0, -1.0]], r"trajectory\[2\]\[3\] is -1"),
    (["Composed"], "trajectory is"),
]


def test_composed_trajectories_are_stretches_one_after_the_other():
    there, back = read_trajectory(["Composed", FORTH, BACK])
    assert (there.poses, there.time) == (((1.0, 0.0, 0.0),), 5.0) and (back.poses, back.time) == (
        ((-1.0, 0.0, 0.0),),
        10.0,
    )


def test_paths_join_and_the_heading_turns_evenly_along_them():
    corner = ["Composed", ["Line", [1.0, 0.0]], ["Line", [0.0, 3.0]]]
    (stretch,) = read_trajectory(["Holonomic", corner, 1.0, 0.0])
    assert stretch.poses == pytest.approx([(1.0, 0.0, 0.25), (1.0, 3.0, 1.0)])


def test_a_quarter_of_a_circle_goes_around_its_centre():
    (stretch,) = read_trajectory(["Holonomic", ["Circle", [0.0, 0.5], math.pi / 2], math.pi / 2, 8.0])
    assert stretch.poses[-1] == pytest.approx((0.5, 0.5, math.pi / 2)) and len(stretch.poses) == 6
    assert all(math.dist(pose[:2], (0.0, 0.5)) == pytest.approx(0.5) for pose in stretch.poses)
    assert [pose.yaw for pose in stretch.poses] == pytest.approx([math.radians(15 * i) for i in range(1, 7)], abs=0.01)


@pytest.mark.parametrize("value, words", BAD)
def test_what_is_none_is_refused_with_the_part_that_is_wrong(value, words):
    with pytest.raises(BadValue, match=words):
        read_trajectory(value)
