"""The motion module on stand-ins that walk."""

from __future__ import annotations

import pytest
from fake_motion import FakeMotion, FakePostures


@pytest.fixture
def fake(robot, make_call):
    fake = FakeMotion(make_call)
    robot.add("ALMotion", fake)
    robot.add("ALRobotPosture", FakePostures())
    return fake


@pytest.fixture
def motion(robot, edge, fake, tmp_path):
    from nao_library_modules.motion import NaoMotion

    return NaoMotion("10.0.0.7", 9559, robot=robot, edge=edge, motion_dir=tmp_path)
