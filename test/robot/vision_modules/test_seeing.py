"""ALRedBallDetection, ALLandMarkDetection and ALBarcodeReader over the network: drawn pictures, real detectors."""

from __future__ import annotations

import math

import numpy as np
import pytest

from nao_sim_bridge.cameras.optics import CameraOptics
from nao_sim_bridge.model.kinematics import rpy_matrix

BALL, MARK, CODE = "redBallDetected", "LandmarkDetected", "BarcodeReader/BarcodeDetected"
TOP, BOTTOM = 0, 1
DEGREE = math.radians(1.0)


def seen_from(robot, pose_in_robot, *point):
    """(alpha, beta) of a point of the world, seen from a camera in FRAME_ROBOT; it has not walked since the reset."""
    x, y, _ = robot.ALMotion.getRobotPosition(True)
    x, y, z = rpy_matrix(pose_in_robot[3:]).T @ (np.array(point) - (x, y, 0.0) - pose_in_robot[:3])
    return math.atan2(y, x), math.atan2(-z, x)


@pytest.mark.parametrize("distance, left, camera", [(0.45, 0.0, BOTTOM), (0.8, 0.12, TOP), (1.5, -0.4, TOP)])
def test_a_ball_is_told_with_each_picture_until_it_goes(robot, place, witness, distance, left, camera):
    radius, height = 0.05, 0.42 if camera == TOP else 0.05
    place("ball", distance, left, height, ball=radius)
    robot.ALVideoDevice.setActiveCamera(camera)
    balls = witness(BALL)
    robot.ALRedBallDetection.subscribe("test")
    robot.advance(0.5)
    assert robot.ALRedBallDetection.getEventList() == robot.ALRedBallDetection.getOutputNames() == [BALL]
    assert len(balls.values) == 15
    assert np.diff(balls.stamps) == pytest.approx(1 / 30, abs=0.0085)  # to the nearest tick
    assert balls.times == pytest.approx(balls.stamps, abs=1e-6), "however fast time runs"
    stamp, (alpha, beta, size_x, size_y), in_torso, in_robot, active = balls.values[-1]
    assert robot.value(BALL) == balls.values[-1] and [type(number) for number in stamp] == [int, int]
    name = ("CameraTop", "CameraBottom")[camera]
    assert in_torso == pytest.approx(robot.ALMotion.getPosition(name, 0, True), abs=0.003)
    assert in_robot == pytest.approx(robot.ALMotion.getPosition(name, 2, True), abs=0.003)
    assert active == camera
    assert (alpha, beta) == pytest.approx(seen_from(robot, in_robot, distance, left, height), abs=DEGREE)
    x, y, _ = robot.ALMotion.getRobotPosition(True)
    away = math.dist((distance - x, left - y, height), in_robot[:3])
    assert size_x == size_y == pytest.approx(math.asin(radius / away), rel=0.05)
    robot.NaoSimulation.removeObject("ball")
    robot.advance(0.2)
    assert robot.value(BALL) == [] and [] not in balls.values


def test_marks_are_told_with_each_picture_and_once_when_they_are_gone(robot, place, witness):
    place("left", 1.0, 0.2, 0.45, landmark=64)
    place("right", 1.0, -0.2, 0.45, landmark=187, rpy=[0.3, 0.0, 3.14159])
    marks = witness(MARK)
    robot.ALLandMarkDetection.subscribe("test")
    robot.advance(0.4)
    assert len(marks.values) == 6  # 15 pictures a second
    stamp, seen, in_torso, in_robot, camera = marks.values[-1]
    assert camera == "CameraTop" and len(in_torso) == 6
    assert [(shape[0], number) for shape, number in seen] == [(1, [64]), (1, [187])]
    # It was rolled by 0.3 rad about the axis that points at the robot: counterclockwise as the robot sees it.
    for ((_, alpha, beta, width, height, heading), _), side, rolled in zip(seen, (0.2, -0.2), (0.0, 0.3)):
        assert (alpha, beta) == pytest.approx(seen_from(robot, in_robot, 1.0, side, 0.45), abs=DEGREE)
        assert (width, height) == pytest.approx((0.095, 0.095), rel=0.12)
        assert heading == pytest.approx(rolled, abs=0.06)
    for name in ("left", "right"):
        robot.NaoSimulation.removeObject(name)
    robot.advance(0.4)
    assert marks.values[-1] == [] and marks.values.count([]) == 1 and robot.value(MARK) == []


def test_codes_are_told_with_their_corners_in_pixels(robot, place, witness):
    place("qr_code", 0.9, 0.15, 0.45, qr="naoqi", size=0.2)
    place("barcode", 0.5, -0.1, 0.45, barcode="4006381333931", size=0.2)
    codes, marks = witness(CODE), witness(MARK)
    robot.ALBarcodeReader.subscribe("test")
    robot.ALLandMarkDetection.subscribe("test")
    robot.advance(0.5)
    assert len(codes.values) == 5  # 10 pictures a second
    found = dict(codes.values[-1])
    assert set(found) == {"naoqi", "4006381333931"}
    corners = np.array(found["naoqi"])
    assert corners.shape == (4, 2)
    middle = CameraOptics("V6", 0).angles(*(corners.mean(axis=0) / (640, 480)))
    pose = robot.ALMotion.getPosition("CameraTop", 2, True)
    assert middle == pytest.approx(seen_from(robot, pose, 0.9, 0.15, 0.45), abs=DEGREE)
    assert [value for value in marks.values if value] == []  # a code is no mark
    for name in ("qr_code", "barcode"):
        robot.NaoSimulation.removeObject(name)
    robot.advance(0.3)
    assert robot.value(CODE) == []


def test_pictures_are_looked_at_once_a_period_unless_it_is_paused(robot, place, witness):
    place("mark", 1.0, 0.0, 0.45, landmark=85)
    marks, reader = witness(MARK), robot.ALLandMarkDetection
    reader.subscribe("slow", 300, 0.0)
    robot.advance(0.95)
    assert np.diff(marks.stamps) == pytest.approx([1 / 3] * (len(marks.values) - 1), abs=0.02)
    reader.subscribe("quick", 100, 0.0)
    before = len(marks.values)
    robot.advance(1.0)
    assert len(marks.values) - before == pytest.approx(10, abs=1)
    reader.pause(True)
    assert (reader.isPaused(), reader.isProcessing()) == (True, False) and marks.values[-1] == []
    told = len(marks.values)
    robot.advance(0.3)
    assert len(marks.values) == told
    reader.pause(False)
    robot.advance(0.2)
    assert len(marks.values) > told
