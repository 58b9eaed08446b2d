"""What `NaoSim.place` is asked for: a new thing, or another place for one that is there."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Collection, Mapping, Sequence

from nao_sim_bridge.base.config import check_keys
from nao_sim_bridge.base.errors import BadValue, NotAllowed, UnknownName
from nao_sim_bridge.library.nao import finite_numbers
from nao_sim_bridge.world.objects import NUMBERS, POSE, THINGS, orientation_of, read_object
from nao_sim_bridge.world.world import WorldError, WorldObject

DEFAULTS: Mapping[str, Any] = {
    "ball": 0.03,
    "box": [0.1, 0.1, 0.1],
    "sphere": 0.05,
    "cylinder": [0.05, 0.2],
    "capsule": [0.05, 0.2],
    "person": "anna",
    "nao": "Stand",
}
"""Of things that are placed by their kind alone; lengths in m."""
WHERE = "thing"
"""What error texts call the entry."""


def entry_of(
    thing: str | Mapping[str, Any], at: Sequence[float] | None, more: Mapping[str, Any], there: Collection[str]
) -> dict[str, Any]:
    """The entry of a world file that is meant; of a thing that is `there`, with what is said of it alone.

    Raises:
        SimulationError: There is neither a kind nor a thing of that name, or nobody says where it goes.
    """
    if isinstance(thing, Mapping):
        entry = {**thing, **more}
    elif thing in THINGS:
        entry = {"name": thing, **more}
        if entry["name"] not in there and thing not in entry:
            if thing not in DEFAULTS:
                raise WorldError(WHERE, f"{thing!r} does not say which: {thing}=...; docs/worlds.md has what there is")
            entry[thing] = DEFAULTS[thing]
    elif thing in there:
        check_keys(more, f"{thing!r}, which is there already", (), POSE, WorldError)
        entry = {"name": thing, **more}
    else:
        raise UnknownName("thing or kind of thing", thing, dict.fromkeys([*there, *THINGS]))
    if "position" in more:
        raise BadValue("position", more["position"], "none here: `at` says where it goes")
    if at is not None:
        entry["position"] = list(finite_numbers("at", at, 3))
    elif "position" not in entry:
        raise BadValue("at", at, "[x, y, z] in m")
    return entry


def check_same(entry: Mapping[str, Any], there: WorldObject) -> None:
    """Refuse an entry that says of a thing that is there what it is not.

    Raises:
        WorldError: The entry has a field that no such thing has.
        NotAllowed: It says something else.
    """
    said = [key for key in entry if key not in ("name", "position", *POSE)]
    if not said:
        return
    kind = {} if any(key in THINGS for key in said) else {there.kind: DEFAULTS.get(there.kind)}
    meant = read_object({**kind, **entry}, WHERE, Path)
    wrong = [key for key in said if key in NUMBERS and getattr(meant, key) != getattr(there, key)]
    if (meant.kind, meant.parts, meant.body) != (there.kind, there.parts, there.body):
        wrong += [key for key in said if key not in NUMBERS]
    if wrong:
        other = ", ".join(f"{key} {entry[key]}" for key in wrong)
        can = "it can be moved and turned (at, rpy, heading); remove it first to place another one"
        raise NotAllowed(f"{there.name!r} is there already, and not with {other}: {can}")


def turn_of(entry: Mapping[str, Any]) -> tuple[float, ...] | None:
    """Roll, pitch and yaw in rad that an entry says; None if it says none."""
    return tuple(orientation_of(entry, WHERE)) if any(key in entry for key in POSE) else None
