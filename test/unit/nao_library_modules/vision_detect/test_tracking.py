"""The head behind a ball or a face, on a robot whose head turns in time."""

from __future__ import annotations

import math

import pytest
from fake_seeing import seen_from
from seeing_goals import FACES, abort, f, face, faces_value, play, succeed

from naoqi.errors import RobotError


def told(vision):
    """What the feedback says that the robot does, without the beginning of functions."""
    return [feedback.status for feedback in vision.server.feedback if feedback.status]


def off(eyes, camera=0):
    x, y, z = seen_from(camera, eyes.head.angles, eyes.ball)
    return math.atan2(math.hypot(y, z), x)


@pytest.mark.parametrize("camera", ["top", "bottom"])
def test_a_ball_comes_into_the_middle(vision, eyes, clock, camera):
    eyes.ball = (0.8, 0.25, -0.2) if camera == "bottom" else (1.2, -0.3, 0.3)
    result = succeed(vision, f("trackBall", camera=camera, duration=3.0))
    assert off(eyes, ("top", "bottom").index(camera)) < math.radians(1.0)
    (ball,) = result.objects
    assert abs(ball.alpha) < math.radians(1.0) and abs(ball.beta) < math.radians(1.0)
    assert float(result.memList[0]) == pytest.approx(2.8, abs=0.11)
    assert clock.time == pytest.approx(103.0)
    assert told(vision)[:2] == ["looking", "following"]
    assert eyes.head.stiffnesses == [1.0, 1.0] and eyes.idle()


def test_the_head_comes_smoothly_and_rests_when_it_is_there(vision, eyes):
    eyes.ball = (1.2, -0.4, 0.2)
    succeed(vision, f("trackBall", duration=3.0, speed=0.15))
    commands = eyes.head.commands[:-1]  # the last one stops it
    shares = [share for _, share in commands]
    assert max(shares) <= 0.15 and shares[-1] < shares[0] / 3.0
    assert len(commands) < 15  # of thirty pictures


def test_a_ball_that_rolls_is_followed(vision, eyes):
    """Half a radian a second, in front of the robot from one side to the other."""
    worst = []

    def roll(time):
        angle = 0.8 * math.sin((time - 100.0) * 0.5 / 0.8)
        return 1.5 * math.cos(angle), 1.5 * math.sin(angle), 0.1

    eyes.move_ball = roll
    vision.tell = lambda status, objects=(): worst.extend(abs(o.alpha) for o in objects)
    result = succeed(vision, f("trackBall", duration=8.0))
    assert max(worst[8:]) < math.radians(9.0)
    assert float(result.memList[0]) > 7.5
    assert abs(eyes.head.angles[0]) > 0.3


def test_who_is_lost_is_told_and_given_up_in_time(vision, eyes, clock):
    eyes.move_ball = lambda time: (1.2, 0.2, 0.1) if time < 102.0 else None
    result = succeed(vision, f("trackBall", timeout=3.0))
    assert told(vision)[-1] == "lost"
    assert clock.time == pytest.approx(104.9, abs=0.11)
    assert float(result.memList[0]) == pytest.approx(1.8, abs=0.11)
    assert len(result.objects) == 1 and eyes.idle()


def test_nothing_to_follow_is_an_answer(vision, eyes, clock):
    result = succeed(vision, f("trackFace", timeout=2.0, duration=30.0))
    assert (result.objects, result.memList, clock.time) == ([], ["0.0"], pytest.approx(102.0))


def test_the_head_looks_for_what_is_out_of_view(vision, eyes, clock):
    eyes.ball = (-0.3, 1.2, -0.25)  # behind the left shoulder, on the floor
    assert succeed(vision, f("trackBall", timeout=5.0)).memList == ["0.0"]
    assert eyes.head.angles == [0.0, 0.0]
    result = succeed(vision, f("trackBall", timeout=15.0, duration=15.0, search=True))
    assert float(result.memList[0]) > 3.0
    assert off(eyes) < math.radians(1.0)
    assert "searching" in told(vision)


def test_what_is_looked_for_is_found_and_looked_at(vision, eyes, clock):
    eyes.ball = (-0.2, -1.0, -0.25)
    result = succeed(vision, f("lookFor", str_param="ball", count=3))
    (ball,) = result.objects
    assert (ball.looks, result.memList) == (3, ["ball"])
    place = (ball.position.x, ball.position.y, ball.position.z - 0.33)
    assert place == pytest.approx(eyes.ball, abs=0.015)
    assert off(eyes) < math.radians(3.5) and clock.time < 115.0
    assert eyes.idle()


def test_what_is_not_there_is_looked_for_all_around(vision, eyes, clock):
    where = []
    clock.every.append(lambda duration, picture: where.append(tuple(eyes.head.angles)))
    result = succeed(vision, f("lookFor", str_param="ball"))
    assert (result.objects, result.memList, clock.time) == ([], [], pytest.approx(120.0))
    yaws = [yaw for yaw, _ in where]
    assert min(yaws) == pytest.approx(-2.0) and max(yaws) == pytest.approx(2.0)
    assert max(pitch for _, pitch in where) == pytest.approx(0.45)


def test_what_the_head_cannot_turn_to_is_found_all_the_same(vision, eyes):
    eyes.ball = (0.22, 0.0, -0.3)  # in front of the feet
    (ball,) = succeed(vision, f("lookFor", str_param="ball", camera="bottom")).objects
    assert (ball.position.x, ball.position.z) == pytest.approx((0.22, 0.03), abs=0.01)
    assert eyes.head.angles[1] == pytest.approx(0.5149 if off(eyes, 1) > 0.05 else eyes.head.angles[1])


@pytest.mark.parametrize("end", ["preempted", "over", "failed"])
def test_the_head_is_given_back(vision, eyes, clock, end):
    """Where it was, and as limp as it was, however the function ends."""

    def broken(camera, info):
        raise RobotError("ALVideoDevice", "getImageInfoFromAngularInfo", "the cameras are off")

    eyes.head.angles = eyes.head.targets = [0.2, 0.1]
    eyes.head.stiffnesses = [0.0, 0.0]
    eyes.ball = (1.0, -0.1, 0.2)
    if end == "preempted":
        clock.script = [lambda: None] * 15 + [vision.server.preempt]
    if end == "failed":
        clock.script = [lambda: None] * 15 + [lambda: setattr(eyes.video, "getImageInfoFromAngularInfo", broken)]
    server = play(vision, f("trackBall", duration=3.0, revert=True))
    assert server.end == {"preempted": "preempted", "over": "succeeded", "failed": "aborted"}[end]
    assert eyes.head.commands[-1] == ("back", [0.2, 0.1])
    assert eyes.head.angles == [0.2, 0.1] and eyes.head.stiffnesses == [0.0, 0.0]
    assert len(server.result.objects) == 1
    assert eyes.idle()


def test_a_preempted_head_stops_where_it_is(vision, eyes, clock):
    eyes.ball = (1.0, 0.35, 0.2)
    clock.script = [lambda: None, lambda: None, vision.server.preempt]
    server = play(vision, f("trackBall", speed=0.05))
    assert server.end == "preempted" and clock.time == pytest.approx(100.3)
    assert eyes.head.targets == eyes.head.angles != [0.0, 0.0]
    assert eyes.idle()


def test_of_two_faces_the_same_one_is_followed(vision, eyes, clock):
    """The larger one at first; then that one, also when the other comes nearer."""

    def picture(size):
        value = faces_value(eyes, face(1, "", 0, 0.2, 0.0, 0.2, 0.25), face(2, "", 0, -0.2, 0.0, size, size))
        return lambda: eyes.raise_event(FACES, value)

    clock.script = [picture(0.1), picture(0.3), picture(0.3)]
    (seen,) = succeed(vision, f("trackFace", duration=0.5)).objects
    assert seen.alpha == 0.2


def test_only_the_person_that_is_asked_for_is_followed(vision, eyes, clock):
    clock.script = [
        lambda: eyes.raise_event(FACES, faces_value(eyes, face(1, "ben", 0.9, 0.2), face(2, "anna", 0.9, -0.2)))
    ]
    (seen,) = succeed(vision, f("trackFace", str_param="anna", duration=0.5)).objects
    assert (seen.name, seen.alpha) == ("anna", -0.2)
    assert eyes.head.targets[0] <= 0.0


def test_a_head_that_does_not_turn_is_an_error_with_its_reason(vision, eyes):

    def held(names, angles, share):
        raise RobotError("ALMotion", "setAngles", "the head is held by someone")

    eyes.head.setAngles = held
    eyes.ball = (1.0, -0.3, 0.2)
    assert "held by someone" in abort(vision, f("trackBall", duration=3.0))
    assert eyes.idle()
