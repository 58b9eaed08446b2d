"""Objects and locations: what is known of things, and places that match a description; points in space.

    table = BELIEFS.know("table", type="table", position=Point3(0.95, 0.0, 0.15, "odom"), size=(0.7, 1.1, 0.3))
    the(object_, type="table").reference()              # the KnownObject

A designator of an object is resolved to known objects that match; perception adds to them (see `perception.perceive`).

    a(location, near=the(object_, type="table"), distance=0.35)
    a(location, to="see", object=the(object_, type="ball"))
    a(location, to="reach", object=the(object_, type="ball"), side="left")
    a(location, pose=[1.0, 0.5, 1.57], frame="odom")

Generators propose candidates, the highest priority first; a candidate is taken when no validator rejects it. Users add
generators and validators of their own. Lengths in m, angles in rad.
"""

from __future__ import annotations

import enum
import math
import threading
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import islice
from typing import Any, Callable, Iterable, NamedTuple

from ...core.geometry import ODOM, Place, wrapped
from ..failures import AmbiguousPerception, DesignatorError, short_repr
from .designator import Designator, location, object_
from .rules import Mismatch, number, numbers_of_nao, plain, rule

# --- points -----------------------------------------------------------------------------------------------------------


TORSO = "torso"
"""Frame of /tf on the torso."""


class Point3(NamedTuple):
    """A point in a frame of /tf."""

    x: float
    y: float
    z: float
    frame: str = TORSO

    def distance_to(self, other: Sequence[float]) -> float:
        """To a point of the same frame."""
        return math.dist(self[:3], other[:3])

    def __str__(self) -> str:
        return f"({self.x:.3f}, {self.y:.3f}, {self.z:.3f}) m in {self.frame}"


class Position(NamedTuple):
    """Where something is meant to be, as plans write it: `Position(2, 3)`. A point without a heading."""

    x: float
    y: float
    z: float | None = None  # None for the default height: the eyes for the head, the floor for walking
    frame: str = ""  # of /tf; empty for the default: torso for arms and head, odom for walking


def head_angles(x: float, y: float, z: float, camera: Sequence[float]) -> tuple[float, float]:
    """HeadYaw and HeadPitch, positive to the left and down, of a head that looks at a point of the torso frame.

    `camera`: (forward, up) of the camera from the neck joint, which yaw and pitch turn about; the height of that joint
    in the torso frame; the angle by which the camera looks down.
    """
    forward, up, neck, tilt = camera
    yaw = math.atan2(y, x)
    far, high = math.hypot(x, y), z - neck
    # The camera's ray goes past the neck at a distance that does not depend on the pitch.
    past = up * math.cos(tilt) + forward * math.sin(tilt)
    away = math.hypot(far, high)
    down = math.atan2(-high, far)
    lift = math.asin(max(-1.0, min(1.0, past / away))) if away > 0.0 else 0.0
    return yaw, down + lift - tilt


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
