"""Rules about the head: looking somewhere."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from ..designators.designator import Designator, action
from ..designators.patterns import Mismatch, anything, one_of, text
from ..designators.rules import Command, command, rule
from ..language.failures import DesignatorError
from ..language.settings import numbers_of_nao
from ..language.space import Point3
from .values import BOTH, a_position, points_of

MANIPULATION = "manipulation"


def _looking(desig: Designator, at: Any) -> Iterator[Command]:
    """Where to look: a word, a point, or a thing that has a place."""
    words = numbers_of_nao().head
    if isinstance(at, str) and at in words:
        yaw, pitch = words[at]
        yield command(MANIPULATION, "turn_head", yaw=yaw, pitch=pitch)
        return
    if isinstance(at, Designator):
        yield from (command(MANIPULATION, "move_head", target=point) for point in points_of(at))
        return
    try:
        yield command(MANIPULATION, "move_head", target=a_position().take(at))
    except Mismatch:
        told = f"one of {', '.join(words)}, {a_position().wanted}, or a designator"
        raise DesignatorError(desig, f"it looks at {at!r}: not {told}") from None


@rule(BOTH, type="looking", target=anything())
def looking_at_target(target: Any, desig: Designator) -> Iterator[Command]:
    """Resolve {type: looking, target: ...}."""
    return _looking(desig, target)


@rule(BOTH, type="looking", direction=anything())
def looking_in_direction(direction: Any, desig: Designator) -> Iterator[Command]:
    """Resolve {type: looking, direction: left}."""
    return _looking(desig, direction)


@rule(BOTH, type="looking", frame=text())
def looking_at_frame(frame: str) -> Command:
    """Resolve {type: looking, frame: l_gripper}."""
    return command(MANIPULATION, "move_head", target=Point3(0.0, 0.0, 0.0, frame))


@rule(action, type="trajectory", to=one_of("see", "look"), at=anything())
def trajectory_to_see(at: Any, desig: Designator) -> Iterator[Command]:
    """Resolve {type: trajectory, to: see, at: ...}."""
    return _looking(desig, at)


@rule(action, name=one_of("to look", "to move head", "move head", "to turn head", "turn head"), position=anything())
def to_look(position: Any, desig: Designator) -> Iterator[Command]:
    """Resolve {name: to look, position: [2, 3]}."""
    return _looking(desig, position)
