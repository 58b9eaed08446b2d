"""Reads worlds strictly from the content of YAML files. Units: m, rad (slopes: deg), kg; colours: 0..1.

`floor` has `friction` (the engine multiplies the coefficients of the two that touch) and may have `color`,
`tile_color`, `tile_size`, `slope_deg: [along x, along y]` (rising), `rugs` (a list of `center`, `size`, `color` and
maybe `yaw`) and `bumps`: plates that lie about as chance will have it, the same at each run. These have `count`,
`size: [smallest, largest]` and `height: [lowest, highest]` in m, `area: [[x, y], [x, y]]` (two corners), and may have
`seed`, `color` and `keep_free: radius` around the origin, where the robot starts. `light` may have `direction`, `color`
and `ambient`; `background` may have `top`, `horizon` and `haze`.

Objects are read by `objects.py`; on a slope all places count from the floor: z is along its normal.
`sounds` are read by `sounds.py`. `robots` says where the first, the second... robot starts: a list of `position`,
[x, y] of its torso, or [x, y, z] where it stands on something z over the floor, and maybe `yaw`.
"""

from __future__ import annotations

import math
import random
from pathlib import Path
from typing import Any, Mapping, Sequence, Tuple

import numpy as np

from nao_sim_bridge.base.config import (
    LARGEST_FILE,
    array,
    check_keys,
    read_bounded,
    read_json,
    vector,
    world_directory,
)
from nao_sim_bridge.base.errors import BadValue, did_you_mean
from nao_sim_bridge.model.shapes import Shape
from nao_sim_bridge.world.entries import GREY, check_bounds, color, entries, number
from nao_sim_bridge.world.places import RobotPlace
from nao_sim_bridge.world.world import (
    FLOOR,
    Background,
    Floor,
    Light,
    Rug,
    World,
    WorldError,
    WorldObject,
    WorldSound,
)

SECTIONS = ("description", "light", "background", "objects", "sounds", "robots")
FLOOR_OPTIONS = ("color", "tile_color", "tile_size", "slope_deg", "rugs", "bumps")
# Steeper than this no sole holds, deg.
MAX_SLOPE = 30.0
BUMP_KEYS = ("count", "size", "height", "area")
BUMP_OPTIONS = ("seed", "color", "keep_free")
MOST_BUMPS = 500
SUFFIXES = (".yaml", ".json")
"""Of worlds that come along; what is read quickest is in JSON."""
Entry = Tuple[str, Any]
# So often a plate is thrown before its area is held for too small, for each plate asked for.
THROWS = 50


def read_world(content: Any, name: str, where: str, folder: Path | None = None) -> World:
    """A world from the content of its file; files that it names are in `folder`.

    Raises:
        WorldError: If an entry is wrong, unknown or missing.
    """
    check_keys(content, where, ("floor",), SECTIONS, WorldError)
    check_bounds(content, where)
    objects = _read_objects(entries(content, "objects", where), where, folder)
    sounds = _read_sounds(entries(content, "sounds", where), [thing.name for thing in objects], folder)
    return World(
        name=name,
        description=str(content.get("description", "")),
        floor=_read_floor(content["floor"], f"{where}: floor"),
        light=_read_light(content.get("light", {}), f"{where}: light"),
        background=_read_background(content.get("background", {}), f"{where}: background"),
        objects=objects,
        sounds=sounds,
        robots=tuple(_read_place(entry, place) for place, entry in entries(content, "robots", where)),
    )


def _read_objects(listed: Sequence[Entry], where: str, folder: Path | None) -> tuple[WorldObject, ...]:
    if not listed:
        return ()
    from nao_sim_bridge.world.objects import read_object  # a world without things needs nothing of it

    beside = lambda file: (folder or Path()) / file  # noqa: E731
    objects = tuple(read_object(entry, place, beside) for place, entry in listed)
    names = [FLOOR, *(thing.name for thing in objects)]
    for index, thing in enumerate(objects):
        if thing.name in names[: index + 1]:
            raise WorldError(f"{where}: objects[{index}].name", f"{thing.name!r} is taken")
    return objects


def _read_sounds(listed: Sequence[Entry], objects: Sequence[str], folder: Path | None) -> tuple[WorldSound, ...]:
    if not listed:
        return ()
    from nao_sim_bridge.world.sounds import read_sounds  # as for things

    return read_sounds(listed, objects, folder)


def _read_place(entry: Any, where: str) -> RobotPlace:
    check_keys(entry, where, ("position",), ("yaw",), WorldError)
    position = array(entry["position"], f"{where}.position", (-1,), WorldError).tolist()
    if len(position) not in (2, 3):
        raise WorldError(f"{where}.position", f"is {position}, not [x, y] or [x, y, z] in m")
    x, y, z = (*position, 0.0)[:3]
    try:
        return RobotPlace(x, y, number(entry, "yaw", where, 0.0, lowest=-math.inf), z)
    except BadValue as error:
        raise WorldError(where, str(error)) from error


def _read_floor(entry: Any, where: str) -> Floor:
    check_keys(entry, where, ("friction",), FLOOR_OPTIONS, WorldError)
    tile = color(entry, "color", where, (0.8, 0.79, 0.76))
    slope = vector(entry.get("slope_deg", (0.0, 0.0)), f"{where}.slope_deg", 2, WorldError)
    if np.any(np.abs(slope) > MAX_SLOPE):
        raise WorldError(f"{where}.slope_deg", f"is {slope.tolist()}, allowed is -{MAX_SLOPE:g}..{MAX_SLOPE:g} each")
    bumps, bump_color = (), GREY
    if "bumps" in entry:
        bumps = _read_bumps(entry["bumps"], f"{where}.bumps")
        bump_color = color(entry["bumps"], "color", f"{where}.bumps", GREY)
    return Floor(
        friction=number(entry, "friction", where, 1.0),
        color=tile,
        tile_color=color(entry, "tile_color", where, tile),
        tile_size=number(entry, "tile_size", where, 0.25, lowest=0.01),
        slope=(math.radians(slope[0]), math.radians(slope[1])),
        rugs=tuple(_read_rug(rug, place) for place, rug in entries(entry, "rugs", where)),
        bumps=bumps,
        bump_color=bump_color,
    )


def _read_rug(entry: Any, where: str) -> Rug:
    check_keys(entry, where, ("center", "size", "color"), ("yaw",), WorldError)
    center = vector(entry["center"], f"{where}.center", 2, WorldError)
    size = vector(entry["size"], f"{where}.size", 2, WorldError)
    if np.any(size <= 0.0):
        raise WorldError(f"{where}.size", f"is {size.tolist()}, sizes must be above 0")
    yaw = number(entry, "yaw", where, 0.0, lowest=-math.inf)
    return Rug(tuple(center.tolist()), tuple(size.tolist()), yaw, color(entry, "color", where, GREY))


def _read_bumps(entry: Any, where: str) -> tuple[Shape, ...]:
    """Boxes that lie on the floor, in its frame; they may overlap.

    Raises:
        WorldError: If a key is wrong, unknown or missing, or the area leaves no room.
    """
    check_keys(entry, where, BUMP_KEYS, BUMP_OPTIONS, WorldError)
    count, seed = _whole(entry, "count", where), _whole(entry, "seed", where)
    if not 1 <= count <= MOST_BUMPS:
        raise WorldError(f"{where}.count", f"is {count}, allowed is 1..{MOST_BUMPS}")
    size, height = _range(entry, "size", where), _range(entry, "height", where)
    (x0, y0), (x1, y1) = array(entry["area"], f"{where}.area", (2, 2), WorldError).tolist()
    free = float(vector([entry.get("keep_free", 0.0)], f"{where}.keep_free", 1, WorldError)[0])
    chance = random.Random(seed)
    plates: list[Shape] = []
    for _ in range(THROWS * count):
        edges = (chance.uniform(*size), chance.uniform(*size), chance.uniform(*height))
        x, y, yaw = chance.uniform(x0, x1), chance.uniform(y0, y1), chance.uniform(0.0, math.pi)
        if math.hypot(x, y) - math.hypot(edges[0], edges[1]) / 2.0 >= free or free == 0.0:
            plates.append(Shape("box", edges, (x, y, edges[2] / 2.0), (0.0, 0.0, yaw)))
        if len(plates) == count:
            return tuple(plates)
    raise WorldError(f"{where}.keep_free", f"is {free:g} m, which leaves no room for {count} plates in the area")


def _range(entry: Mapping, key: str, where: str) -> tuple[float, float]:
    low, high = vector(entry[key], f"{where}.{key}", 2, WorldError).tolist()
    if not 0.0 < low <= high:
        raise WorldError(f"{where}.{key}", f"is {entry[key]!r}, not two numbers above 0, the smaller one first")
    return low, high


def _whole(entry: Mapping, key: str, where: str) -> int:
    value = entry.get(key, 0)
    if not isinstance(value, int) or isinstance(value, bool):
        raise WorldError(f"{where}.{key}", f"is {value!r}, not a whole number")
    return value


def _read_light(entry: Any, where: str) -> Light:
    check_keys(entry, where, (), ("direction", "color", "ambient"), WorldError)
    direction = vector(entry.get("direction", (0.9, 0.6, 1.8)), f"{where}.direction", 3, WorldError)
    if direction[2] <= 0.0:
        raise WorldError(f"{where}.direction", f"is {direction.tolist()}, the light must be above the floor")
    return Light(
        direction=tuple(direction.tolist()),
        color=color(entry, "color", where, (1.0, 1.0, 1.0)),
        ambient=number(entry, "ambient", where, 0.55, highest=1.0),
    )


def _read_background(entry: Any, where: str) -> Background:
    check_keys(entry, where, (), ("top", "horizon", "haze"), WorldError)
    return Background(
        top=color(entry, "top", where, (0.66, 0.74, 0.82)),
        horizon=color(entry, "horizon", where, (0.88, 0.90, 0.92)),
        haze=number(entry, "haze", where, 5.0, lowest=0.1),
    )


def world_names() -> tuple[str, ...]:
    """Worlds that come with the package."""
    return tuple(sorted(path.stem for path in world_directory().iterdir() if path.suffix in SUFFIXES))


def load_world(name_or_path: str) -> World:
    """Read a world of this package by its name (`empty`), or from a path that ends in `.yaml`.

    Raises:
        WorldError: If there is no such world, or an entry of it is wrong, unknown or missing.
    """
    path = Path(name_or_path)
    if path.suffix not in (".yaml", ".yml"):
        if name_or_path not in world_names():
            hint = did_you_mean(name_or_path, world_names())
            there = f"there are: {', '.join(world_names())}; or give a path to a .yaml"
            raise WorldError("world", f"no world {name_or_path!r}{hint} ({there})")
        path = world_directory() / f"{name_or_path}.json"
        if path.exists():
            return read_world(read_json(path), path.stem, path.name, path.parent)
        path = path.with_suffix(".yaml")
    import yaml  # takes longer to load than the engine

    from nao_sim_bridge.base.yaml_values import load_yaml

    try:
        content = load_yaml(read_bounded(path, LARGEST_FILE).decode("utf-8"))
    except (OSError, ValueError, yaml.YAMLError) as error:
        raise WorldError(path.name, f"cannot be read: {error}") from error
    return read_world(content, path.stem, path.name, path.parent)
