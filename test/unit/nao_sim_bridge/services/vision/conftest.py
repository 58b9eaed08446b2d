"""ALVideoDevice of the robot, as clients have it."""

from __future__ import annotations

import pytest

from naoqi import ALProxy

TOP, BOTTOM = 0, 1


@pytest.fixture
def video(robot):
    device = robot.ALVideoDevice
    yield device
    for handle in device.getSubscribers():
        device.unsubscribe(handle)
    for camera in (TOP, BOTTOM):
        device.resetCamera(camera)
    device.setActiveCamera(TOP)


@pytest.fixture
def proxy(robot):
    return ALProxy("ALVideoDevice", "127.0.0.1", robot.server.broker.port)


@pytest.fixture
def image(robot):
    """The next picture of a subscriber."""

    def take(handle, method="getImageRemote", after=1 / 30):
        future = robot.post("ALVideoDevice", method, handle)
        robot.handed_over("ALVideoDevice")
        robot.advance(after)
        return robot.answer(future)

    return take
