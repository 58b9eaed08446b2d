"""What events of the robot's vision say, where things are in space, and how the head follows them."""

from __future__ import annotations

import math

import pytest

from nao_library_modules.motion.motion_plan import JointLimits
from nao_library_modules.vision.detections import (
    BALL,
    CODE,
    FACE,
    MOVEMENT,
    NOTHING,
    Detection,
    Lens,
    LocalizedDetection,
    Region,
    ball_detections,
    code_detections,
    face_detections,
    landmark_detections,
    located,
    merged,
    movement_detections,
)
from nao_library_modules.vision.detectors import WantedDetection, seen_messages
from nao_library_modules.vision.tracking import aim, fraction, off_axis, search_angles, the_one, travel_time

HFOV, VFOV = math.radians(56.3), math.radians(43.7)
LENS = Lens(HFOV, VFOV)
HERE = (0.0,) * 6
HEAD = JointLimits(-2.0857, 2.0857, 8.27), JointLimits(-0.6720, 0.5149, 7.19)


def value(content, camera=0, time=(100, 300000)):
    return [list(time), content, [0.0] * 6, [1.0, 2.0, 3.0, 0.0, 0.0, 0.5], camera]


def face(number, name="", score=0.0, alpha=0.0):
    return [[0, alpha, 0.1, 0.2, 0.25], [number, score, name, [], []]]


def test_what_was_seen_has_its_angles_time_camera_and_poses():
    look = ball_detections(value([0.1, -0.2, 0.03, 0.04], 1))
    assert (look.time, look.camera, look.in_robot) == (100.3, 1, (1.0, 2.0, 3.0, 0.0, 0.0, 0.5))
    (ball,) = look.detections
    assert (ball.kind, ball.alpha, ball.beta, ball.size_x, ball.size_y) == (BALL, 0.1, -0.2, 0.06, 0.08)
    marks = [[[1, 0.1, 0.2, 0.05, 0.09, 0.3], [114]], [[1, 0, 0, 0.1, 0.1], [64.0]]]
    look = landmark_detections(value(marks, "CameraBottom"))
    assert look.camera == 1
    assert [(s.name, s.alpha, s.beta, s.size_x, s.size_y, s.heading) for s in look.detections] == [
        ("114", 0.1, 0.2, 0.05, 0.09, 0.3), ("64", 0.0, 0.0, 0.1, 0.1, 0.0),
    ]  # fmt: skip
    clusters = [[[0.2, 0.1], [0.1, -0.1, 0.2, 0.3], share, 0.0] for share in ([0.01, 0.5], 0.4)]
    assert [(s.kind, s.alpha, s.confidence) for s in movement_detections(value(clusters)).detections] == [
        (MOVEMENT, 0.2, 0.5), (MOVEMENT, 0.2, 0.4),
    ]  # fmt: skip


@pytest.mark.parametrize(
    "content, told",
    [
        ([face(3, "anna", 0.8), face(4), []], [("anna", 0.8), ("", 0.0)]),
        ([face(3), [2, ["anna"]]], [("anna", 0.0)]),
        ([face(3), [3, ["anna", "ben"]]], [("", 0.0)]),
        ([face(3), face(4), [2, ["anna"]]], [("", 0.0), ("", 0.0)]),
        ([face(3), [4]], [("", 0.0)]),
        ([face(3, "anna", 1.5)], [("anna", 1.0)]),
    ],
)
def test_faces_have_the_names_that_are_told_of_them(content, told):
    assert [(detection.name, detection.confidence) for detection in face_detections(value(content)).detections] == told


def corners(x, y, side, turn=0.0):
    c, s = math.cos(turn) * side / 2, math.sin(turn) * side / 2
    return [[x + a * c + b * s, y - a * s + b * c] for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]


def test_codes_say_something_and_are_somewhere():
    codes = [["hello", corners(160, 120, 30)], ["400", corners(80, 60, 20, math.pi / 4)]]
    hello, number = code_detections(codes, 320, 240, LENS)
    focal = 160 / math.tan(HFOV / 2)
    assert (hello.name, hello.region[:3]) == ("hello", pytest.approx((0.5, 0.5, 30 / 320)))
    assert number.region.width == pytest.approx(20 * math.sqrt(2) / 320)
    assert number.heading == pytest.approx(math.pi / 4, abs=0.01)
    assert number.alpha == pytest.approx(math.atan(80 / focal)) and number.beta < 0.0
    seen = located(hello, 0, 1.0, hello.region, LENS, 0.08, HERE, HERE)
    assert seen.distance == pytest.approx(0.08 * focal / 30, rel=1e-3)
    turned = located(number, 0, 1.0, number.region, LENS, 0.08, HERE, HERE)
    straight = 0.08 * focal / 20
    assert turned.distance == pytest.approx(straight / math.cos(number.alpha) / math.cos(number.beta), rel=0.02)
    unknown = located(hello, 0, 1.0, hello.region, LENS, 0.0, HERE, HERE)
    assert (unknown.distance, unknown.in_optical) == (None, pytest.approx((0.0, 0.0, 1.0)))


@pytest.mark.parametrize("read", [ball_detections, landmark_detections, face_detections, movement_detections])
def test_nothing_is_nothing_and_what_cannot_be_is_told(read):
    assert read([]) == NOTHING
    for wrong in ([1, 2], value([0.1, math.nan, 0, 0]), value([math.nan, 0, 0, 0], 7), value(5)):
        with pytest.raises(ValueError, match="detected"):
            read(wrong)
    for wrong in ([["x", [[1, 2]] * 3]], [[5, corners(1, 1, 1)]]):
        with pytest.raises(ValueError, match="no code"):
            code_detections(wrong, 320, 240, LENS)


def test_what_is_wanted():
    anna, ball = Detection(FACE, "anna", "1", 0.5, 0, 0, 1, 1), Detection(BALL, "", BALL, 0.5, 0, 0, 1, 1)
    assert WantedDetection(FACE, confidence=0.4).picks(anna) is anna
    assert WantedDetection(FACE, confidence=0.6).picks(anna).name == "", "with less than asked for it is somebody"
    assert WantedDetection(FACE, "anna", 0.6).picks(anna) is WantedDetection(FACE, "ben").picks(anna) is None
    assert (
        WantedDetection(BALL, confidence=0.6).picks(ball) is None
        and WantedDetection(BALL, confidence=0.5).picks(ball) is ball
    )


@pytest.mark.parametrize("offset", [(1.0, 0.0, 0.0), (0.5, 0.12, -0.1), (2.0, -0.8, 0.6), (0.3, -0.1, 0.05)])
@pytest.mark.parametrize("yaw, down", [(0.0, 0.0), (0.7, 0.3), (-0.4, 0.9)])
def test_a_ball_is_where_it_is_wherever_it_is_in_the_picture(offset, yaw, down):
    ahead, left, up = offset
    pose = (0.06, 0.01, 0.18, 0.0, down, yaw)
    region = Region(0.5 - left / ahead / math.tan(HFOV / 2) / 2, 0.5 - up / ahead / math.tan(VFOV / 2) / 2, 0.1, 0.1)
    size = 2 * math.asin(0.03 / math.hypot(*offset))
    seen = located(Detection(BALL, "", BALL, 1.0, 0, 0, size, size), 1, 9.5, region, LENS, 0.03, HERE, pose)
    flat, height = ahead * math.cos(down) + up * math.sin(down), up * math.cos(down) - ahead * math.sin(down)
    c, s = math.cos(yaw), math.sin(yaw)
    place = (0.06 + flat * c - left * s, 0.01 + flat * s + left * c, 0.18 + height)
    assert seen.distance == pytest.approx(math.hypot(*offset)) and seen.in_robot == pytest.approx(place)
    assert seen.in_optical == pytest.approx((-left, -up, ahead)) and seen.in_torso == pytest.approx(offset)
    (message,) = seen_messages([seen], "robot1/")
    frames = message.header.frame_id, message.base_frame
    assert frames == ("robot1/CameraBottom_optical_frame", "robot1/base_footprint")
    assert (message.kind, message.camera, message.located, message.looks) == ("ball", "bottom", True, 1)
    assert message.header.stamp.to_sec() == 9.5 and (message.x, message.y) == region[:2]
    assert (message.position.x, message.position.y, message.position.z) == pytest.approx(place)
    assert message.camera_position.z == pytest.approx(ahead)


def seen(key, name="", x=1.0, y=0.0, alpha=0.0, size=0.1):
    """A face: its number, what it is called, and where it is, m from the feet."""
    where = (x, y, 1.0)
    detection = Detection(FACE, name, key, 0.9, alpha, 0.0, 0.1, 0.1)
    return LocalizedDetection(
        detection, 0, 1.0, Region(0.5, 0.5, size, size), 1.0, where, where, where, (0.0, 0.0, 0.5)
    )


def told(pictures):
    return [(each.detection.name, each.looks) for each in merged(pictures)]


def test_looks_at_the_same_are_put_together_the_known_first_then_the_most_often_seen():
    anew = [[seen("1")], [seen("1")], [seen("2", "anna", y=0.1)], [seen("2", "anna", y=0.12)]]
    assert told(anew) == [("anna", 4)], "it is counted anew"
    assert told([[seen("1", "anna"), seen("2", "ben", y=0.2)]] * 2) == [("anna", 2), ("ben", 2)]
    for name, y in (("ben", 0.1), ("anna", 1.0)):
        assert len(merged([[seen("1", "anna")], [seen("2", name, y=y)]])) == 2
    order = [[seen("1", x=3.0)], [seen("2", x=2.0)], [seen("2", x=2.0)], [seen("3", "anna")]]
    assert told(order) == [("anna", 1), ("", 2), ("", 1)]
    (one,) = merged([[seen("1", alpha=alpha)] for alpha in (0.1, 0.4, 0.12)])
    assert (one.detection.alpha, one.looks) == (0.12, 3)


def test_the_one_that_is_followed_is_the_largest_first_and_then_the_same():
    left, right = seen("1", y=0.2, size=0.3), seen("2", y=-0.2, size=0.1)
    assert the_one([right, left], None) is left
    nearer = seen("2", y=-0.2, size=0.9)
    assert the_one([nearer, left], left) is left
    renamed = seen("7", y=0.15)
    assert the_one([nearer, renamed], left) is renamed, "the nearest to where it was"


def test_the_less_there_is_to_turn_the_slower_the_head_turns():
    shares = [fraction(angle, HEAD, 0.3) for angle in (2.0, 0.2, 0.1, 0.0)]
    assert shares == [0.3, pytest.approx(0.2 / 0.2 / 7.19), pytest.approx(0.1 / 0.2 / 7.19), 0.01]
    assert off_axis(seen("1")) == pytest.approx(math.atan2(1.0, 1.0))
    yaw, pitch = aim(seen("1", y=1.0))
    assert yaw == pytest.approx(math.pi / 4) and pitch < 0.0
    assert travel_time((0.0, 0.0), (1.0, 0.1), HEAD, 0.5) == pytest.approx(1.0 / (8.27 * 0.5))


@pytest.mark.parametrize("kind, pitches", [(BALL, {0.2, 0.45}), (FACE, {0.0, -0.35, -0.65}), (CODE, {0.0, -0.4, 0.3})])
def test_the_search_goes_all_around_and_begins_anew(kind, pitches):
    angles = search_angles(kind, HEAD)
    count = 7 * len(pitches)
    places = [next(angles) for _ in range(count + 1)]
    assert places[-1] == places[0] and places[0][0] == 0.0 and len(set(places)) == count
    assert {pitch for _, pitch in places} == pitches
    assert (min(yaw for yaw, _ in places), max(yaw for yaw, _ in places)) == (-2.0, 2.0)
    assert all(abs(b[0] - a[0]) <= 0.81 or {a[0], b[0]} & {2.0, -2.0} for a, b in zip(places, places[1:]))
