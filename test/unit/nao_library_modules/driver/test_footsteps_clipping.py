"""Steps that the robot can make."""

from __future__ import annotations

import math

import pytest

from almath import Pose2D, areTwoBoxesInCollision, computeBox
from nao_library_modules.driver.footsteps_clipping import LEFT_BOX, RIGHT_BOX, check_legs, clip
from nao_library_modules.places import Place
from naoqi.errors import NaoError


@pytest.mark.parametrize("leg, side", [("LLeg", 1.0), ("RLeg", -1.0)])
def test_steps_that_can_be_made_stay_as_they_are(leg, side):
    for step in (Place(0.04, side * 0.1, side * 0.1), Place(-0.03, side * 0.1, 0.0), Place(0.0, side * 0.16, 0.0)):
        assert clip(step, leg) == pytest.approx(step)


@pytest.mark.parametrize("leg, side", [("LLeg", 1.0), ("RLeg", -1.0)])
@pytest.mark.parametrize(
    "step, clipped",
    [
        ((0.3, 0.088, 0.0), (0.08, 0.088, 0.0)),
        ((-0.3, 0.088, 0.0), (-0.04, 0.088, 0.0)),
        ((0.0, 0.5, 0.0), (0.0, 0.16, 0.0)),
        ((0.0, 0.01, 0.0), (0.0, 0.088, 0.0)),
        ((0.0, -0.1, 0.0), (0.0, 0.088, 0.0)),  # on the wrong side
        ((0.0, 0.15, 2.0), (0.0, 0.15, 0.5)),
    ],
)
def test_each_direction_has_its_limit(leg, side, step, clipped):
    x, y, theta = step
    expected = Place(clipped[0], side * clipped[1], side * clipped[2])
    assert clip(Place(x, side * y, side * theta), leg) == pytest.approx(expected)


def test_far_ahead_and_far_aside_at_once_is_too_far():
    step = clip(Place(0.08, 0.16, 0.0), "LLeg")
    assert (step.x / 0.08) ** 2 + ((step.y - 0.088) / 0.072) ** 2 == pytest.approx(1.0)
    assert step.x / 0.08 == pytest.approx((step.y - 0.088) / 0.072)


def test_a_turn_that_treads_on_the_other_foot_is_taken_back():
    step = clip(Place(0.0, 0.09, -0.5), "LLeg")
    assert -0.5 < step.yaw <= 0.0
    moved: list = []
    computeBox(LEFT_BOX, Pose2D(*step), moved)
    assert not areTwoBoxesInCollision(RIGHT_BOX, moved)
    assert clip(Place(0.0, 0.09, 0.3), "LLeg").yaw > step.yaw + 0.2  # outwards there is room


def test_what_is_clipped_is_not_clipped_again():
    for x, y, theta in ((1.0, 1.0, 1.0), (-1.0, 0.1, -1.0), (0.05, 0.15, -0.4)):
        once = clip(Place(x, y, theta), "LLeg")
        assert clip(once, "LLeg") == pytest.approx(once, abs=1e-4)


def test_what_is_no_step_is_told():
    with pytest.raises(NaoError, match="no leg 'Left'"):
        clip(Place(0.0, 0.1, 0.0), "Left")
    with pytest.raises(NaoError, match=r"pose\.y.*finite"):
        clip(Place(0.0, math.nan, 0.0), "LLeg")
    with pytest.raises(NaoError, match=r"footsteps\[2\]\.leg.*RLeg made the step before"):
        check_legs(["LLeg", "RLeg", "RLeg"])
