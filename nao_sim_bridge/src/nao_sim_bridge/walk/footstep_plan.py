"""The steps that a walk is about to make, as they are told to who asks."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Tuple

from nao_sim_bridge.walk.courses import Course
from nao_sim_bridge.walk.footsteps import FootPose
from nao_sim_bridge.walk.legs import LEFT, RIGHT
from nao_sim_bridge.walk.plan import WalkPlan
from nao_sim_bridge.walk.settings import WalkSettings
from nao_sim_bridge.walk.steps_course import StepsCourse

SIDES = {"LLeg": LEFT, "RLeg": RIGHT}
LEGS = {side: leg for leg, side in SIDES.items()}
# Steps that are told of a walk that has no end.
SHOWN_STEPS = 4


@dataclass(frozen=True)
class PlannedStep:
    """A step to come of "LLeg" or "RLeg": `time` s from now it lands, `placement` is in the frame of the other foot."""

    leg: str
    time: float
    placement: FootPose


@dataclass(frozen=True)
class FootstepPlan:
    """Feet in the world, the steps that nothing can change any more, and those after them."""

    left: FootPose
    right: FootPose
    fixed: Tuple[PlannedStep, ...] = ()
    clearable: Tuple[PlannedStep, ...] = ()


def steps_to_come(
    plan: WalkPlan | None, course: Course | None, settings: WalkSettings
) -> tuple[list[PlannedStep], list[PlannedStep]]:
    """The step that is made, and those after it; before the first one, those that were asked for."""
    made, time = (None, settings.lead) if plan is None else (plan.step, plan.lead)
    if plan is None or made is None:
        further = []
        for step in course.left if isinstance(course, StepsCourse) else ():
            time += step.period
            further.append(PlannedStep(LEGS[step.side], time, step.beside))
        return [], further
    time += made.period
    fixed = PlannedStep(LEGS[made.side], time, made.landing.seen_from(plan.feet[plan.support]))
    further, support = [], made.landing
    for step in plan.further(len(course.left) if isinstance(course, StepsCourse) else SHOWN_STEPS):
        time += step.period
        further.append(PlannedStep(LEGS[step.side], time, step.landing.seen_from(support)))
        support = step.landing
    return [fixed], further
