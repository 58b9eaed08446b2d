"""Reads worlds strictly from the content of YAML files. Units: m, rad (slopes: deg), kg; colours: 0..1.

`floor` has `friction` (the engine multiplies the coefficients of the two that touch) and may have `color`,
`tile_color`, `tile_size`, `slope_deg: [along x, along y]` (rising), `rugs` (a list of `center`, `size`, `color` and
maybe `yaw`) and `bumps` (see `world_bumps.py`). `light` may have `direction`, `color` and `ambient`; `background` may
have `top`, `horizon` and `haze`.

An object has `name` and `position`, and is a shape (`box: [x, y, z]`, `sphere: radius`, `cylinder: [radius, length]`
or `capsule: [radius, length]`) or has `parts`: a list of such shapes with `xyz` and maybe `rpy` and `color`, placed in
a frame that is at `position`. It may have `rpy`, `mass` (0, the default, is immovable), `color`, `friction`,
`rolling_friction`, `restitution`. On a slope all places count from the floor: z is along its normal.
`sounds` are read by `world_sounds.py`.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from nao_sim_bridge.sim.config import check_keys, vector
from nao_sim_bridge.sim.errors import ConfigError
from nao_sim_bridge.sim.kinematics import rpy_matrix
from nao_sim_bridge.sim.shapes import KINDS, Shape, read_shape
from nao_sim_bridge.sim.world import (
    FLOOR,
    MOST_PARTS,
    Background,
    Color,
    Floor,
    Light,
    Part,
    Rug,
    World,
    WorldError,
    WorldObject,
)
from nao_sim_bridge.sim.world_bumps import read_bumps
from nao_sim_bridge.sim.world_sounds import read_sounds

SECTIONS = ("description", "light", "background", "objects", "sounds")
OBJECT_OPTIONS = ("parts", "rpy", "mass", "color", "friction", "rolling_friction", "restitution")
FLOOR_OPTIONS = ("color", "tile_color", "tile_size", "slope_deg", "rugs", "bumps")
GREY = (0.6, 0.6, 0.6)
# Steeper than this no sole holds, deg.
MAX_SLOPE = 30.0


def read_world(content: Any, name: str, where: str, folder: Path | None = None) -> World:
    """A world from the content of its file.

    Args:
        content: What the file holds.
        name: Of the world.
        where: File name for error texts.
        folder: Where the file is: files that it names are beside it.

    Raises:
        WorldError: If an entry is wrong, unknown or missing.
    """
    check_keys(content, where, ("floor",), SECTIONS, WorldError)
    try:
        objects = tuple(_read_object(entry, place) for place, entry in _entries(content, "objects", where))
        floor = _read_floor(content["floor"], f"{where}: floor")
    except WorldError:
        raise
    except ConfigError as error:
        raise WorldError(error.where, error.problem) from error
    names = [FLOOR, *(thing.name for thing in objects)]
    for index, thing in enumerate(objects):
        if thing.name in names[: index + 1]:
            raise WorldError(f"{where}: objects[{index}].name", f"{thing.name!r} is taken")
    sounds = read_sounds(_entries(content, "sounds", where), names[1:], folder, WorldError)
    return World(
        name=name,
        description=str(content.get("description", "")),
        floor=floor,
        light=_read_light(content.get("light", {}), f"{where}: light"),
        background=_read_background(content.get("background", {}), f"{where}: background"),
        objects=objects,
        sounds=sounds,
    )


def _entries(content: Mapping, key: str, where: str) -> list[tuple[str, Any]]:
    """The entries of a list, each with its place for error texts."""
    entries = content.get(key) or []
    if not isinstance(entries, list):
        raise WorldError(f"{where}: {key}", f"is {entries!r}, not a list")
    return [(f"{where}: {key}[{i}]", entry) for i, entry in enumerate(entries)]


def _read_floor(entry: Any, where: str) -> Floor:
    check_keys(entry, where, ("friction",), FLOOR_OPTIONS, WorldError)
    color = _color(entry, "color", where, (0.8, 0.79, 0.76))
    slope = vector(entry.get("slope_deg", (0.0, 0.0)), f"{where}.slope_deg", 2, WorldError)
    if np.any(np.abs(slope) > MAX_SLOPE):
        raise WorldError(f"{where}.slope_deg", f"is {slope.tolist()}, allowed is -{MAX_SLOPE:g}..{MAX_SLOPE:g} each")
    bumps, bump_color = (), GREY
    if "bumps" in entry:
        bumps = read_bumps(entry["bumps"], f"{where}.bumps")
        bump_color = _color(entry["bumps"], "color", f"{where}.bumps", GREY)
    return Floor(
        friction=_number(entry, "friction", where, 1.0),
        color=color,
        tile_color=_color(entry, "tile_color", where, color),
        tile_size=_number(entry, "tile_size", where, 0.25, lowest=0.01),
        slope=(math.radians(slope[0]), math.radians(slope[1])),
        rugs=tuple(_read_rug(rug, place) for place, rug in _entries(entry, "rugs", where)),
        bumps=bumps,
        bump_color=bump_color,
    )


def _read_rug(entry: Any, where: str) -> Rug:
    check_keys(entry, where, ("center", "size", "color"), ("yaw",), WorldError)
    center = vector(entry["center"], f"{where}.center", 2, WorldError)
    size = vector(entry["size"], f"{where}.size", 2, WorldError)
    if np.any(size <= 0.0):
        raise WorldError(f"{where}.size", f"is {size.tolist()}, sizes must be above 0")
    yaw = _number(entry, "yaw", where, 0.0, lowest=-math.inf)
    return Rug(tuple(center.tolist()), tuple(size.tolist()), yaw, _color(entry, "color", where, GREY))


def _read_light(entry: Any, where: str) -> Light:
    check_keys(entry, where, (), ("direction", "color", "ambient"), WorldError)
    direction = vector(entry.get("direction", (0.9, 0.6, 1.8)), f"{where}.direction", 3, WorldError)
    if direction[2] <= 0.0:
        raise WorldError(f"{where}.direction", f"is {direction.tolist()}, the light must be above the floor")
    return Light(
        direction=tuple(direction.tolist()),
        color=_color(entry, "color", where, (1.0, 1.0, 1.0)),
        ambient=_number(entry, "ambient", where, 0.55, highest=1.0),
    )


def _read_background(entry: Any, where: str) -> Background:
    check_keys(entry, where, (), ("top", "horizon", "haze"), WorldError)
    return Background(
        top=_color(entry, "top", where, (0.66, 0.74, 0.82)),
        horizon=_color(entry, "horizon", where, (0.88, 0.90, 0.92)),
        haze=_number(entry, "haze", where, 5.0, lowest=0.1),
    )


def _read_object(entry: Any, where: str) -> WorldObject:
    check_keys(entry, where, ("name", "position"), (*KINDS, *OBJECT_OPTIONS), WorldError)
    if not isinstance(entry["name"], str) or not entry["name"]:
        raise WorldError(f"{where}.name", f"is {entry['name']!r}, not a name")
    position = vector(entry["position"], f"{where}.position", 3, WorldError)
    rpy = vector(entry.get("rpy", (0.0, 0.0, 0.0)), f"{where}.rpy", 3, WorldError)
    parts, middle = _centred(_read_parts(entry, where))
    return WorldObject(
        name=entry["name"],
        position=tuple((position + rpy_matrix(rpy) @ middle).tolist()),
        rpy=tuple(rpy.tolist()),
        parts=parts,
        mass=_number(entry, "mass", where, 0.0),
        friction=_number(entry, "friction", where, 0.7),
        rolling_friction=_number(entry, "rolling_friction", where, 0.0005),
        restitution=_number(entry, "restitution", where, 0.0, highest=1.0),
    )


def _read_parts(entry: Mapping, where: str) -> list[Part]:
    color = _color(entry, "color", where, GREY)
    if "parts" not in entry:
        return [Part(read_shape({key: entry[key] for key in KINDS if key in entry}, where), color)]
    if any(kind in entry for kind in KINDS):
        raise WorldError(where, f"has parts and a shape of its own ({', '.join(KINDS)}): one of both")
    parts = [
        Part(read_shape(part, place, extra=("color",)), _color(part, "color", place, color))
        for place, part in _entries(entry, "parts", where)
    ]
    if not 1 <= len(parts) <= MOST_PARTS:
        raise WorldError(f"{where}.parts", f"has {len(parts)} entries, allowed is 1..{MOST_PARTS}")
    return parts


def _centred(parts: list[Part]) -> tuple[tuple[Part, ...], np.ndarray]:
    """The parts in a frame at their centre of mass, and that point in the frame that they were in."""
    volumes = np.array([_volume(part.shape) for part in parts])
    middle = volumes @ np.array([part.shape.xyz for part in parts]) / volumes.sum()
    shapes = [replace(part.shape, xyz=tuple((np.array(part.shape.xyz) - middle).tolist())) for part in parts]
    return tuple(replace(part, shape=shape) for part, shape in zip(parts, shapes)), middle


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


def _number(
    entry: Mapping, key: str, where: str, default: float, lowest: float = 0.0, highest: float = math.inf
) -> float:
    value = float(vector([entry.get(key, default)], f"{where}.{key}", 1, WorldError)[0])
    if not lowest <= value <= highest:
        upper = f"..{highest:g}" if highest != math.inf else " or more"
        raise WorldError(f"{where}.{key}", f"is {value:g}, allowed is {lowest:g}{upper}")
    return value


def _color(entry: Mapping, key: str, where: str, default: Color) -> Color:
    color = vector(entry.get(key, default), f"{where}.{key}", 3, WorldError)
    if color.min() < 0.0 or color.max() > 1.0:
        raise WorldError(f"{where}.{key}", f"is {color.tolist()}, allowed is 0..1 each")
    return tuple(color.tolist())
