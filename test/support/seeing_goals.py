"""Chains for the module for vision on stand-ins, and what they came to."""

from __future__ import annotations

from nao_library_actions.msg import NaoVisionGoal
from nao_library_msgs.msg import VisionFunction

BALL, FACES, MARKS = "redBallDetected", "FaceDetected", "LandmarkDetected"
CODES, MOVED, MOVEMENT_INFO = (
    "BarcodeReader/BarcodeDetected",
    "MovementDetection/MovementDetected",
    "MovementDetection/MovementInfo",
)


def f(function, **fields):
    return VisionFunction(function=function, **fields)


def play(vision, *functions):
    return vision.server.play(NaoVisionGoal(list(functions)))


def succeed(vision, *functions):
    server = play(vision, *functions)
    assert server.end == "succeeded", server.text
    return server.result


def abort(vision, *functions):
    server = play(vision, *functions)
    assert server.end == "aborted", server.end
    return server.text


def face(number, name="", score=0.0, alpha=0.0, beta=0.0, width=0.2, height=0.25):
    return [[0, alpha, beta, width, height], [number, score, name, [], [], [], [], [], []]]


def faces_value(eyes, *faces, recognised=(), camera=0, time=100.0):
    return [eyes.stamp(time), [*faces, list(recognised)], *eyes.poses(camera), camera]


def mark(number, alpha=0.0, beta=0.0, width=0.1, height=0.1, heading=0.0):
    return [[1, alpha, beta, width, height, heading], [number]]


def marks_value(eyes, *marks, camera="CameraTop", time=100.0):
    return [eyes.stamp(time), list(marks), *eyes.poses(0 if camera == "CameraTop" else 1), camera]
