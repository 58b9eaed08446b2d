"""Reads the things of a world: shapes, several shapes in one piece, and what is known by name (cards, people, robots).

A thing has `name` and `position`, may have `rpy` or `heading` (rad), `mass` (0, the default, is immovable), `color`,
`friction`, `rolling_friction` and `restitution`, and says what it is in one of these ways:

- a shape: `box: [x, y, z]`, `sphere: radius`, `cylinder: [radius, length]` or `capsule: [radius, length]`, maybe with
  a `picture`: `poster:hills`, `pattern:oak`, `landmark:64`... on its +X side;
- `parts`: a list of such shapes with `xyz` and maybe `rpy`, `color` and `picture`, in a frame that is at `position`;
- one of the kinds of `cards.py`, `people.py` and `robots.py`, or `ball: radius`.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, Callable

import numpy as np

from nao_sim_bridge.base.config import check_keys, vector
from nao_sim_bridge.base.errors import ConfigError
from nao_sim_bridge.base.rotations import vector3
from nao_sim_bridge.model.kinematics import rpy_matrix
from nao_sim_bridge.model.shapes import KINDS, Shape, read_shape
from nao_sim_bridge.world.cards import CARDS
from nao_sim_bridge.world.entries import GREY, Kind, Made, check_bounds, color, entries, name_of, number, picture
from nao_sim_bridge.world.people import PERSON
from nao_sim_bridge.world.robots import NAO
from nao_sim_bridge.world.world import MOST_PARTS, Part, WorldError, WorldObject

POSE = ("rpy", "heading")
"""Fields of an entry besides its position that say where a thing is, not what it is."""
NUMBERS = ("mass", "friction", "rolling_friction", "restitution")
COMMON = (*POSE, *NUMBERS)
BALL_RED = (0.85, 0.10, 0.08)
# Light foam: rolls some steps far when a foot meets it.
BALL_DEFAULTS = {"mass": 0.03, "friction": 0.6, "rolling_friction": 0.0004, "restitution": 0.4}
DEFAULTS = {"mass": 0.0, "friction": 0.7, "rolling_friction": 0.0005, "restitution": 0.0}


def _shape_alone(entry: Mapping, where: str, _files: object) -> Made:
    shape = read_shape({key: entry[key] for key in KINDS if key in entry}, where)
    return Made((_part(shape, entry, where, GREY),))


def _several_parts(entry: Mapping, where: str, _files: object) -> Made:
    if any(kind in entry for kind in KINDS):
        raise WorldError(where, f"has parts and a shape of its own ({', '.join(KINDS)}): one of both")
    general = color(entry, "color", where, GREY)
    parts = tuple(
        _part(read_shape(part, place, extra=("color", "picture")), part, place, general)
        for place, part in entries(entry, "parts", where)
    )
    if not 1 <= len(parts) <= MOST_PARTS:
        raise WorldError(f"{where}.parts", f"has {len(parts)} entries, allowed is 1..{MOST_PARTS}")
    return Made(parts)


def _ball(entry: Mapping, where: str, _files: object) -> Made:
    shape = read_shape({"sphere": entry["ball"]}, where)
    return Made((Part(shape, color(entry, "color", where, BALL_RED)),), defaults=BALL_DEFAULTS)


THINGS: Mapping[str, Kind] = {
    **{kind: Kind(("color", "picture"), _shape_alone) for kind in KINDS},
    "parts": Kind(("color", *KINDS), _several_parts),
    "ball": Kind(("color",), _ball),
    **CARDS,
    "person": PERSON,
    "nao": NAO,
}
"""What a thing can be, by the key of its entry that says so."""


def read_object(entry: Any, where: str, files: Callable[[str], Path]) -> WorldObject:
    """A thing from its entry; `files` gives the path of a file that it names.

    Raises:
        WorldError: The entry is wrong.
    """
    check_bounds(entry, where)
    try:
        return _read(entry, where, files)
    except WorldError:
        raise
    except ConfigError as error:
        raise WorldError(error.where, error.problem) from error


def _read(entry: Any, where: str, files: Callable[[str], Path]) -> WorldObject:
    known = dict.fromkeys(key for kind in THINGS.values() for key in kind.options)
    check_keys(entry, where, ("name", "position"), dict.fromkeys([*THINGS, *known, *COMMON]), WorldError)
    title = name_of(entry, where)
    called = [key for key in THINGS if key in entry]
    name = "parts" if "parts" in called else called[0] if len(called) == 1 else ""
    if not name:
        raise WorldError(where, f"needs exactly one of {', '.join(THINGS)}, has {', '.join(called) or 'none'}")
    kind = THINGS[name]
    check_keys(entry, where, ("name", "position", name), (*kind.options, *COMMON), WorldError)
    made = kind.make(entry, where, files)
    values = {**DEFAULTS, **made.defaults}
    position = vector(entry["position"], f"{where}.position", 3, WorldError)
    rpy = orientation_of(entry, where)
    parts, body, middle = _centred(made)
    return WorldObject(
        name=title,
        position=vector3(position + rpy_matrix(rpy) @ middle),
        rpy=vector3(rpy),
        parts=parts,
        mass=number(entry, "mass", where, values["mass"]),
        friction=number(entry, "friction", where, values["friction"]),
        rolling_friction=number(entry, "rolling_friction", where, values["rolling_friction"]),
        restitution=number(entry, "restitution", where, values["restitution"], highest=1.0),
        body=body,
        kind=name if name != "parts" else "thing",
        origin=vector3(-middle),
    )


def orientation_of(entry: Mapping, where: str) -> np.ndarray:
    """Roll, pitch and yaw of an entry, rad."""
    if "heading" not in entry:
        return vector(entry.get("rpy", (0.0, 0.0, 0.0)), f"{where}.rpy", 3, WorldError)
    if "rpy" in entry:
        raise WorldError(where, "has rpy and heading: one of both")
    return np.array([0.0, 0.0, number(entry, "heading", where, 0.0, lowest=-math.inf)])


def _part(shape: Shape, entry: Mapping, where: str, default: tuple) -> Part:
    seen = color(entry, "color", where, default)
    if "picture" not in entry:
        return Part(shape, seen)
    kind, colon, content = str(entry["picture"]).partition(":")
    if not colon or kind == "file":
        raise WorldError(f"{where}.picture", f"is {entry['picture']!r}, not a kind and a name such as poster:hills")
    return Part(shape, seen, picture(kind, content, f"{where}.picture"))


def _centred(made: Made) -> tuple[tuple[Part, ...], tuple[Shape, ...] | None, np.ndarray]:
    """Parts and body in a frame at their centre of mass, and that point in the frame that they were in."""
    touched = [part.shape for part in made.parts] if made.body is None else made.body
    volumes = np.array([_volume(shape) for shape in touched])
    middle = volumes @ np.array([shape.xyz for shape in touched]) / volumes.sum()
    parts = tuple(replace(part, shape=part.shape.moved(-middle)) for part in made.parts)
    body = None if made.body is None else tuple(shape.moved(-middle) for shape in made.body)
    return parts, body, middle


def _volume(shape: Shape) -> float:
    """m3, of the kinds that the physics knows."""
    if shape.kind == "box":
        return math.prod(shape.size)
    radius = shape.size[0]
    ball = 4.0 / 3.0 * math.pi * radius**3
    if shape.kind == "sphere":
        return ball
    rod = math.pi * radius**2 * shape.size[1]
    return rod + ball if shape.kind == "capsule" else rod
