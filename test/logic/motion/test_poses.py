"""Pose libraries of Choregraphe."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from nao_library_modules.xap import BadPoseFile, read_poses

SAMPLE = Path(__file__).parents[3] / "nao_library_modules" / "config" / "poses.xap"
NAMESPACE = "http://www.aldebaran-robotics.com/schema/choregraphe/position.xsd"


def motors(**angles):
    return "".join(f"<Motor><name>{name}</name><value>{value}</value></Motor>" for name, value in angles.items())


def position(name="Nod", version="2", content=None):
    content = motors(HeadPitch=0.5) if content is None else content
    return f"<position><version>{version}</version><name>{name}</name><Motors>{content}</Motors></position>"


@pytest.fixture
def library(tmp_path):
    def write(*positions, head=f'<poses xmlns="{NAMESPACE}">'):
        path = tmp_path / "library.xap"
        path.write_text(f'<?xml version="1.0" encoding="UTF-8" ?>\n{head}{"".join(positions)}</poses>')
        return path

    return write


def test_version_2_is_in_radians_and_older_in_degrees(library):
    path = library(position(), position("Old", "1", motors(HeadYaw=90.0, LHand=0.25)))
    poses = read_poses(path)
    assert poses["Nod"] == {"HeadPitch": 0.5}
    assert poses["Old"] == {"HeadYaw": pytest.approx(math.pi / 2), "LHand": 0.25}


def test_the_namespace_does_not_matter(library):
    assert read_poses(library(position(), head="<poses>")) == {"Nod": {"HeadPitch": 0.5}}


@pytest.mark.parametrize(
    "positions, problem",
    [
        ((), "holds no position"),
        ((position(name=""),), "position 1 has no name"),
        ((position(), position()), "two positions are called 'Nod'"),
        ((position(content=""),), "Nod: no motors"),
        ((position(content=motors(HeadYaw="far")),), "HeadYaw has the value 'far'"),
        ((position(content=motors(HeadYaw="nan")),), "HeadYaw has the value 'nan'"),
        ((position(content=motors(HeadYaw=1) * 2),), "HeadYaw comes twice"),
    ],
)
def test_what_is_wrong_is_named(library, positions, problem):
    with pytest.raises(BadPoseFile, match=problem):
        read_poses(library(*positions))


def test_files_that_are_none(tmp_path):
    with pytest.raises(BadPoseFile, match="No such file"):
        read_poses(tmp_path / "nothing.xap")
    (tmp_path / "text.xap").write_text("poses")
    with pytest.raises(BadPoseFile, match="no XML"):
        read_poses(tmp_path / "text.xap")


def test_the_library_of_the_package_can_be_read():
    poses = read_poses(SAMPLE)
    assert set(poses) == {"ArmsForward", "HandsOnHips"}
    for name, pose in poses.items():
        assert len(pose) >= 8, name
