"""Arguments of moves that cannot be, over the network."""

from __future__ import annotations

import math

import pytest


@pytest.fixture
def motion(walker):
    return walker.motion


@pytest.mark.parametrize(
    "method, arguments, message",
    [
        ("moveTo", (math.nan, 0.0, 0.0), "x is nan, allowed is a finite number"),
        ("moveTo", (0.1, 0.0, 0.0, -1.0), "time is -1.0, allowed is 0 or more"),
        ("moveTo", ([],), "controlPoint is .*, allowed is a list of at least one"),
        ("moveTo", ([0.1, 0.0, 0.0],), "controlPoint is .*, allowed is a list of at least one"),
        ("moveTo", ([[0.1, 0.0]],), "controlPoint is .*, allowed is a list of at least one"),
        ("moveTo", (0.1, 0.0, 0.0, [["MaxStepX", 0.2]]), "MaxStepX is 0.2, allowed is 0.001 to 0.08"),
        ("move", (0.1, 0.0, math.nan), "theta is nan, allowed is a finite number"),
        ("move", (1e300, 0.0, 0.0), r"x is 1e\+300, allowed is -1e\+06 to 1e\+06"),
        ("move", (0.1, 0.0, 0.0, [["MaxStpX", 0.04]]), "unknown gait parameter 'MaxStpX': did you mean 'MaxStepX'"),
        ("move", (0.1, 0.0, 0.0, [["MinStepX", -0.02]]), "MinStepX is -0.02, allowed is nothing"),
        ("move", (0.1, 0.0, 0.0, ["MaxStepX", 0.04]), "moveConfig is .*, allowed is pairs"),
        ("moveToward", (1.1, 0.0, 0.0), "x is 1.1.*, allowed is -1 to 1"),
        ("moveToward", (0.0, 0.0, -2.0), "theta is -2.0, allowed is -1 to 1"),
        ("moveToward", (1.0, 0.0, 0.0, [["Frequency", 1.5]]), "Frequency is 1.5, allowed is 0 to 1"),
        ("setWalkTargetVelocity", (1.0, 0.0, 0.0, -0.5), "frequency is -0.5, allowed is 0 to 1"),
        ("setWalkTargetVelocity", (1.0, 0.0, 0.0, 1.0, [["LeftTorsoWx", 1]], []), "parameter of a foot 'LeftTorsoWx'"),
        ("getMoveConfig", ("Mean",), "config is 'Mean', allowed is Default, Min, Max"),
        ("getMoveArmsEnabled", ("Arm",), "unknown arm or group 'Arm': did you mean"),
    ],
)
def test_what_cannot_be_is_refused_and_nothing_moves(walker, motion, method, arguments, message):
    with pytest.raises(RuntimeError, match=f"ALMotion::{method} .*{message}"):
        motion.call(method, *arguments)
    assert motion.moveIsActive() is False
