"""ALColorBlobDetection: a ball of any colour, where it is, and ALTracker that follows it."""

from __future__ import annotations

import math

import numpy as np
import pytest

EVENT = "ALTracker/ColorBlobDetected"
ROBOT = 2
BALL = "{{name: ball, sphere: 0.05, color: [0.05, 0.7, 0.1], position: [{}, {}, {}], mass: 0.0}}"


@pytest.fixture
def blobs(robot, witness):
    """What is told of a green ball of 10 cm."""
    found, blobs = witness(EVENT), robot.ALColorBlobDetection
    blobs.setColor(12, 90, 8, 45)
    blobs.setObjectProperties(20, 0.1, "Circle")
    blobs.subscribe("test")
    return found


def test_a_blob_is_told_with_its_place_until_it_goes(robot, blobs):
    robot.advance(0.2)
    assert blobs.values == [] and robot.ALColorBlobDetection.getCircle() == []
    robot.NaoSimulation.placeObject(BALL.format(0.8, 0.15, 0.45))
    robot.advance(0.5)
    in_torso, in_robot, stamp, effector = blobs.values[-1]
    x, y, _ = robot.ALMotion.getRobotPosition(True)
    assert in_robot[:3] == pytest.approx((0.8 - x, 0.15 - y, 0.45), abs=0.08) and in_robot[3:] == [0.0] * 3
    assert math.dist(in_torso[:3], in_robot[:3]) == pytest.approx(0.33, abs=0.03) and effector == 1
    assert len(blobs.values) in (7, 8) and stamp[0] + stamp[1] / 1e6 == pytest.approx(blobs.times[-1], abs=1e-5)
    circle = np.array(robot.ALColorBlobDetection.getCircle())
    assert circle[0] < 0.5 and circle[2] == pytest.approx(0.05 / 0.8 / 2 / math.tan(math.radians(56.3) / 2), rel=0.2)
    robot.NaoSimulation.removeObject("ball")
    told = len(blobs.values)
    robot.advance(0.3)
    assert len(blobs.values) <= told + 1 and robot.ALColorBlobDetection.getCircle() == []


def test_the_tracker_follows_it_as_an_event(robot, blobs):
    robot.NaoSimulation.placeObject(BALL.format(0.8, 0.3, 0.45))
    robot.ALTracker.trackEvent(EVENT)
    robot.advance(1.5)
    yaw, _ = robot.ALMotion.getAngles("Head", True)
    assert yaw == pytest.approx(math.atan2(0.3, 0.8), abs=0.06)


def test_exposure_is_that_of_its_camera(robot):
    blobs = robot.ALColorBlobDetection
    blobs.setAutoExposure(False)
    assert not blobs.getAutoExposure() and robot.ALVideoDevice.getParameter(0, 11) == 0
    with pytest.raises(RuntimeError, match="^ALColorBlobDetection::setColor g is 300, allowed is a whole number, 0 to"):
        blobs.setColor(0, 300, 0, 10)
    with pytest.raises(RuntimeError, match="shape is 'Square', allowed is one of Circle, Unknown"):
        blobs.setObjectProperties(10, 0.1, "Square")
