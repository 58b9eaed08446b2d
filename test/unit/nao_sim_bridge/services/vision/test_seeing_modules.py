"""ALRedBallDetection, ALLandMarkDetection and ALBarcodeReader over the network: drawn pictures, real detectors."""

from __future__ import annotations

import json
import logging
import math
import os
import signal
import threading

import numpy as np
import pytest

from nao_sim_bridge.sim.cameras.optics import CameraOptics
from nao_sim_bridge.sim.kinematics import rpy_matrix

BALL, MARK, CODE = "redBallDetected", "LandmarkDetected", "BarcodeReader/BarcodeDetected"
MODULES = {"ALRedBallDetection": BALL, "ALLandMarkDetection": MARK, "ALBarcodeReader": CODE}
TOP, BOTTOM, VGA = 0, 1, 2
FACING = 3.14159
OPTICS = CameraOptics("V6", 0)


class Witness:
    """Hears an event, in the thread that raises it."""

    def __init__(self, server, event):
        self.values = []
        self.times = []
        self._server = server
        server.memory.listen(event, self._hear)

    def _hear(self, value):
        self.values.append(value)
        self.times.append(self._server.simulation.time)

    @property
    def stamps(self):
        return [seconds + microseconds / 1e6 for (seconds, microseconds), *_ in filter(None, self.values)]


@pytest.fixture
def robot(stiff_robot):
    """A robot that stands on stiff legs in an empty room, and whose extractors nobody uses any more afterwards."""
    yield stiff_robot
    for module in MODULES:
        service = getattr(stiff_robot, module)
        for name, *_ in service.getSubscribersInfo():
            service.unsubscribe(name)
    stiff_robot.ALLandMarkDetection.setActiveCamera(TOP)
    stiff_robot.ALBarcodeReader.setResolution(VGA)
    stiff_robot.ALVideoDevice.setActiveCamera(TOP)


@pytest.fixture
def place(robot):
    """Puts a thing into the world that stays where it is."""

    def put(name, position, **entry):
        robot.NaoSimulation.placeObject(json.dumps({"name": name, "position": position, "mass": 0.0, **entry}))

    return put


@pytest.fixture
def witness(robot):
    return lambda event: Witness(robot.server, event)


def seen_from(pose_in_robot, point):
    """(alpha, beta) of a point in FRAME_ROBOT, seen from a camera."""
    x, y, z = rpy_matrix(pose_in_robot[3:]).T @ (np.array(point) - pose_in_robot[:3])
    return math.atan2(y, x), math.atan2(-z, x)


def standing_at(robot):
    """(3,) where FRAME_ROBOT is in world, from its own odometry: it has not walked since the reset."""
    x, y, _ = robot.ALMotion.getRobotPosition(True)
    return np.array((x, y, 0.0))


@pytest.mark.parametrize("module, event", MODULES.items())
def test_they_say_which_event_they_raise_and_nothing_is_seen_at_first(robot, module, event):
    service = getattr(robot, module)
    assert service.getEventList() == service.getOutputNames() == [event]
    assert service.getMemoryKeyList() == []
    assert robot.ALMemory.getData(event) == []


def test_a_ball_is_told_with_each_picture_in_the_layout_of_naoqi(robot, place, witness):
    place("ball_to_find", [0.8, 0.12, 0.42], ball=0.05)
    balls = witness(BALL)
    robot.ALRedBallDetection.subscribe("test")
    robot.advance(0.5)
    assert len(balls.values) == 15
    stamp, (alpha, beta, size_x, size_y), in_torso, in_robot, camera = balls.values[-1]
    assert robot.ALMemory.getData(BALL) == balls.values[-1]
    assert [type(number) for number in stamp] == [int, int]
    assert len(in_torso) == len(in_robot) == 6
    assert camera == TOP
    wanted = seen_from(in_robot, np.array((0.8, 0.12, 0.42)) - standing_at(robot))
    assert (alpha, beta) == pytest.approx(wanted, abs=math.radians(1.0))
    assert size_x == size_y == pytest.approx(math.asin(0.05 / 0.75), rel=0.1)


def test_events_come_when_their_pictures_are_taken_however_fast_time_runs(robot, place, witness):
    place("ball_to_find", [0.8, 0.0, 0.42], ball=0.05)
    balls = witness(BALL)
    robot.ALRedBallDetection.subscribe("test")
    robot.advance(1.0)
    assert np.diff(balls.stamps) == pytest.approx(1 / 30, abs=0.0085)  # to the nearest tick
    assert balls.times == pytest.approx(balls.stamps, abs=1e-6)


def test_a_ball_that_goes_leaves_an_empty_list_and_nobody_is_told(robot, place, witness):
    place("ball_to_find", [0.8, 0.0, 0.42], ball=0.05)
    balls = witness(BALL)
    robot.ALRedBallDetection.subscribe("test")
    robot.advance(0.2)
    robot.NaoSimulation.removeObject("ball_to_find")
    told = len(balls.values)
    assert told >= 5
    robot.advance(0.2)
    assert robot.ALMemory.getData(BALL) == []
    assert len(balls.values) == told


def test_the_ball_is_looked_for_with_the_active_camera(robot, place, witness):
    place("ball_to_find", [0.45, 0.0, 0.05], ball=0.05)  # below what the top camera sees
    balls = witness(BALL)
    robot.ALRedBallDetection.subscribe("test")
    robot.advance(0.2)
    assert balls.values == []
    robot.ALVideoDevice.setActiveCamera(BOTTOM)
    robot.advance(0.3)
    _, (alpha, beta, *_), _, in_robot, camera = balls.values[-1]
    assert camera == BOTTOM
    wanted = seen_from(in_robot, np.array((0.45, 0.0, 0.05)) - standing_at(robot))
    assert (alpha, beta) == pytest.approx(wanted, abs=math.radians(1.0))


def test_marks_are_told_with_each_picture_and_once_when_they_are_gone(robot, place, witness):
    place("left", [1.0, 0.2, 0.45], landmark=64, heading=FACING)
    place("right", [1.0, -0.2, 0.45], landmark=187, rpy=[0.3, 0.0, FACING])
    marks = witness(MARK)
    robot.ALLandMarkDetection.subscribe("test")
    robot.advance(0.4)
    assert len(marks.values) == 6  # 15 pictures a second
    stamp, seen, in_torso, in_robot, camera = marks.values[-1]
    assert camera == "CameraTop" and len(in_torso) == 6
    assert [(shape[0], number) for shape, number in seen] == [(1, [64]), (1, [187])]
    for (_, alpha, beta, width, height, _), side in zip((shape for shape, _ in seen), (0.2, -0.2)):
        wanted = seen_from(in_robot, np.array((1.0, side, 0.45)) - standing_at(robot))
        assert (alpha, beta) == pytest.approx(wanted, abs=math.radians(1.0))
        assert (width, height) == pytest.approx((0.095, 0.095), rel=0.12)
    # It was rolled by 0.3 rad about the axis that points at the robot: counterclockwise as the robot sees it.
    assert seen[0][0][5] == pytest.approx(0.0, abs=0.06)
    assert seen[1][0][5] == pytest.approx(0.3, abs=0.06)
    robot.NaoSimulation.removeObject("left")
    robot.NaoSimulation.removeObject("right")
    robot.advance(0.4)
    assert marks.values[-1] == [] and marks.values.count([]) == 1
    assert robot.ALMemory.getData(MARK) == []


def test_marks_are_looked_for_with_the_camera_that_was_chosen(robot, place, witness):
    place("low", [0.5, 0.0, 0.15], landmark=112, rpy=[0.0, -0.6, FACING])
    marks = witness(MARK)
    assert robot.ALLandMarkDetection.setActiveCamera(BOTTOM) is True
    robot.ALLandMarkDetection.subscribe("test")
    robot.advance(0.3)
    _, seen, _, _, camera = marks.values[-1]
    assert ([number for _, number in seen], camera) == ([[112]], "CameraBottom")


def test_codes_are_told_with_their_corners_in_pixels(robot, place, witness):
    place("qr_code", [0.9, 0.15, 0.45], qr="naoqi", size=0.2, heading=FACING)
    place("barcode", [0.5, -0.1, 0.45], barcode="4006381333931", size=0.2, heading=FACING)
    codes = witness(CODE)
    marks = witness(MARK)
    robot.ALBarcodeReader.subscribe("test")
    robot.ALLandMarkDetection.subscribe("test")
    robot.advance(0.5)
    assert len(codes.values) == 5  # 10 pictures a second
    found = dict(codes.values[-1])
    assert set(found) == {"naoqi", "4006381333931"}
    corners = np.array(found["naoqi"])
    assert corners.shape == (4, 2)
    middle = OPTICS.angles(*(corners.mean(axis=0) / (640, 480)))
    pose = robot.ALMotion.getPosition("CameraTop", 2, True)
    wanted = seen_from(pose, np.array((0.9, 0.15, 0.45)) - standing_at(robot))
    assert middle == pytest.approx(wanted, abs=math.radians(1.0))
    assert [value for value in marks.values if value] == []  # a code is no mark
    robot.NaoSimulation.removeObject("qr_code")
    robot.NaoSimulation.removeObject("barcode")
    robot.advance(0.3)
    assert robot.ALMemory.getData(CODE) == []


def test_nothing_is_told_of_an_empty_room(robot, witness):
    witnesses = [witness(event) for event in MODULES.values()]
    for module in MODULES:
        getattr(robot, module).subscribe("test")
    robot.advance(0.5)
    assert [seen.values for seen in witnesses] == [[], [], []]


def test_pictures_are_looked_at_once_a_period(robot, place, witness):
    place("ball_to_find", [0.8, 0.0, 0.42], ball=0.05)
    balls = witness(BALL)
    robot.ALRedBallDetection.subscribe("slow", 300, 0.0)
    robot.advance(0.95)
    assert np.diff(balls.stamps) == pytest.approx([1 / 3] * (len(balls.values) - 1), abs=0.02)
    robot.ALRedBallDetection.subscribe("quick", 100, 0.0)
    before = len(balls.values)
    robot.advance(1.0)
    assert len(balls.values) - before == pytest.approx(10, abs=1)


def test_a_pause_is_one(robot, place, witness):
    place("mark_to_read", [1.0, 0.0, 0.45], landmark=85, heading=FACING)
    marks = witness(MARK)
    reader = robot.ALLandMarkDetection
    reader.subscribe("test")
    robot.advance(0.2)
    reader.pause(True)
    assert (reader.isPaused(), reader.isProcessing()) == (True, False)
    told = len(marks.values)
    assert marks.values[-1] == []  # nothing is seen now
    robot.advance(0.3)
    assert len(marks.values) == told
    reader.pause(False)
    robot.advance(0.2)
    assert len(marks.values) > told


def test_a_dead_vision_process_is_started_again_and_nobody_is_lost(robot, place, witness, caplog):
    place("ball_to_find", [0.8, 0.2, 0.42], ball=0.05)
    place("mark_to_read", [1.0, -0.2, 0.45], landmark=85, heading=FACING)
    balls, marks = witness(BALL), witness(MARK)
    robot.ALRedBallDetection.subscribe("test")
    robot.ALLandMarkDetection.subscribe("test")
    robot.advance(0.2)
    told = len(balls.values), len(marks.values)
    assert min(told) >= 3
    os.kill(robot.server.vision.process.pid, signal.SIGKILL)
    robot.advance(0.4)
    assert (len(balls.values) - told[0], len(marks.values) - told[1]) == (12, 6)
    warnings = [record.getMessage() for record in caplog.records if record.levelno >= logging.WARNING]
    assert len(warnings) == 1 and "it is started again" in warnings[0]


def test_a_client_that_asks_in_the_event_gets_its_answer(robot, place):
    """Events come in a thread that must not hold up what their listeners ask for."""
    place("ball_to_find", [0.8, 0.0, 0.42], ball=0.05)
    answers = []
    there = threading.Event()

    def ask(value):
        if not there.is_set():
            answers.append((value, robot.ALRedBallDetection.getSubscribersInfo()))
            there.set()

    subscriber = robot.ALMemory.subscriber(BALL)
    subscriber.signal.connect(ask)
    robot.ALRedBallDetection.subscribe("test", 50, 0.5)
    robot.advance(0.3)
    assert there.wait(robot.patience)
    assert answers[0][1] == [["test", 50, 0.5]]
