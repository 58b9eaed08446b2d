"""Poses by name."""

from __future__ import annotations

import pytest

from nao_library_modules.driver.poses import BadPose, Pose, UnknownPose, built_in, library, pose_table
from nao_library_modules.joint_trajectory import H25_BODY
from nao_library_modules.paths import config_file

POSE = {"joint_names": ["Head"], "positions": [0.1, 0.2], "time_from_start": 2}


def test_a_table_of_nao_robot():
    assert pose_table({"nod": POSE}) == {"nod": Pose(("Head",), (0.1, 0.2), 2.0)}
    one = {"joint_names": "HeadYaw", "positions": 0.5, "time_from_start": 1.0}
    assert pose_table({"look": one}) == {"look": Pose(("HeadYaw",), (0.5,), 1.0)}


@pytest.mark.parametrize(
    "entry, problem",
    [
        ({**POSE, "speed": 1}, "it has joint_names, positions, time_from_start, speed"),
        ({"positions": [0.0]}, "it has positions;"),
        ("Head", "it has 'Head'"),
        ({**POSE, "positions": ["far"]}, "'far' is no number"),
        ({**POSE, "positions": []}, "0 positions"),
        ({**POSE, "time_from_start": 0}, "0 s"),
    ],
)
def test_what_is_no_pose_is_said(entry, problem):
    with pytest.raises(BadPose, match=problem):
        pose_table({"nod": entry})
    with pytest.raises(BadPose, match="the table is"):
        pose_table([entry])


def test_the_poses_that_come_along_are_of_the_whole_body():
    poses = built_in()
    assert set(poses) == {"init", "zero", "crouch"}
    for pose in poses.values():
        assert (pose.joints, len(pose.positions)) == (("Body",), len(H25_BODY))


def test_a_library_of_choregraphe():
    poses = library(str(config_file("poses.xap")))
    assert "ArmsForward" in poses
    assert set(poses["ArmsForward"].joints) <= set(H25_BODY)
    assert poses["ArmsForward"].time == 2.0


def test_unknown_names_come_with_the_closest():
    assert "did you mean 'init'" in str(UnknownPose("inti", built_in()))
