"""The head behind a ball or a face that the simulated cameras see."""

from __future__ import annotations

import math

import numpy as np
import pytest
from goal_functions import vision as f


def off(things, place, camera="CameraTop"):
    """How far a place is off the axis of a camera, rad."""
    x, y, z = things.in_camera(place, camera)
    return math.atan2(math.hypot(y, z), x)


@pytest.fixture
def head(robot):
    return lambda measured=True: robot.ALMotion.getAngles("Head", measured)


@pytest.fixture
def idle(robot):
    def check():
        return robot.ALRedBallDetection.getSubscribersInfo() == robot.ALFaceDetection.getSubscribersInfo() == []

    return check


def told(goal):
    """What the feedback says that the robot does, without repetitions."""
    words = [feedback.status for feedback in goal.feedback if feedback.status]
    return [word for word, before in zip(words, [""] + words) if word != before]


def test_a_ball_comes_into_the_middle_and_is_followed(robot, vision, things, idle):
    robot.ALMotion.setAngles(["HeadYaw", "HeadPitch"], [0.0, 0.25], 0.5)
    things.place("ball", (1.2, -0.2, 0.03), ball=0.03)
    goal = vision.send(f("trackBall", duration=5.0))
    robot.advance(1.5)
    assert off(things, (1.2, -0.2, 0.03)) < math.radians(2.0)
    things.move("ball", (0.9, 0.6, 0.03), 0.0, 2.5)
    goal.finish()
    assert goal.state == "succeeded" and told(goal) == ["looking", "following"]
    assert off(things, (0.9, 0.6, 0.03)) < math.radians(3.0)
    (ball,) = goal.result.objects
    assert np.linalg.norm(np.array([ball.position.x, ball.position.y]) - things.in_base((0.9, 0.6, 0.03))[:2]) < 0.15
    assert 3.8 < float(goal.result.memList[0]) <= 5.2
    assert goal.result.results[0].elapsed.to_sec() == pytest.approx(5.0, abs=0.5) and idle()


def test_the_head_turns_no_faster_than_asked_for_and_what_is_lost_is_given_up(robot, vision, things, head, idle):
    things.place("ball", things.from_camera(0.8, 0.3), ball=0.03)
    goal = vision.send(f("trackBall", speed=0.05, timeout=1.5))
    yaws = []
    for _ in range(20):
        robot.advance(0.1)
        yaws.append(head()[0])
    speeds = [(b - a) / 0.1 for a, b in zip(yaws, yaws[1:])]
    assert 0.2 < max(speeds) < 0.05 * 8.27 * 1.25 and yaws[-1] > 0.15
    things.remove("ball")
    began = robot.now.time
    goal.finish()
    assert goal.state == "succeeded" and told(goal) == ["looking", "following", "lost"]
    assert robot.now.time - began == pytest.approx(1.5, abs=0.5) and len(goal.result.objects) == 1 and idle()
    assert 1.0 < float(goal.result.memList[0]) < 2.6


def test_what_is_behind_the_shoulder_is_looked_for_and_found(robot, vision, things, head, idle):
    place = things.place("ball", (-0.3, 0.9, 0.03), ball=0.03)
    goal = vision.play(f("lookFor", str_param="ball", count=2))
    (ball,) = goal.result.objects
    assert (ball.looks, goal.result.memList) == (2, ["ball"]) and told(goal)[:2] == ["looking", "searching"]
    seen = np.array([ball.position.x, ball.position.y, ball.position.z])
    assert np.linalg.norm(seen - things.in_base(place)) < 0.15
    assert head()[0] > 1.2 and off(things, place) < math.radians(12.0) and idle()
    robot.ALMotion.setAngles(["HeadYaw", "HeadPitch"], [0.0, 0.0], 0.5)
    robot.advance(1.0)
    assert vision.succeed(f("trackBall", timeout=0.6)).memList == ["0.0"] and abs(head()[0]) < 0.05
    goal = vision.send(f("trackBall", timeout=8.0, search=True))
    robot.advance_until(lambda: head()[0] > 0.5, 4.0, what="it looks for it")
    goal.cancel()


@pytest.mark.parametrize("end", ["preempted", "over"])
def test_the_head_is_given_back(robot, vision, things, head, idle, end):
    """Where it was, and as limp as it was, however the function ends."""
    robot.ALMotion.setAngles(["HeadYaw", "HeadPitch"], [0.2, 0.1], 0.5)
    robot.advance(1.0)
    robot.ALMotion.setStiffnesses("Head", 0.0)
    robot.advance(0.1)
    things.place("ball", things.from_camera(0.8, -0.25), ball=0.03)
    goal = vision.send(f("trackBall", duration=2.0, revert=True))
    robot.advance(1.2)
    assert robot.ALMotion.getStiffnesses("Head") == [1.0, 1.0] and head()[0] < 0.1
    assert (goal.finish() if end == "over" else goal.cancel()).state == {"over": "succeeded"}.get(end, end)
    assert head() == pytest.approx([0.2, 0.1], abs=0.05) and robot.ALMotion.getStiffnesses("Head") == [0.0, 0.0]
    assert [seen.kind for seen in goal.result.objects] == ["ball"] and idle()


def test_only_the_person_that_is_asked_for_is_followed(robot, vision, things, head):
    things.place("anna", things.from_camera(0.9, 0.1), things.facing, face="anna")
    vision.succeed(f("forgetAllFaces"), f("learnFace", str_param="Anna"))
    things.place("ben", things.from_camera(0.9, -0.2), things.facing, face="ben")
    goal = vision.send(f("trackFace", str_param="Anna", duration=2.0))
    end = things.from_camera(0.9, 0.1)
    goal.finish()
    assert goal.state == "succeeded" and [seen.name for seen in goal.result.objects] == ["Anna"]
    assert float(goal.result.memList[0]) > 1.0 and off(things, end) < math.radians(5.0)
