"""The module for vision on a robot of stand-ins."""

from __future__ import annotations

import pytest
from fake_seeing import Eyes, SeeingClock


@pytest.fixture
def eyes(robot):
    return Eyes(robot)


@pytest.fixture
def clock(edge, eyes):
    edge.clock = SeeingClock()

    def go_on(duration, picture):
        eyes.head.move(duration)
        if picture:
            eyes.look(edge.clock.time)

    edge.clock.every.append(go_on)
    return edge.clock


@pytest.fixture
def vision(robot, edge, clock, eyes, tmp_path):
    from nao_library_modules.vision import NaoVision

    return NaoVision("10.0.0.7", 9559, record_dir=str(tmp_path), topics=object(), robot=robot, edge=edge)
