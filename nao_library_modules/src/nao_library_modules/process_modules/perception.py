"""Perceiving: what plans know of things is brought up to date by looking; and places that a plan has to be at.

Two examples:

    ball = perceive(a(object_, type="ball"))               # an equated designator; its reference is where it is now
    at_location(a(location, to="see", object=ball), do(look, ball), robot_position)
"""

from __future__ import annotations

from typing import Any

from ..core.geometry import Place, wrapped
from .control import Branch, Step, do, do_retry, pursue, subtask, with_failure_handling, with_retry_counters
from .designators.designator import Designator, action, an, current_desig, equate, location, object_
from .designators.objects_and_locations import BELIEFS, next_different_location_solution
from .failures import (
    AmbiguousPerception,
    NavigationHighLevelFailure,
    NavigationLowLevelFailure,
    PerceptionObjectNotFound,
    PlanError,
)
from .fluents import AnyFluent, wait_until
from .process_module import perform

QUANTIFIERS = ("a", "all", "the", "currently-visible")
TRIES = 10
"""How often `at_location` goes back to where it has to be."""


def perceive(
    desig: Designator, quantifier: str = "", *, timeout: float = 2.0, search: bool = False, camera: str = ""
) -> Designator | list[Designator]:
    """Look for the object that a designator describes, in a plan. Its type: ball, face, person, landmark or code.

    Returns a designator equated to the given one, which stands for what was seen; with "all" a list of designators.
    Raises PerceptionObjectNotFound: it was not seen; AmbiguousPerception: several were seen that a description fits
    which means one; PlanError: it is no object, or has no type.

    Args:
        quantifier: "a" for the one seen best, "the" for the only one, "all" and "currently-visible" for all.
        timeout: s to look.
        search: Whether the head turns to find it.
    """
    wanted = quantifier or desig.quantifier
    if wanted not in QUANTIFIERS:
        raise PlanError(f"perceive {wanted!r}: {', '.join(QUANTIFIERS)}")
    if desig.kind != object_ or "type" not in desig:
        raise PlanError(f"perceive: {desig} is no object with a type")

    def body() -> Designator | list[Designator]:
        looking = an(
            action, type="detecting", object=current_desig(desig), timeout=timeout, search=search, camera=camera
        )
        seen = [each for each in perform(looking) if each.position is not None]
        if not seen:
            raise PerceptionObjectNotFound(f"{desig} was seen, but not where it is", designator=desig)
        if wanted == "the" and len(seen) > 1:
            raise AmbiguousPerception(desig, f"{len(seen)} were seen that fit")
        if wanted in ("all", "currently-visible"):
            return [_remember(each, desig) for each in seen]
        return equate(desig, _remember(max(seen, key=lambda each: each.confidence), desig))

    return subtask(Step(f"perceive {desig}", body))


def examine(desig: Designator, *keys: str) -> dict[str, Any]:
    """Look at an object, in a plan, and return what is known of some keys then."""
    found = perceive(desig, "a")
    assert isinstance(found, Designator)
    thing = found.reference()
    return {key: thing.value(key) for key in keys}


def go_to(desig: Designator) -> Place:
    """Walk to a location, in a plan: to the first of its places that can be reached. Returns where the robot is then.

    Raises NavigationHighLevelFailure if none of them can be reached.
    """
    place = [current_desig(desig)]

    def next_place(failure: NavigationLowLevelFailure) -> None:
        following = next_different_location_solution(place[0])
        if following is not None:
            place[0] = following
            do_retry("place")
        raise NavigationHighLevelFailure(f"no way to {desig}: {failure}", designator=desig) from failure

    def body() -> Place:
        with with_retry_counters(place=TRIES):
            walk = lambda: perform(an(action, type="going", target=place[0].reference()))  # noqa: E731
            return with_failure_handling(walk, {NavigationLowLevelFailure: next_place})

    return subtask(Step(f"go to {desig}", body))


def at_location(desig: Designator, body: Branch, position: AnyFluent, distance: float = 0.2, turn: float = 0.6) -> Any:
    """Do something at a location, in a plan: a robot that leaves it goes back and begins again.

    `position`: a fluent with the `Place` of the robot, in the frame of the location. Raises NavigationHighLevelFailure
    if the location was lost too often, or cannot be reached.
    """
    if desig.kind != location:
        raise PlanError(f"at_location: {desig} is no location")
    lost = object()

    def away() -> bool:
        goal, _ = current_desig(desig).reference()
        here = position.value
        return goal.distance_to(here) > distance or abs(wrapped(goal.yaw - here.yaw)) > turn

    def watch() -> object:
        wait_until(away, [position])
        return lost

    def run() -> Any:
        for _ in range(TRIES):
            if away():
                go_to(desig)
            answer = pursue(body, do(watch, name="still there"))
            if answer is not lost:
                return answer
        raise NavigationHighLevelFailure(f"{desig} was lost {TRIES} times", designator=desig)

    return subtask(Step(f"at {desig}", run))


def _remember(seen: Any, desig: Designator) -> Designator:
    """Note what was seen; a designator of it.

    It describes what the requested one describes, and the name that was seen: not the name in the beliefs.
    """
    facts = {key: value for key, value in desig.description.items() if key not in ("type", "name", "position", "size")}
    thing = BELIEFS.saw(desig["type"], seen.name, seen.position, seen.time, **facts)
    description = {**desig.description, **({"name": seen.name} if seen.name else {})}
    return Designator(object_, description, resolve=lambda _: [thing])
