"""What rules for a NAO share: patterns of sides, points and places, and rules about one key."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

from ...base.limits import limit
from ...base.places import ODOM, Place
from ..designators.designator import Designator, action, motion
from ..designators.patterns import Mismatch, Pattern, anything, one_of
from ..designators.rules import rule
from ..language.failures import DesignatorError
from ..language.settings import numbers_of_nao
from ..language.space import Point3, Position

TORSO = "torso"
SIDE = one_of("left", "right")
BOTH = (action, motion)


def rule_about(
    key: str,
    solve: Callable[[Designator, Any], Any],
    kind: str | tuple[str, ...] = BOTH,
    *,
    called: str,
    **patterns: Any,
) -> None:
    """Register a rule by a function of the designator and of the value of one key, whatever that is; see `rule`."""
    rule(kind, called=called, **patterns, **{key: anything()})(lambda desig: solve(desig, desig[key]))


def a_point() -> Pattern:
    """A point: three numbers in m in the torso frame, with a frame behind them, or a `Point3`."""

    def take(value: Any) -> Point3:
        if isinstance(value, Point3):
            return value
        if isinstance(value, Position):
            if value.z is None:
                raise Mismatch
            return Point3(*_finite(value[:3]), value.frame or TORSO)
        if isinstance(value, Mapping) and set(value) <= {"x", "y", "z", "frame"}:
            value = [*(value.get(axis, 0.0) for axis in "xyz"), *([value["frame"]] if "frame" in value else [])]
        if isinstance(value, str) or not isinstance(value, Sequence) or not 3 <= len(value) <= 4:
            raise Mismatch
        return Point3(*_finite(value[:3]), *map(str, value[3:]))

    return Pattern("a point [x, y, z] in m, in the torso frame or with the name of a frame behind it", take)


def a_position() -> Pattern:
    """Two numbers, a point at the height of the eyes (as the head's target in older plans); or a point."""
    point = a_point()

    def take(value: Any) -> Point3:
        if isinstance(value, Position) and value.z is None:
            return Point3(*_finite(value[:2]), numbers_of_nao().eyes, value.frame or TORSO)
        if not isinstance(value, (str, Mapping)) and isinstance(value, Sequence) and len(value) == 2:
            return Point3(*_finite(value), numbers_of_nao().eyes)
        return point.take(value)

    return Pattern(f"two numbers [x, y] in m, at the height of the eyes, or {point.wanted}", take)


def a_place() -> Pattern:
    """A place: x, y in m and a heading in rad in odom, or in a frame that follows; a `Place`, or one with its frame.

    A `Position` or `Point3` is a point: the robot arrives with the heading of its way, which nan stands for.
    """

    def take(value: Any) -> tuple[Place, str]:
        if isinstance(value, Place):
            return value, ODOM
        if isinstance(value, (Position, Point3)):
            return Place(*_finite(value[:2]), math.nan), value.frame or ODOM
        if isinstance(value, tuple) and len(value) == 2 and isinstance(value[0], Place):
            return value[0], str(value[1])
        if isinstance(value, Mapping) and {"x", "y"} <= set(value) <= {"x", "y", "yaw", "frame"}:
            listed = [value["x"], value["y"], value.get("yaw", 0.0)]
            return Place(*_finite(listed)), str(value.get("frame", ODOM))
        if isinstance(value, str) or not isinstance(value, Sequence) or not 2 <= len(value) <= 4:
            raise Mismatch
        *listed, frame = value if isinstance(value[-1], str) else (*value, ODOM)
        if not 2 <= len(listed) <= 3:
            raise Mismatch
        return Place(*_finite([*listed, 0.0][:3])), frame

    return Pattern("a place [x, y, yaw] in m and rad, in odom or with the name of a frame behind it", take)


def _finite(values: Sequence[Any]) -> list[float]:
    """The values as numbers; Mismatch if one is none, or out of the limits of places."""
    try:
        found = [float(value) for value in values]
    except (TypeError, ValueError, OverflowError):
        raise Mismatch from None
    lowest, highest, _ = limit("place")
    if not all(lowest <= value <= highest for value in found):  # also for what is not finite
        raise Mismatch
    return found


def points_of(desig: Designator) -> Iterator[Point3]:
    """Points of designators of things and of locations. Raises DesignatorError if a solution has no position."""
    for solution in desig.solutions():
        position = getattr(solution, "position", None)
        if position is not None:
            yield position
        elif isinstance(solution, tuple) and len(solution) == 2 and isinstance(solution[0], Place):
            yield Point3(solution[0].x, solution[0].y, 0.0, solution[1])
        else:
            raise DesignatorError(desig, f"it stands for {solution!r}, which has no place")
