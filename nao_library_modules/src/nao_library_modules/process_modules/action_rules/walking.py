"""Rules for navigation."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from ..designators.designator import Designator, action
from ..designators.patterns import Mismatch, anything, one_of
from ..designators.rules import Command, command, rule
from ..language.failures import DesignatorError
from .values import BOTH, a_place

NAVIGATION = "navigation"


def _going(desig: Designator, target: Any) -> Iterator[Command]:
    if isinstance(target, Designator):
        for solution in target.solutions():
            place, frame = solution
            yield command(NAVIGATION, "walk_to", target=place, frame=frame)
        return
    try:
        place, frame = a_place().take(target)
    except Mismatch:
        allowed = f"{a_place().wanted}, or a designator of a location"
        raise DesignatorError(desig, f"it goes to {target!r}: not {allowed}") from None
    yield command(NAVIGATION, "walk_to", target=place, frame=frame)


@rule(BOTH, type=one_of("going", "walking"), target=anything())
def going(target: Any, desig: Designator) -> Iterator[Command]:
    """Resolve {type: going, target: ...}."""
    return _going(desig, target)


@rule(action, type="navigation", goal=anything())
def navigation(goal: Any, desig: Designator) -> Iterator[Command]:
    """Resolve {type: navigation, goal: ...}."""
    return _going(desig, goal)


@rule(action, name=one_of("to walk", "to go", "walk to", "walkTo"), target=anything())
def to_walk(target: Any, desig: Designator) -> Iterator[Command]:
    """Resolve {name: to walk, target: [1, 0, 0]}."""
    return _going(desig, target)
