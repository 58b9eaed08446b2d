"""Joints of a robot description."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from nao_library_modules.driver.urdf_joints import UrdfJoint, movable_joints
from naoqi.errors import NaoError

OURS = Path(__file__).parents[4] / "nao_sim_bridge" / "urdf" / "nao_h25.urdf"

SMALL = """<robot name="x">
<joint name="fixed" type="fixed"/>
<joint name="knee" type="revolute"><limit lower="0.1" upper="2.0"/></joint>
<joint name="wheel" type="continuous"/>
<joint name="finger" type="revolute"><limit lower="0" upper="1"/><mimic joint="knee"/></joint>
</robot>"""


def test_joints_that_are_fixed_or_follow_another_have_no_slider():
    assert movable_joints(SMALL) == [UrdfJoint("knee", 0.1, 2.0), UrdfJoint("wheel", -math.pi, math.pi)]


def test_the_rest_is_zero_or_the_limit_nearest_to_it():
    assert [joint.rest for joint in movable_joints(SMALL)] == [0.1, 0.0]


def test_the_nao_has_its_joints():
    names = [joint.name for joint in movable_joints(OURS.read_text())]
    assert {"HeadYaw", "LHand", "RAnkleRoll"} <= set(names)
    assert not any("Finger" in name for name in names)


@pytest.mark.parametrize("text", ["<robot", "<robot/>"])
def test_what_is_no_description_is_told(text):
    with pytest.raises(NaoError, match="robot description"):
        movable_joints(text)
