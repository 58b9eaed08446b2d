"""What a walk needs of the legs: NAOqi begins none on soft ones, and does not say so to who asked for it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from naoqi.limits import ANSWER_LIMIT

from ..base.errors import CannotWalk
from .joint_names import LEGS, MOTION

SOFTEST = 0.6
"""Stiffness of a leg's joint above which NAOqi walks."""


def require_stiff(stiffnesses: Mapping[str, float]) -> None:
    """Check stiffnesses of the legs' joints, 0..1 by name; raises CannotWalk if one is too soft."""
    softest = min(stiffnesses, key=stiffnesses.__getitem__)
    stiffness = stiffnesses[softest]
    if not stiffness > SOFTEST:
        how = f"too soft to walk: {softest} has stiffness {stiffness:.2f}, above {SOFTEST:g} is needed"
        raise CannotWalk("the legs are limp" if stiffness == 0.0 else f"the legs are {how}", "wakeUp first")


def ask_for_stiff_legs(robot: Any) -> None:
    """Ask a robot for the stiffness of its legs. Raises CannotWalk as above; NaoError if it cannot be asked."""
    ask = robot.proxy(MOTION).call_async
    stiffnesses = ask("getStiffnesses", list(LEGS)).result(timeout=ANSWER_LIMIT)
    if min(stiffnesses) > SOFTEST:
        return
    calls = [ask("getBodyNames", leg) for leg in LEGS]
    names = [name for call in calls for name in call.result(timeout=ANSWER_LIMIT)]
    require_stiff(dict(zip(names, stiffnesses)))
