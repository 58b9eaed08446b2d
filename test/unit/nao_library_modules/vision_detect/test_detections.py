"""Ball, landmarks, codes and movement on stand-ins: what is told, where it is, what is left behind."""

from __future__ import annotations

import math

import pytest
from fake_seeing import HFOV, TORSO_HEIGHT, VFOV
from seeing_goals import BALL, CODES, MARKS, MOVED, MOVEMENT_INFO, abort, f, mark, marks_value, play, succeed

from naoqi.errors import RobotError


@pytest.mark.parametrize("angles", [(0.0, 0.0), (0.7, 0.3), (-0.4, 0.5)])
@pytest.mark.parametrize("offset", [(1.0, 0.0, 0.0), (0.5, 0.12, -0.1), (2.0, -0.8, 0.6), (0.3, -0.1, 0.05)])
def test_a_ball_is_where_it_is(vision, eyes, angles, offset):
    """However the head is turned, wherever the ball is in the picture: position, distance and the frame for tf."""
    from fake_seeing import camera_pose

    eyes.head.angles = list(angles)
    x, y, z, _, down, yaw = camera_pose(0, angles)[0]
    ahead, left, up = offset
    flat, height = ahead * math.cos(down) + up * math.sin(down), up * math.cos(down) - ahead * math.sin(down)
    eyes.ball = (
        x + flat * math.cos(yaw) - left * math.sin(yaw),
        y + flat * math.sin(yaw) + left * math.cos(yaw),
        z + height,
    )
    result = succeed(vision, f("detectBall", timeout=1.0))
    (ball,) = result.objects
    assert (ball.kind, ball.name, ball.camera, ball.looks, ball.located) == ("ball", "", "top", 1, True)
    assert (ball.header.frame_id, ball.base_frame) == ("robot1/CameraTop_optical_frame", "robot1/base_footprint")
    assert ball.header.stamp.to_sec() == pytest.approx(100.1)
    distance = math.dist((0, 0, 0), offset)
    assert ball.distance == pytest.approx(distance)
    optical = (ball.camera_position.x, ball.camera_position.y, ball.camera_position.z)
    assert optical == pytest.approx((-left, -up, ahead), abs=1e-6)
    place = (ball.position.x, ball.position.y, ball.position.z)
    expected = (eyes.ball[0], eyes.ball[1], eyes.ball[2] + TORSO_HEIGHT)
    assert place == pytest.approx(expected, abs=1e-6)
    assert ball.x == pytest.approx(0.5 - left / ahead / math.tan(HFOV / 2) / 2)
    assert ball.y == pytest.approx(0.5 - up / ahead / math.tan(VFOV / 2) / 2)
    assert result.memList == ["ball"]
    assert eyes.idle()


def test_a_larger_ball_is_farther_away(vision, eyes):
    eyes.ball = (1.5, 0.0, 0.19)
    near, far = succeed(vision, f("detectBall"), f("detectBall", size=0.06)).objects
    assert far.distance == pytest.approx(2.0 * near.distance)


@pytest.mark.parametrize("function", ["detectBall", "detectLandmarks", "detectFaces", "readBarcodes", "detectMovement"])
def test_nothing_in_view_is_an_answer(vision, eyes, clock, function):
    result = succeed(vision, f(function, timeout=2.0))
    assert (result.objects, result.memList, result.results[0].values) == ([], [], [])
    assert clock.time == pytest.approx(102.0)
    assert eyes.idle()


@pytest.mark.parametrize(
    "function", ["detectBall", "detectLandmarks", "detectFaces", "readBarcodes", "detectMovement", "learnFace"]
)
def test_a_preempted_look_ends_at_once_and_leaves_nothing(vision, eyes, clock, function):
    clock.script = [lambda: None, vision.server.preempt]
    server = play(vision, f(function, str_param="7", timeout=60.0, camera="bottom"))
    assert server.end == "preempted" and clock.time == pytest.approx(100.2)
    assert eyes.idle()


def test_a_robot_that_fails_leaves_nothing_behind(vision, eyes, robot):
    def broken(camera, info):
        raise RobotError("ALVideoDevice", "getImageInfoFromAngularInfo", "no such camera")

    eyes.video.getImageInfoFromAngularInfo = broken
    eyes.ball = (1.0, 0.0, 0.19)
    assert "no such camera" in abort(vision, f("detectBall", camera="top"))
    assert eyes.idle()


def test_a_robot_that_is_lost_ends_the_look(vision, eyes, clock, robot):
    clock.script = [lambda: robot.connection.become("lost", "no answer")]
    assert "went away: no answer" in abort(vision, f("detectBall", timeout=60.0))
    assert clock.time == pytest.approx(100.1) and eyes.idle()


def test_a_value_that_cannot_be_is_passed_over(vision, eyes, clock):
    clock.script = [
        lambda: eyes.raise_event(BALL, [1, 2]),
        lambda: eyes.raise_event(BALL, [[1, 2], [math.nan, 0, 0, 0], *eyes.poses(), 0]),
        lambda: eyes.raise_event(BALL, [[100, 300000], [0.1, 0.0, 0.03, 0.03], *eyes.poses(), 0]),
    ]
    (ball,) = succeed(vision, f("detectBall")).objects
    assert ball.alpha == 0.1 and ball.header.stamp.to_sec() == pytest.approx(100.3)


def test_landmarks_with_their_numbers_and_the_median_of_several_looks(vision, eyes, clock):
    clock.script = [
        lambda: eyes.raise_event(MARKS, []),
        lambda: eyes.raise_event(MARKS, marks_value(eyes, mark(64, 0.1), mark(114, -0.2, 0.1, 0.05, 0.09, 0.3))),
        lambda: eyes.raise_event(MARKS, marks_value(eyes, mark(64, 0.4))),
        lambda: eyes.raise_event(MARKS, marks_value(eyes, mark(64, 0.12), mark(114, -0.2, 0.1, 0.05, 0.09, 0.3))),
    ]
    result = succeed(vision, f("detectLandmarks", count=3))
    first, second = result.objects
    assert result.memList == ["64", "114"] == [first.name, second.name]
    assert (first.looks, first.alpha, second.looks) == (3, 0.12, 2)
    assert (second.heading, second.size_x, second.size_y) == (0.3, 0.05, 0.09)
    # A mark that is seen from the side is narrower: its height tells how far away it is.
    assert second.distance == pytest.approx(0.092 / 0.09 / math.cos(0.22), rel=0.02)
    assert eyes.idle()


def test_times_of_another_clock_become_ros_time(vision, eyes, clock):
    """The quickest picture tells how the clocks go together: the later ones are not from when they came."""

    def picture(robot_time):
        return lambda: eyes.raise_event(MARKS, marks_value(eyes, mark(64), time=robot_time))

    clock.script = [picture(7000.08), picture(7000.20), picture(7000.23)]
    functions = [f("detectLandmarks")] * 3
    stamps = [seen.header.stamp.to_sec() for seen in succeed(vision, *functions).objects]
    assert stamps == pytest.approx([100.1, 100.2, 100.23], abs=0.001)


def test_only_the_landmark_that_is_asked_for(vision, eyes, clock):
    clock.script = [
        lambda: eyes.raise_event(MARKS, marks_value(eyes, mark(64))),
        lambda: eyes.raise_event(MARKS, marks_value(eyes, mark(64), mark(85))),
    ]
    result = succeed(vision, f("detectLandmarks", str_param=" 085 "))
    assert result.memList == ["85"] and clock.time == pytest.approx(100.2)


def corners(x, y, side, turn=0.0):
    c, s = math.cos(turn) * side / 2, math.sin(turn) * side / 2
    return [[x + a * c + b * s, y - a * s + b * c] for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]


def test_codes_say_something_and_are_somewhere(vision, eyes, clock):
    value = [["hello", corners(160, 120, 30)], ["4006381333931", corners(80, 60, 20, math.pi / 4)]]
    clock.script = [lambda: eyes.raise_event(CODES, []), lambda: eyes.raise_event(CODES, value)]
    result = succeed(vision, f("readBarcodes", size=0.08))
    hello, number = result.objects
    assert result.memList == ["hello", "4006381333931"]
    focal = 160 / math.tan(HFOV / 2)
    assert (hello.x, hello.y, hello.width) == pytest.approx((0.5, 0.5, 30 / 320))
    assert hello.located and hello.distance == pytest.approx(0.08 * focal / 30, rel=1e-3)
    assert number.width == pytest.approx(20 * math.sqrt(2) / 320) and number.heading == pytest.approx(
        math.pi / 4, abs=0.01
    )
    assert number.alpha == pytest.approx(math.atan(80 / focal)) and number.beta < 0.0
    assert number.distance == pytest.approx(
        0.08 * focal / 20 / math.cos(number.alpha) / math.cos(number.beta), rel=0.02
    )
    assert eyes.idle()


def test_a_code_of_unknown_size_has_a_direction_only(vision, eyes, clock):
    clock.script = [lambda: eyes.raise_event(CODES, [["hello", corners(160, 120, 30)]])]
    (code,) = succeed(vision, f("readBarcodes", str_param="hello")).objects
    assert (code.located, code.distance) == (False, 0.0)
    assert (code.camera_position.x, code.camera_position.y, code.camera_position.z) == pytest.approx((0.0, 0.0, 1.0))


def movement(eyes, time, *clusters):
    info = [[list(centre), [0.1, -0.1, 0.2, 0.3], share, 0.0, [0, 0], [0, 0, 0]] for centre, share in clusters]
    eyes.memory.data[MOVEMENT_INFO] = [eyes.stamp(time), info, *eyes.poses(), 0]
    eyes.raise_event(MOVED, None)


def test_movement_is_where_it_is_and_how_much_of_it(vision, eyes, clock):
    clock.script = [
        lambda: movement(eyes, 100.1, ((0.3, 0.0), 0.1)),
        lambda: movement(eyes, 100.2, ((0.2, 0.1), [0.01, 0.5]), ((-0.3, 0.0), 0.4)),
    ]
    result = succeed(vision, f("detectMovement", confidence=0.3, sensitivity=0.9))
    assert [(o.kind, o.alpha, o.confidence, o.located) for o in result.objects] == [
        ("movement", 0.2, 0.5, False),
        ("movement", -0.3, 0.4, False),
    ]
    assert eyes.movement.calls == [("setColorSensitivity", 0.9), ("setColorSensitivity", 0.5)]
    assert eyes.idle()


def test_the_camera_goes_back_to_what_it_was(vision, eyes, clock):
    pictures = []
    clock.script = [
        lambda: pictures.append(eyes.marks.camera),
        lambda: eyes.raise_event(MARKS, marks_value(eyes, mark(64), camera="CameraTop")),  # from before
        lambda: eyes.raise_event(MARKS, marks_value(eyes, mark(65), camera="CameraBottom")),
    ]
    (found,) = succeed(vision, f("detectLandmarks", camera="bottom")).objects
    assert (found.camera, found.name) == ("bottom", "65")
    assert found.header.frame_id == "robot1/CameraBottom_optical_frame"
    assert pictures == [1] and eyes.idle()


def test_the_ball_is_seen_through_the_active_camera_of_the_robot(vision, eyes):
    eyes.ball = (0.3, 0.0, -0.1)
    (found,) = succeed(vision, f("detectBall", camera="1")).objects
    assert found.camera == "bottom"
    assert eyes.video.calls == [("setActiveCamera", 1), ("setActiveCamera", 0)]


def test_extractors_of_others_are_left_alone(vision, eyes, clock):
    eyes.marks.subscribers = ["somebody"]
    text = abort(vision, f("detectLandmarks", camera="bottom"))
    assert "somebody" in text and "CameraTop" in text
    vision.active_camera = "bottom"  # no camera is asked for: then theirs will do
    clock.script = [lambda: eyes.raise_event(MARKS, marks_value(eyes, mark(64)))]
    assert succeed(vision, f("detectLandmarks")).memList == ["64"]
    eyes.movement.subscribers = ["somebody"]
    assert "sensitivity 0.5" in abort(vision, f("detectMovement", sensitivity=0.9))
    assert (eyes.marks.subscribers, eyes.movement.subscribers) == (["somebody"], ["somebody"])
    assert eyes.marks.calls == eyes.movement.calls == []


def test_what_a_killed_server_left_is_ended(vision, eyes):
    eyes.faces.subscribers = [f"{vision.subscriber}_face", "NaoVision_elsewhere_face"]
    succeed(vision, f("listFaces"))
    assert eyes.faces.subscribers == ["NaoVision_elsewhere_face"]


@pytest.mark.parametrize(
    ("message", "text"),
    [
        (f("detectBall", camera="left"), "bottom or 1"),
        (f("detectBall", timeout=-1.0), "timeout"),
        (f("detectBall", timeout=math.nan), "timeout"),
        (f("detectBall", confidence=1.5), "confidence"),
        (f("detectBall", count=-1), "count"),
        (f("detectBall", size=-0.03), "size"),
        (f("detectLandmarks", str_param="x"), "number of a landmark"),
        (f("detectLandmarks", str_param="-5"), "number of a landmark"),
        (f("detectMovement", sensitivity=2.0), "sensitivity"),
        (f("learnFace"), "name of a person"),
        (f("learnFace", str_param="a\nb"), "printed"),
        (f("forgetFace", str_param="x" * 101), "100"),
        (f("trackBall", duration=-1.0), "duration"),
        (f("trackFace", speed=1.5), "speed"),
        (f("lookFor", str_param="cat"), "ball, face, landmark, code"),
        (f("lookFor", str_param="ball red"), "no names"),
        (f("lookFor", str_param="landmark red"), "number of a landmark"),
    ],
)
def test_what_cannot_be_is_refused_before_anything_runs(vision, eyes, message, text):
    refused = abort(vision, f("detectBall", timeout=1.0), message)
    assert text in refused and refused.startswith("function 2")
    assert eyes.video.calls == [] and eyes.idle()
