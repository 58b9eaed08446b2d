"""Rules about arms and the whole body: reaching, moving joints, standing."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from ..designators.designator import Designator, action
from ..designators.patterns import Mismatch, anything, one_of
from ..designators.rules import Command, command, rule
from ..language.failures import DesignatorError
from ..language.settings import numbers_of_nao
from ..language.space import Point3
from .values import BOTH, SIDE, a_point, points_of

MANIPULATION = "manipulation"


def _arm_target(desig: Designator, side: str, target: Any) -> Point3:
    words = numbers_of_nao().arm_targets
    if isinstance(target, str) and target in words:
        x, y, z = words[target]
        return Point3(x, y if side == "left" else -y, z)
    if isinstance(target, Designator):
        return next(points_of(target))
    try:
        return a_point().take(target)
    except Mismatch:
        told = f"one of {', '.join(words)}, {a_point().wanted}, or a designator"
        raise DesignatorError(desig, f"the {side} hand is to get to {target!r}: not {told}") from None


@rule(BOTH, type=one_of("moving tcp"), left_target=anything())
def moving_left_tcp(left_target: Any, desig: Designator) -> Command:
    """Resolve {type: moving-tcp, left-target: ...}."""
    return command(MANIPULATION, "move_arm", side="left", target=_arm_target(desig, "left", left_target))


@rule(BOTH, type=one_of("moving tcp"), right_target=anything())
def moving_right_tcp(right_target: Any, desig: Designator) -> Command:
    """Resolve {type: moving-tcp, right-target: ...}."""
    return command(MANIPULATION, "move_arm", side="right", target=_arm_target(desig, "right", right_target))


@rule(BOTH, type=one_of("moving arm", "reaching"), side=SIDE, target=anything())
def moving_arm(side: str, target: Any, desig: Designator) -> Command:
    """Resolve {type: reaching, side: left, target: ...}."""
    return command(MANIPULATION, "move_arm", side=side, target=_arm_target(desig, side, target))


@rule(BOTH, type=one_of("moving joints", "moving arm joints"), angles=anything())
def moving_joints(angles: Any, desig: Designator) -> Command:
    """Resolve {type: moving-joints, angles: {HeadYaw: 0.5}}."""
    if not isinstance(angles, Mapping) or not angles:
        raise DesignatorError(desig, f"its angles are {angles!r}, not angles in rad by the names of joints")
    return command(MANIPULATION, "move_joints", angles=dict(angles))


@rule(BOTH, type=one_of("parking arms", "going stable", "standing"))
def going_stable() -> Command:
    """Resolve {type: standing}."""
    return command(MANIPULATION, "go_stable")


@rule(action, name=one_of("to move arm", "to reach", "move arm"), side=SIDE, target=anything())
def to_reach(side: str, target: Any, desig: Designator) -> Command:
    """Resolve {name: to reach, side: left, target: [0.2, 0.1, 0.1]}."""
    return command(MANIPULATION, "move_arm", side=side, target=_arm_target(desig, side, target))


@rule(action, name=one_of("to stand", "go stable", "to go stable"))
def to_stand() -> Command:
    """Resolve {name: go stable}."""
    return command(MANIPULATION, "go_stable")


@rule(BOTH, type=one_of("pointing"), at=anything(), side=one_of("left", "right", "").or_else(""))
def pointing(at: Any, side: str, desig: Designator) -> Iterator[Command]:
    """Resolve {type: pointing, at: ...}: with the nearer arm, or that of a side."""
    targets = points_of(at) if isinstance(at, Designator) else [_arm_target(desig, side or "left", at)]
    for target in targets:
        yield command(MANIPULATION, "point_at", target=target, side=side)
