"""What the fields of motion functions may hold by themselves, before anything is asked of the robot."""

from __future__ import annotations

import math
from types import SimpleNamespace

import pytest

from nao_library_modules.core.chain import declared_fields
from nao_library_modules.core.errors import BadGoal
from nao_library_modules.motion.motion_server import NaoMotion
from nao_library_msgs.msg import MotionFunction

NAN, INF = math.nan, math.inf
TABLE = NaoMotion.declared_functions()
NOT_RISING = [[], [0.0], [1.0, 1.0], [2.0, 1.0], [INF], [1.0, NAN], [1.0, 1e6]]
NO_FRACTIONS = [-0.1, 1.1, NAN, 1e-320]


def field(function, name):
    return declared_fields(TABLE[function], MotionFunction.__slots__)[name]


def points(*velocities):
    return SimpleNamespace(points=[SimpleNamespace(velocities=each, accelerations=()) for each in velocities])


FIELDS = [
    ("setAngles", "speed", [0.0, 1.0], NO_FRACTIONS, "1e-05..1, or 0 for 0.3"),
    ("setAngles", "speeds", [[], [0.0, 1.0]], [[1.0, value] for value in NO_FRACTIONS], "1e-05..1, or 0 for 0.3"),
    ("goToPosture", "speed", [0.0, 1.0], NO_FRACTIONS, "1e-05..1, or 0 for 0.6"),
    ("setAngles", "stiffness", [0.0, 1.0], [-0.1, 1.1, NAN], r"0 \(leave as it is\) to 1"),
    ("setAngles", "names", [["Tail"]], [[]], "no joint is named: joints or chains"),
    ("getMass", "names", [[], ["Tail"]], [], ""),
    ("angleInterpolation", "times", [[1.0, 2.0]], NOT_RISING, "s from the start, at least one, .*are for all joints"),
    ("setStiffnesses", "angles", [[0.0, 1.0]], [[0.5, 1.5], [NAN]], r"is no stiffness: stiffnesses from 0 \(limp\)"),
    ("angleInterpolationBezier", "trajectory", [points((1.0,))], [points((1.0,), ())], "field trajectory.points: "),
    ("setPose", "trajectory", [points(), points(())], [points((), ())], "one point; setTrajectory takes more"),
    ("setPose", "trajectory", [points((0.0,))], [points((0.5,))], "setTrajectory moves with them"),
    ("setPose", "duration", [0.0, 1.0], [-1.0, NAN, 1e6], r"0.001\.\.86400 s, or 0"),
    ("setMaxTryNumber", "values", [[1.0], [20.0]], [[], [0.0], [21.0], [1.5], [NAN], [1, 2]], "one whole number"),
    ("lookAt", "values", [[1.0, 0.0, 0.0]], [[1.0, 0.0]], "x, y, z of a point in m"),
    ("lookAt", "values", [[1e4, 0.0, 0.0]], [[1e5, 0.0, 0.0], [NAN] * 3], r"-10000\.\.10000 m"),
    ("lookAt", "frame", [0, 2], [-1, 3], r"0 \(FRAME_TORSO\), 1 \(FRAME_WORLD\), 2 \(FRAME_ROBOT\)"),
    ("lookAt", "str_param", ["", "CameraTop"], ["CameraTo"], "did you mean 'CameraTop'.* or nothing for CameraTop"),
    ("recordMotion", "duration", [1.0], [0.0, NAN, 3601.0], r"0.001\.\.3600 s"),
    ("recordMotion", "rate", [0.0, 25.0], [-1.0, NAN, 101.0], r"0.001\.\.100 Hz, or 0 for 25"),
    ("recordMotion", "str_param", ["Bow 2"], ["", "../wave", ".hidden", "wave\n"], "is no name for a motion"),
    ("renameMotion", "texts", [["Bow 2"]], [[], ["a", "b"]], "the new name, and nothing else"),
    ("renameMotion", "texts", [["Bow 2"]], [["../wave"]], "field texts: .* is no name for a motion"),
    ("playMotion", "speed", [0.0, 2.0], [-1.0, NAN, 1001.0], "or 0 for the speed of the recording"),
    ("killTask", "values", [[0.0], [7.0]], [[], [1, 2]], "the number of one task"),
    ("killTask", "values", [[2**31 - 1]], [[0.5], [-1], [2**31], [NAN]], r"a whole number 0\.\."),
]


@pytest.mark.parametrize(("function", "name", "good", "bad", "text"), FIELDS)
def test_a_field_holds_what_it_can_mean(function, name, good, bad, text):
    for value in good:
        field(function, name).require(name, value)
    for value in bad:
        with pytest.raises(BadGoal, match=text):
            field(function, name).require(name, value)
