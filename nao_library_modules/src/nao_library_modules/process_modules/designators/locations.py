"""Locations: places that match a description, sampled one by one and validated.

    a(location, near=the(object_, type="table"), distance=0.35)
    a(location, to="see", object=the(object_, type="ball"))
    a(location, to="reach", object=the(object_, type="ball"), side="left")
    a(location, pose=[1.0, 0.5, 1.57], frame="odom")

Generators propose candidates, the highest priority first; a candidate is taken when no validator rejects it. Users add
generators and validators of their own.
"""

from __future__ import annotations

import enum
import math
import threading
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice
from typing import Any, Callable, Iterable

from ...base.places import ODOM, Place, wrapped
from ..language.failures import DesignatorError
from ..language.settings import numbers_of_nao
from ..language.short_text import short_repr
from ..language.space import Point3
from .designator import Designator, location
from .objects import BELIEFS, KnownObject
from .patterns import Mismatch, number
from .rules import rule

MOST_TRIES = 200
"""Candidates that are looked at before a description is given up."""
AROUND = 24
"""Headings that are tried around a thing."""
SIGHT_STEP = 0.02
"""m between two points of a line of sight that are looked at."""
STANDS_ON = 0.06
"""m before its end in which a line of sight is not hidden: things stand on others."""


class Verdict(enum.Enum):
    """A validator's verdict on a candidate."""

    ACCEPT = "accept"
    REJECT = "reject"
    MAYBE_REJECT = "maybe reject"
    UNKNOWN = "unknown"


@dataclass(frozen=True)
class Candidate:
    place: Place
    frame: str


Generator = Callable[[Designator], Iterable[Candidate]]
Validator = Callable[[Designator, Candidate], Verdict]

_lock = threading.Lock()
_generators: list[tuple[int, str, Generator]] = []
_validators: list[tuple[int, str, Validator]] = []


def register_location_generator(priority: int, generator: Generator, name: str = "") -> None:
    """Add a generator; it replaces one of the same name. The highest priority comes first."""
    _register(_generators, priority, name or generator.__name__, generator)


def register_location_validation_function(priority: int, validator: Validator, name: str = "") -> None:
    """Add a validator; it replaces one of the same name. The highest priority is asked first."""
    _register(_validators, priority, name or validator.__name__, validator)


@rule(location, called="location")
def sampled(desig: Designator) -> Iterator[tuple[Place, str]]:
    """Generated places that no validator rejects, with their frames.

    Raises DesignatorError if there is no candidate, or all were rejected: by which validator, and how often.
    """
    rejected: dict[str, int] = {}
    looked = taken = 0
    doubtful = []
    candidates = (each for _, _, generator in tuple(_generators) for each in generator(desig))
    for candidate in islice(candidates, MOST_TRIES):
        looked += 1
        verdict, who = _judge(desig, candidate)
        if verdict is Verdict.REJECT:
            rejected[who] = rejected.get(who, 0) + 1
        elif verdict is Verdict.MAYBE_REJECT:
            doubtful.append(candidate)
        else:
            taken += 1
            yield candidate.place, candidate.frame
    for candidate in doubtful:
        taken += 1
        yield candidate.place, candidate.frame
    if not looked:
        known = ", ".join(name for _, name, _ in _generators)
        raise DesignatorError(desig, f"nobody knows which place is meant (there are generators: {known})")
    if not taken:
        rejections = ", ".join(f"{who} rejected {count}" for who, count in rejected.items())
        raise DesignatorError(desig, f"none of {looked} places will do: {rejections}")


def next_different_location_solution(desig: Designator, distance: float = 0.1, turn: float = 0.3) -> Designator | None:
    """The next solution whose place differs by more than `distance` m or `turn` rad; None if there is none."""
    place, _ = desig.reference()
    following = desig.next_solution()
    while following is not None:
        other, _ = following.reference()
        if place.distance_to(other) > distance or abs(wrapped(place.yaw - other.yaw)) > turn:
            return following
        following = following.next_solution()
    return None


# --- generators -------------------------------------------------------------------------------------------------------


def pose_of_description(desig: Designator) -> Iterator[Candidate]:
    """A place given by pose=[x, y, yaw] and frame."""
    pose = desig.get("pose")
    if pose is None:
        return
    try:
        x, y, yaw = map(float, [*pose, 0.0][:3])
    except (TypeError, ValueError, OverflowError):
        raise DesignatorError(desig, f"its pose is {short_repr(pose)}, not [x, y, yaw] in m and rad") from None
    yield Candidate(Place(x, y, yaw), str(desig.get("frame", ODOM)))


def around_object(desig: Designator) -> Iterator[Candidate]:
    """Places around a thing, facing it: near=..., with distance in m from its edge, or that of the settings."""
    thing = _thing(desig, "near")
    if thing is None:
        return
    distance = desig.get("distance", numbers_of_nao().near_distance)
    try:
        away = number().take(distance)
    except Mismatch:
        raise DesignatorError(desig, f"its distance is {short_repr(distance)}, not a number in m") from None
    yield from _ring(thing, [away + numbers_of_nao().robot_radius])


def to_see(desig: Designator) -> Iterator[Candidate]:
    """Places from which a thing can be seen: to="see", object=..."""
    thing = _thing(desig, "object", "obj", "target")
    if desig.get("to") == "see" and thing is not None:
        yield from _ring(thing, numbers_of_nao().seeing_distances)


def to_reach(desig: Designator) -> Iterator[Candidate]:
    """Places from which a hand gets to a thing: to="reach", object=..., side=..."""
    thing = _thing(desig, "object", "obj", "target")
    if desig.get("to") != "reach" or thing is None:
        return
    sides = [desig["side"]] if "side" in desig else ["left", "right"]
    nao = numbers_of_nao()
    for ahead in nao.reaching_distances:
        for turn in _turns():
            for side in sides:
                aside = nao.shoulder_aside if side == "left" else -nao.shoulder_aside
                # The thing is ahead of the shoulder, seen from a robot with this heading.
                foot = Place(thing.position.x, thing.position.y, turn).then(Place(-ahead, -aside, 0.0))
                yield Candidate(foot, thing.position.frame)


# --- validators -------------------------------------------------------------------------------------------------------


def not_in_collision(desig: Designator, candidate: Candidate) -> Verdict:
    """No known thing stands where the robot would."""
    place, nao = candidate.place, numbers_of_nao()
    for thing in BELIEFS.all():
        if thing.position.frame != candidate.frame or not any(thing.size):
            continue
        low = thing.position.z - thing.size[2] / 2.0
        if low < nao.robot_height and thing.distance_to(place.x, place.y) < nao.robot_radius - 1e-9:
            return Verdict.REJECT
    return Verdict.ACCEPT


def in_view(desig: Designator, candidate: Candidate) -> Verdict:
    """The object is neither hidden nor too steep below the eyes."""
    thing = _thing(desig, "object", "obj", "target")
    if desig.get("to") != "see" or thing is None:
        return Verdict.UNKNOWN
    place, nao = candidate.place, numbers_of_nao()
    away = math.hypot(thing.position.x - place.x, thing.position.y - place.y)
    if math.atan2(nao.eye_height - thing.position.z, away) > nao.steepest_look:
        return Verdict.REJECT
    eye = Point3(place.x, place.y, nao.eye_height, candidate.frame)
    hides = (each for each in BELIEFS.all() if each.name != thing.name and each.position.frame == candidate.frame)
    return Verdict.REJECT if any(_between(each, eye, thing.position) for each in hides) else Verdict.ACCEPT


def in_reach(desig: Designator, candidate: Candidate) -> Verdict:
    """The hand reaches the object."""
    thing = _thing(desig, "object", "obj", "target")
    if desig.get("to") != "reach" or thing is None:
        return Verdict.UNKNOWN
    nao = numbers_of_nao()
    x, y, _ = Place(thing.position.x, thing.position.y, 0.0).seen_from(candidate.place)
    up = thing.position.z - nao.shoulder_height
    reach = min(math.hypot(x, y - aside, up) for aside in (nao.shoulder_aside, -nao.shoulder_aside))
    return Verdict.ACCEPT if reach <= nao.longest_reach else Verdict.REJECT


# --- inside -----------------------------------------------------------------------------------------------------------


def _thing(desig: Designator, *keys: str) -> KnownObject | None:
    for key in keys:
        value = desig.get(key)
        if isinstance(value, KnownObject):
            return value
        if isinstance(value, Designator):
            found = value.reference()
            if not isinstance(found, KnownObject):
                raise DesignatorError(desig, f"its {key} stands for {found!r}, which is no known object")
            return found
    return None


def _ring(thing: KnownObject, distances: Iterable[float]) -> Iterator[Candidate]:
    """Places at distances from the edge of a thing, all around, facing it."""
    for distance in distances:
        for turn in _turns():
            # From the middle outwards until the edge is so far away.
            c, s = math.cos(turn), math.sin(turn)
            away = distance
            for _ in range(8):
                away += distance - thing.distance_to(thing.position.x - away * c, thing.position.y - away * s)
            place = Place(thing.position.x - away * c, thing.position.y - away * s, turn)
            yield Candidate(place, thing.position.frame)


def _turns() -> Iterator[float]:
    """Headings: ahead first, then alternating to both sides."""
    for step in range(AROUND):
        yield wrapped(2.0 * math.pi / AROUND * ((step + 1) // 2) * (-1 if step % 2 else 1))


def _between(thing: KnownObject, eye: Point3, target: Point3) -> bool:
    """Whether the box of a thing hides the target from the eye."""
    if not any(thing.size):
        return False
    steps = max(2, int(eye.distance_to(target) / SIGHT_STEP))
    for step in range(1, steps):
        share = step / steps
        x, y, z = (a + share * (b - a) for a, b in zip(eye[:3], target[:3]))
        half = thing.size[2] / 2.0
        in_height = abs(z - thing.position.z) < half
        if in_height and not thing.distance_to(x, y) and math.dist((x, y, z), target[:3]) > STANDS_ON:
            return True
    return False


def _judge(desig: Designator, candidate: Candidate) -> tuple[Verdict, str]:
    """The verdict on a candidate, and the name of the deciding validator: the first that rejects."""
    doubt = ""
    for _, name, validator in tuple(_validators):
        verdict = validator(desig, candidate)
        if verdict is Verdict.REJECT:
            return verdict, name
        if verdict is Verdict.MAYBE_REJECT:
            doubt = doubt or name
    return (Verdict.MAYBE_REJECT, doubt) if doubt else (Verdict.ACCEPT, "")


def _register(there: list, priority: int, name: str, function: Any) -> None:
    with _lock:
        there[:] = [entry for entry in there if entry[1] != name]
        there.append((priority, name, function))
        there.sort(key=lambda entry: -entry[0])


for _priority, _generator in ((30, pose_of_description), (20, to_reach), (20, to_see), (10, around_object)):
    register_location_generator(_priority, _generator)
for _priority, _validator in ((20, not_in_collision), (10, in_reach), (10, in_view)):
    register_location_validation_function(_priority, _validator)
