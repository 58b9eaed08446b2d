"""Rules for navigation."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from ..designators.designator import Designator, action
from ..designators.patterns import Mismatch, one_of
from ..designators.rules import Command, command
from ..language.failures import DesignatorError
from .values import a_place, rule_about

NAVIGATION = "navigation"


def _going(desig: Designator, target: Any) -> Iterator[Command]:
    if isinstance(target, Designator):
        for place, frame in target.solutions():
            yield command(NAVIGATION, "walk_to", target=place, frame=frame)
        return
    try:
        place, frame = a_place().take(target)
    except Mismatch:
        allowed = f"{a_place().wanted}, or a designator of a location"
        raise DesignatorError(desig, f"it goes to {target!r}: not {allowed}") from None
    yield command(NAVIGATION, "walk_to", target=place, frame=frame)


rule_about("target", _going, called="going", type=one_of("going", "walking"))
rule_about("goal", _going, action, called="navigation", type="navigation")
rule_about("target", _going, action, called="to walk", name=one_of("to walk", "to go", "walk to", "walkTo"))
