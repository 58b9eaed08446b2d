"""ALVideoDevice of the robot, as clients have it."""

import numpy as np
import pytest


@pytest.fixture
def video(robot):
    return robot.ALVideoDevice


@pytest.fixture
def image(robot):
    """The next picture of a subscriber."""

    def take(handle, method="getImageRemote", after=1 / 30):
        return robot.finish("ALVideoDevice", method, handle, after=after)

    return take


@pytest.fixture
def pixels(image):
    """The next picture of a subscriber, (h, w) or (h, w, layers) integers."""

    def take(handle, **options):
        width, height, layers, *_, data = image(handle, **options)[:7]
        return np.frombuffer(bytes(data), np.uint8).reshape(height, width, layers).squeeze().astype(int)

    return take
