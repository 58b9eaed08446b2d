"""ALFaceDetection and ALMovementDetection over the network, with cards of faces and things that glide by."""

from __future__ import annotations

import math

import pytest

EVENT = "FaceDetected"
DETECTED, NONE, INFO = (f"MovementDetection/{name}" for name in ("MovementDetected", "NoMovement", "MovementInfo"))
SOON = 0.7
"""Long enough for several pictures, s."""


@pytest.fixture
def faces(robot):
    faces = robot.ALFaceDetection
    faces.subscribe("test")
    return faces


@pytest.fixture
def show(robot, place):
    """Puts up the card of somebody, to the left by `y` m."""

    def show(face, y=0.0, name="card"):
        place(name, 1.0, y, 0.55, face=face)
        robot.advance(SOON)

    return show


@pytest.fixture
def learn(robot):
    return lambda name, method="learnFace": robot.finish("ALFaceDetection", method, name, after=0.6)


@pytest.fixture
def labels(robot):
    return lambda: [face[1][2] for face in (robot.value(EVENT) or [0, [0]])[1][:-1]]


def test_the_event_says_where_a_face_is_as_naoqi_does_and_once_that_nobody_is_there_any_more(
    robot, faces, show, witness
):
    heard = witness(EVENT)
    show("anna", y=0.2)
    (seconds, micros), (face, news), in_torso, in_robot, camera = robot.value(EVENT)
    assert robot.now.time - 0.11 < seconds + 1e-6 * micros <= robot.now.time
    (zero, alpha, beta, width, height), extra = face
    assert zero == 0 and alpha == pytest.approx(0.2, abs=0.03) and 0.0 < beta < 0.3
    assert width == pytest.approx(0.17, abs=0.05) and height == pytest.approx(width, rel=0.1)
    number, score, label, left, right, brow, other_brow, nose, mouth = extra
    assert isinstance(number, int) and (score, label, news) == (0.0, "", [])
    assert [len(points) for points in (left, right, brow, other_brow, nose, mouth)] == [14, 14, 6, 6, 6, 16]
    assert left[0] < alpha < right[0] and left[6:] == [0.0] * 8  # the person's own left
    assert left[1] < nose[1] < mouth[1]
    assert in_torso == pytest.approx(robot.ALMotion.getPosition("CameraTop", 0, True), abs=0.003)
    assert in_robot == pytest.approx(robot.ALMotion.getPosition("CameraTop", 2, True), abs=0.003)
    assert camera == 0
    robot.NaoSimulation.removeObject("card")
    robot.advance(1.0)
    assert robot.value(EVENT) == [] and heard.values[-1] == [] and heard.values.count([]) == 1


def test_relearning_needs_somebody_known_and_people_are_forgotten_and_imported(robot, faces, show, learn, labels):
    assert learn("Nobody") is False
    show("emma")
    assert learn("Emma", "reLearnFace") is False
    assert learn("Emma") and learn("Emma", "reLearnFace")
    assert faces.getLearnedFacesList() == ["Emma"]
    robot.advance(0.3)
    assert labels() == ["Emma"] and robot.value(EVENT)[1][0][1][1] > 0.4
    told = [value[1][-1] for value, *_ in robot.ALMemory.getEventHistory(EVENT) if value]
    assert told.count([2, ["Emma"]]) == 1 and told[-1] == []
    faces.setRecognitionEnabled(False)
    robot.advance(0.3)
    assert labels() == [""] and not faces.isRecognitionEnabled()
    faces.pause(True)
    robot.advance(0.3)
    assert robot.value(EVENT) == []
    folder = robot.server.files.folder
    old = folder / "faces_old.npz"
    old.write_bytes((folder / "faces.npz").read_bytes())
    assert faces.forgetPerson("Emma") and not faces.forgetPerson("Emma")
    assert faces.getLearnedFacesList() == []
    assert faces.importOldDatabase("merge") is True and faces.getLearnedFacesList() == ["Emma"]
    old.write_bytes(b"broken")
    with pytest.raises(RuntimeError, match="faces_old.npz' is no file of known faces"):
        faces.importOldDatabase("keep")
    old.unlink()
    assert faces.importOldDatabase("keep") is False


def test_what_faces_and_movement_cannot_be_is_refused_with_what_they_can(robot):
    for module, method, argument, text in [
        ("Face", "learnFace", "  ", "name is '  ', allowed is the name of somebody"),
        ("Face", "setRecognitionConfidenceThreshold", 1.5, "threshold is 1.5, allowed is 0 to 1"),
        ("Face", "importOldDatabase", "drop", "policy is 'drop', allowed is overwrite or merge or keep"),
        ("Face", "setActiveCamera", 2, "camera is 2, allowed is"),
        ("Movement", "setDepthSensitivity", 0.5, "a NAO has no depth camera"),
        ("Movement", "setColorSensitivity", 1.5, "sensitivity is 1.5, allowed is 0 to 1"),
    ]:
        with pytest.raises(RuntimeError, match=f"AL{module}Detection::{method} .*{text}"):
            getattr(robot, f"AL{module}Detection").call(method, argument)


@pytest.fixture
def movement(robot):
    movement = robot.ALMovementDetection
    movement.subscribe("test")
    return movement


@pytest.fixture
def glide(robot):
    simulation = robot.NaoSimulation
    simulation.placeObject("{name: walker, box: [0.1, 0.1, 0.2], color: [0.1, 0.2, 0.8], position: [1.5, 0.5, 0.5]}")
    return lambda y, duration: simulation.moveObject("walker", [1.5, y, 0.5], [0.0, 0.0, 0.0], duration, _async=True)


def test_what_glides_by_is_told_and_where_until_it_comes_to_rest(robot, movement, glide, witness):
    moving, still = witness(DETECTED), witness(NONE)
    robot.advance(1.0)
    assert len(still.times) == 8 and moving.times == []
    glide(-0.5, 2.0)
    robot.advance(1.0)
    assert moving.times[-1] > robot.now.time - 0.11 and len(moving.times) >= 8
    stamp, clusters, in_torso, in_robot, camera = robot.value(INFO)
    (x, y), (left, top, width, height), (of_picture, of_rectangle) = clusters[0]
    assert x == pytest.approx(math.atan2(0.05, 1.45), abs=0.04)
    assert left > x > left - width and top < y < top + height
    assert 0.0 < of_picture < 0.05 and of_picture < of_rectangle <= 1.0
    assert in_torso == pytest.approx(robot.ALMotion.getPosition("CameraTop", 0, True), abs=0.003)
    assert in_robot == pytest.approx(robot.ALMotion.getPosition("CameraTop", 2, True), abs=0.003)
    assert camera == 0 and stamp[0] + 1e-6 * stamp[1] == pytest.approx(moving.times[-1], abs=1e-5)
    robot.advance(2.5)
    assert moving.times[-1] < robot.now.time - 1.0 and still.times[-1] > robot.now.time - 0.11
    assert movement.getMemoryKeyList() == [INFO] and movement.getEventList() == [DETECTED, NONE]


def test_who_is_followed_has_a_session_and_keeps_the_number_when_the_face_is_learnt(robot, show, learn):
    sessions = robot.ALUserSession
    robot.ALBasicAwareness.setEnabled(True)
    show("anna", y=0.1)
    robot.advance(1.0)
    assert sessions.getOpenUserSessions() == [1] and sessions.getFocusedUser() == 1
    assert learn("Anna") is True
    assert sessions.getUserBindings(1) == {"ALFaceDetection": "Anna"} and sessions.getPermanentUserList() == [1]
    robot.NaoSimulation.removeObject("card")
    robot.advance(4.0)
    assert sessions.getOpenUserSessions() == [] and sessions.getFocusedUser() == -1
    show("anna", y=0.1)
    robot.advance(1.0)
    assert sessions.getFocusedUser() == 1 and sessions.getUserList() == [1]
    assert robot.ALUserInfo.get("name") == "Anna"
