"""Objects: what is known of things in the world, and designators of them.

    table = BELIEFS.know("table", type="table", position=Point3(0.95, 0.0, 0.15, "odom"), size=(0.7, 1.1, 0.3))
    the(object_, type="table").reference()              # the KnownObject

A designator of an object is resolved to known objects that match; perception adds to them (see `perception.perceive`).
"""

from __future__ import annotations

import math
import threading
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from ..language.failures import AmbiguousPerception, DesignatorError
from ..language.space import Point3
from .designator import Designator, object_
from .patterns import plain
from .rules import rule

SAME = 0.15
"""m; a thing that is seen this near to where one of its type and name was is that one."""


@dataclass(frozen=True)
class KnownObject:
    """A thing in the world."""

    name: str
    type: str
    position: Point3  # the middle of its box
    size: tuple[float, float, float] = (0.0, 0.0, 0.0)  # (length, width, height) of its box, m; (0, 0, 0) if unknown
    yaw: float = 0.0  # rotation of the box, rad, in the frame of the position
    facts: Mapping[str, Any] = field(default_factory=dict)
    seen: float | None = None  # when it was seen last, s of the observer's clock; None if never

    def distance_to(self, x: float, y: float) -> float:
        """From a point on the floor to the edge of its box, m; 0 inside. In the frame of its position."""
        c, s = math.cos(self.yaw), math.sin(self.yaw)
        dx, dy = x - self.position.x, y - self.position.y
        across, along = abs(c * dx + s * dy) - self.size[0] / 2.0, abs(c * dy - s * dx) - self.size[1] / 2.0
        return math.hypot(max(across, 0.0), max(along, 0.0))

    def value(self, key: str) -> Any:
        """What is known for a key, or None."""
        if key in ("type", "name", "position", "size", "yaw"):
            return getattr(self, key)
        return self.facts.get(key)


class Beliefs:
    """What a robot knows of things; safe to use from any thread."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._objects: dict[str, KnownObject] = {}

    def know(self, name: str, **description: Any) -> KnownObject:
        """Store a thing; one of that name is replaced. The description has fields of `KnownObject`, and facts."""
        own = {key: description.pop(key) for key in ("type", "position", "size", "yaw", "seen") if key in description}
        own.setdefault("type", name)
        if "position" not in own:
            raise DesignatorError(f"object {name}", "its position is not told")
        known = KnownObject(name, facts=description, **own)
        with self._lock:
            self._objects[name] = known
        return known

    def saw(self, type: str, name: str, position: Point3, time: float, **facts: Any) -> KnownObject:  # noqa: A002
        """Take a thing as seen: one that is known already has moved there, else it is a new one.

        Args:
            type: Such as ball.
            name: That it is known by; empty if it has none: the type is made one.
            time: When it was seen, s.
            **facts: What else was seen of it, by key.
        """
        with self._lock:
            known = self._same(type, name, position)
            if known is None:
                known = KnownObject(self._new_name(name or type), type, position)
            known = replace(known, position=position, facts={**known.facts, **facts}, seen=time)
            self._objects[known.name] = known
            return known

    def forget(self, name: str) -> None:
        with self._lock:
            self._objects.pop(name, None)

    def clear(self) -> None:
        with self._lock:
            self._objects.clear()

    def all(self) -> list[KnownObject]:
        """All known things, in the order in which they were added."""
        with self._lock:
            return list(self._objects.values())

    def fitting(self, desig: Designator) -> list[KnownObject]:
        """What matches a description; the last seen come first."""
        wanted = {key: value for key, value in desig.description.items() if key not in ("where", "position", "size")}
        fit = [thing for thing in self.all() if all(_alike(thing.value(key), value) for key, value in wanted.items())]
        return sorted(fit, key=lambda thing: -(thing.seen if thing.seen is not None else -math.inf))

    def _same(self, type: str, name: str, position: Point3) -> KnownObject | None:  # noqa: A002
        of_type = [thing for thing in self._objects.values() if thing.type == type]
        if name:
            return next((thing for thing in of_type if name in (thing.name, thing.facts.get("name"))), None)
        near = [thing for thing in of_type if thing.position.frame == position.frame]
        near = [thing for thing in near if thing.position.distance_to(position) < SAME]
        return min(near, key=lambda thing: thing.position.distance_to(position), default=None)

    def _new_name(self, wanted: str) -> str:
        name, number = wanted, 2
        while name in self._objects:
            name, number = f"{wanted}-{number}", number + 1
        return name


BELIEFS = Beliefs()
"""What the robot of this program knows."""


@rule(object_, called="known object")
def known(desig: Designator) -> Iterator[KnownObject]:
    """Known objects that match. `the` allows only one; `all` gives one list of them.

    Raises DesignatorError: nothing known matches; AmbiguousPerception: several match a description that means one.
    """
    fit = BELIEFS.fitting(desig)
    if not fit:
        there = ", ".join(thing.name for thing in BELIEFS.all()) or "nothing"
        raise DesignatorError(desig, f"nothing is known that fits: known is {there}")
    if desig.quantifier == "the" and len(fit) > 1:
        raise AmbiguousPerception(desig, f"several fit: {', '.join(thing.name for thing in fit)}")
    yield from ([fit] if desig.quantifier == "all" else fit)


def object_pose(desig: Designator) -> Point3:
    """The position of a designator's object."""
    return desig.reference().position


def _alike(have: Any, want: Any) -> bool:
    if isinstance(have, str) and isinstance(want, str):
        return plain(have) == plain(want)
    return bool(have == want)
