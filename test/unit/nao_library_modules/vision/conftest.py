"""The module for vision on stand-ins."""

from __future__ import annotations

import pytest
from fake_vision import FakeTopics, FakeVideoDevice


@pytest.fixture
def topics():
    return FakeTopics()


@pytest.fixture
def device(robot):
    device = FakeVideoDevice()
    robot.add("ALVideoDevice", device)
    return device


@pytest.fixture
def vision(robot, edge, topics, device, tmp_path):
    from nao_library_modules.vision import NaoVision

    # No goal asks the extractors here.
    robot.connection.state = "connecting"
    vision = NaoVision("10.0.0.7", 9559, robot=robot, edge=edge, topics=topics, record_dir=str(tmp_path / "files"))
    yield vision
    vision.threads.close()


@pytest.fixture
def play(vision):
    from nao_library_actions.msg import NaoVisionGoal

    return lambda *functions: vision.server.play(NaoVisionGoal(list(functions)))


@pytest.fixture
def succeed(play):
    def run(*functions):
        server = play(*functions)
        assert server.end == "succeeded", server.text
        return server.result

    return run


@pytest.fixture
def refused(play):
    def run(*functions):
        server = play(*functions)
        assert server.end == "aborted"
        return server.text

    return run
