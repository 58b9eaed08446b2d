"""Footsteps as messages."""

from __future__ import annotations

import math

import pytest

from nao_library_modules.driver.footsteps import read_step, read_steps, step_target
from nao_library_modules.driver.footsteps_walk import Step
from nao_library_modules.errors import BadGoal
from nao_library_modules.places import Place
from nao_library_msgs.msg import StepTarget


@pytest.mark.parametrize("step", [Step("LLeg", Place(0.04, 0.1, 0.2)), Step("RLeg", Place(-0.02, -0.12, -0.1))])
def test_a_step_is_the_same_there_and_back(step):
    assert read_step(step_target(step)) == step


def test_legs_have_the_numbers_of_the_message():
    assert step_target(Step("LLeg", Place(0, 0.1, 0))).leg == StepTarget.left
    assert read_step(StepTarget(leg=StepTarget.right)).leg == "RLeg"


def test_the_first_step_that_will_not_do_is_named():
    good, bad = StepTarget(leg=1), StepTarget(leg=0)
    bad.pose.theta = math.nan
    with pytest.raises(BadGoal, match=r"footsteps\[1\]\.pose\.theta"):
        read_steps([good, bad])
    with pytest.raises(BadGoal, match=r"footsteps\[0\]\.leg: 7 is not allowed: 0 \(right\) or 1 \(left\)"):
        read_steps([StepTarget(leg=7)])
