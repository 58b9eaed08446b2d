"""Part of ALMotion: steps that somebody else has planned, and those that the robot has."""

from __future__ import annotations

from typing import Any, Iterable

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.sizes import require_few
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.naoqi.binding.arguments import numbers
from nao_sim_bridge.naoqi.motion.arguments import require_rising
from nao_sim_bridge.naoqi.motion.walking import WalkPart
from nao_sim_bridge.walk.footstep_plan import SIDES, FootstepPlan, PlannedStep
from nao_sim_bridge.walk.footsteps import FootPose
from nao_sim_bridge.walk.gait import FeetGait
from nao_sim_bridge.walk.locomotion import Locomotion
from nao_sim_bridge.walk.steps_course import Placement


class Footsteps(WalkPart):
    """Steps of one foot after the other, each placed beside the other foot; what legs cannot do is clipped."""

    def setFootSteps(self, legs: list[str], steps: Any, times: list[float], clear: bool) -> Task:
        """Each time, s from the first step's begin, is that of a landing."""
        placed = _placed(legs, steps)
        # A foot that steps twice in a row needs a step of the other one in between, and no time is given for that.
        if any(one == next_ for (one, _), (next_, _) in zip(placed, placed[1:])):
            raise BadValue("legName", legs, "LLeg and RLeg in turns")
        landings = _one_each(times, len(placed), "timeList")
        require_rising(landings, "timeList", times)
        periods = [b - a for a, b in zip([0.0, *landings], landings)]

        def start(locomotion: Locomotion) -> None:
            locomotion.set_steps(_placements(placed, periods), FeetGait(), bool(clear))

        return self._walk("setFootSteps", start)

    def setFootStepsWithSpeed(self, legs: list[str], steps: Any, fractions: list[float], clear: bool) -> Task:
        """One fraction of the top frequency for all steps, or one for each."""
        placed = _placed(legs, steps)
        gait = FeetGait()
        shares = _one_each(fractions, len(placed), "fractionMaxSpeed", (0.0, 1.0), one_for_all=True)
        periods = [gait.of(side).period(share) for (side, _), share in zip(placed, shares)]

        def start(locomotion: Locomotion) -> Task:
            made = locomotion.set_steps(_placements(placed, periods), gait, bool(clear))
            return made.then(lambda _: None)

        return self._walk("setFootStepsWithSpeed", start)

    def getFootSteps(self) -> Task:
        return self._walk("getFootSteps", lambda locomotion: _as_list(locomotion.steps()))


def _placed(legs: Any, steps: Any) -> list[tuple[int, FootPose]]:
    """Side and place of each step.

    Raises:
        BadValue: A leg has another name, a step other numbers, there is not one step for each leg, or too many are.
    """
    if isinstance(steps, (list, tuple)):
        require_few("footSteps", len(steps), "steps")
    if not isinstance(legs, (list, tuple)) or not legs or any(leg not in SIDES for leg in legs):
        raise BadValue("legName", legs, f"a list of {' and '.join(SIDES)}, at least one")
    if not isinstance(steps, (list, tuple)) or len(steps) != len(legs):
        raise BadValue("footSteps", steps, f"as many steps [x, y, theta] as legs: {len(legs)} here")
    placed = []
    for position, (leg, step) in enumerate(zip(legs, steps)):
        three = numbers(step, f"footSteps[{position}]")
        if len(three) != 3:
            raise BadValue(f"footSteps[{position}]", step, "x, y in m, theta in rad, from the other foot")
        placed.append((SIDES[leg], FootPose(*three)))
    return placed


def _one_each(
    values: Any, count: int, field: str, limits: tuple[float, ...] = (), one_for_all: bool = False
) -> list[float]:
    listed = numbers(values, field, *limits)
    if one_for_all and len(listed) == 1:
        return listed * count
    if len(listed) != count:
        raise BadValue(field, values, f"as many as steps: {count} here")
    return listed


def _placements(placed: Iterable[tuple[int, FootPose]], periods: Iterable[float]) -> list[Placement]:
    return [Placement(side, beside, period) for (side, beside), period in zip(placed, periods)]


def _as_list(plan: FootstepPlan) -> list:
    """Poses of the feet in FRAME_WORLD, steps that nothing can change any more, steps after them."""
    return [[list(plan.left), list(plan.right)], *([_step(s) for s in part] for part in (plan.fixed, plan.clearable))]


def _step(step: PlannedStep) -> list:
    return [step.leg, step.time, list(step.placement)]
