"""Ball, landmarks, codes, faces and movement in what the simulated cameras see."""

from __future__ import annotations

import math

import numpy as np
import pytest
from goal_functions import vision as f

EXTRACTORS = "ALRedBallDetection", "ALFaceDetection", "ALLandMarkDetection", "ALBarcodeReader", "ALMovementDetection"
BEARING = math.radians(2.0)
MICROSECOND = 1e-6
"""NAOqi tells times of pictures in whole ones."""
FUNCTIONS = "detectBall", "detectLandmarks", "detectFaces", "readBarcodes", "detectMovement"


def point(message):
    return np.array([message.x, message.y, message.z])


def angle_between(first, second):
    cosine = np.dot(first, second) / np.linalg.norm(first) / np.linalg.norm(second)
    return float(np.arccos(np.clip(cosine, -1.0, 1.0)))


def ahead(seen):
    """Direction of what was seen in the camera's frame: X along its axis, Y left, Z up."""
    x, y, z = point(seen.camera_position)
    return z, -x, -y


@pytest.fixture
def check(things):
    def check(seen, place, distance_error=0.12):
        """What was seen is at a place of the world, as far as its direction and its distance go."""
        camera = {"top": "CameraTop", "bottom": "CameraBottom"}[seen.camera]
        true = things.in_camera(place, camera)
        length = np.linalg.norm(true)
        assert angle_between(ahead(seen), true) < BEARING and seen.located
        assert seen.distance == pytest.approx(length, rel=distance_error)
        assert np.linalg.norm(point(seen.position) - things.in_base(place)) < (distance_error + BEARING) * length + 0.01
        assert (seen.header.frame_id, seen.base_frame) == (f"robot1/{camera}_optical_frame", "robot1/base_footprint")

    return check


@pytest.fixture(autouse=True)
def idle(robot):
    """At the end nothing works for nobody, and every camera is as it was."""

    def check():
        for module in EXTRACTORS:
            assert getattr(robot, module).getSubscribersInfo() == [], module
        assert robot.ALVideoDevice.getActiveCamera() == robot.ALLandMarkDetection.getActiveCamera() == 0
        return True

    yield check
    check()


def test_a_ball_is_where_it_is_in_both_cameras(robot, vision, things, check):
    for distance, left, camera, pitch in ((0.5, 0.1, "bottom", 0.0), (1.0, -0.25, "top", 0.2)):
        robot.ALMotion.setAngles("HeadPitch", pitch, 0.5)
        robot.advance(0.5)
        place = things.place("ball", (distance, left, 0.03), ball=0.03)
        result = vision.succeed(f("detectBall", camera=camera, count=3))
        (ball,) = result.objects
        check(ball, place)
        assert (ball.kind, ball.name, ball.camera, ball.looks) == ("ball", "", camera, 3) and result.memList == ["ball"]
        assert -0.01 <= robot.now.time - ball.header.stamp.to_sec() < 1.0
        things.remove("ball")
    things.place("ball", place, ball=0.03)
    near, far = vision.succeed(f("detectBall"), f("detectBall", size=0.06)).objects
    assert far.distance == pytest.approx(2.0 * near.distance, rel=0.05)


def test_landmarks_have_numbers_and_places(vision, things, check):
    places = {"64": things.from_camera(0.5, 0.1), "114": things.from_camera(1.0, -0.3, 0.1)}
    for number, place in places.items():
        things.place(f"mark{number}", place, things.facing, landmark=number)
    goal = vision.play(f("detectLandmarks", count=3), f("detectLandmarks", str_param=" 0114 "))
    assert [sorted(each.values) for each in goal.result.results] == [["114", "64"], ["114"]]
    for seen in goal.result.objects:
        check(seen, places[seen.name])
    told = [feedback for feedback in goal.feedback if feedback.status == "looking"]
    assert {seen.name for feedback in told for seen in feedback.objects} == {"64", "114"}


def test_codes_say_something_and_have_a_distance_where_their_size_is_known(vision, things, check):
    place = things.place("code", things.from_camera(0.5, 0.05), things.facing, qr="nao_library", size=0.15)
    result = vision.succeed(f("readBarcodes"))
    (code,) = result.objects
    assert (result.memList, code.located, code.distance) == (["nao_library"], False, 0.0)
    assert angle_between(ahead(code), things.in_camera(place)) < BEARING
    assert np.linalg.norm(point(code.camera_position)) == pytest.approx(1.0)
    (code,) = vision.succeed(f("readBarcodes", str_param="nao_library", size=code.width * 0.5, timeout=2.0)).objects
    assert code.located and code.distance > 0.1


def test_a_face_is_learnt_known_and_forgotten(robot, vision, things):
    vision.succeed(f("forgetAllFaces"))
    assert vision.succeed(f("learnFace", str_param="Anna", timeout=0.5)).memList == ["False"], "nobody is there"
    place = things.place("card", things.from_camera(0.8), things.facing, face="anna")
    result = vision.succeed(
        f("detectFaces"), f("learnFace", str_param=" Anna "), f("listFaces"), f("detectFaces", count=4)
    )
    assert [each.values for each in result.results] == [["face"], ["True"], ["Anna"], ["Anna"]]
    learnt, face = result.objects[-2:]
    assert (face.kind, face.name, learnt.name) == ("face", "Anna", "Anna") and face.confidence >= 0.4
    assert angle_between(ahead(face), things.in_camera(place)) < 2.0 * BEARING
    assert vision.succeed(f("detectFaces", str_param="Ben", timeout=0.5)).memList == []
    assert "reLearnFace" in vision.refused(f("learnFace", str_param="Anna"))
    for function in ("reLearnFace", "forgetFace"):
        text = vision.refused(f(function, str_param="Ana"))
        assert "'Ana'" in text and "learnt are Anna" in text
    assert vision.succeed(f("reLearnFace", str_param="Anna")).memList == ["True"]
    assert vision.succeed(f("forgetPerson", str_param="Anna"), f("getLearnedFacesList")).memList == []


def test_what_moves_is_seen_with_the_sensitivity_that_is_asked_for(robot, vision, things):
    things.place("ben", (2.0, 1.0, 0.0), things.facing, person="ben")
    before = robot.ALMovementDetection.getColorSensitivity()
    goal = vision.send(f("detectMovement", timeout=10.0, count=2, sensitivity=0.9))
    sensitivity = robot.ALMovementDetection.getColorSensitivity
    robot.advance_until(lambda: sensitivity() == pytest.approx(0.9), 2.0, what="the sensitivity")
    robot.advance(0.5)
    things.move("ben", (2.0, -1.0, 0.0), things.facing, 4.0)
    goal.finish()
    assert goal.state == "succeeded" and goal.result.objects
    largest = max(goal.result.objects, key=lambda seen: seen.width * seen.height)
    assert abs(largest.alpha) < math.radians(32.0) and (largest.kind, largest.located) == ("movement", False)
    assert robot.ALMovementDetection.getColorSensitivity() == pytest.approx(before)
    robot.ALMovementDetection.subscribe("somebody")
    assert f"sensitivity {before:g}" in vision.refused(f("detectMovement", sensitivity=0.9))
    robot.ALMovementDetection.unsubscribe("somebody")


def test_nothing_in_view_is_an_answer(robot, vision):
    began = robot.now.time
    result = vision.succeed(*(f(function, timeout=0.5) for function in FUNCTIONS))
    assert (result.objects, result.memList) == ([], []) and [each.values for each in result.results] == [[]] * 5
    assert robot.now.time - began == pytest.approx(2.5, abs=0.8)


def test_a_preempted_look_ends_at_once_and_leaves_nothing(robot, vision, idle):
    for function in (*FUNCTIONS, "learnFace"):
        goal = vision.send(f(function, str_param="7", timeout=60.0, camera="bottom"))
        robot.advance(0.3)
        began = robot.now.time
        assert goal.cancel().state == "preempted" and robot.now.time - began < 5.0 and idle()


REFUSED = [
    (f("detectBall", camera="left"), "bottom or 1"),
    (f("detectBall", timeout=-1.0), "timeout"),
    (f("detectBall", confidence=1.5), "confidence"),
    (f("detectBall", count=-1), "count"),
    (f("detectBall", size=-0.03), "size"),
    (f("detectLandmarks", str_param="x"), "number of a landmark"),
    (f("detectMovement", sensitivity=2.0), "sensitivity"),
    (f("learnFace"), "name of a person"),
    (f("trackBall", duration=-1.0), "duration"),
    (f("trackFace", speed=1.5), "speed"),
    (f("lookFor", str_param="cat"), "ball, face, landmark, code"),
    (f("lookFor", str_param="ball red"), "no names"),
]


def test_what_cannot_be_is_refused_before_anything_runs(robot, vision):
    began = robot.now.time
    for message, text in REFUSED:
        refused = vision.refused(f("detectBall", timeout=60.0), message)
        assert text in refused and refused.startswith(f"function 2 ({message.function})")
    assert robot.now.time - began < 20.0


@pytest.mark.parametrize(
    "function, thing, pictures",
    [
        ("detectBall", {"ball": 0.03}, 30),
        ("detectLandmarks", {"landmark": "64"}, 15),
        ("readBarcodes", {"qr": "nao", "size": 0.2}, 10),
        ("detectFaces", {"face": "anna"}, 10),
        ("detectMovement", {"ball": 0.1}, 10),
    ],
)
def test_sights_have_the_times_of_the_first_and_the_last_picture(robot, vision, things, function, thing, pictures):
    goal = vision.send(f(function, count=2, timeout=10.0))
    robot.advance(0.6)
    things.place("thing", things.from_camera(0.8), things.facing, **thing)
    placed = robot.now.time
    (one,) = goal.finish().result.results
    onset, offset = one.onset.to_sec(), one.offset.to_sec()
    assert -0.010 < onset - placed < 1.0 / pictures + 0.010
    assert onset < offset <= one.end.to_sec() + 1e-6, "the robot tells whole microseconds"
    seen = [feedback for feedback in goal.feedback if feedback.objects]
    stamps = [feedback.stamp.to_sec() for feedback in seen]
    assert [stamps[0], stamps[-1]] == pytest.approx([onset, offset], abs=1e-6)
    assert [feedback.objects[0].header.stamp for feedback in seen] == [feedback.stamp for feedback in seen]
