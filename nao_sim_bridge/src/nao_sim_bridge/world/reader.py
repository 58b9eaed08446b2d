"""Reads worlds strictly from the content of YAML files. Units: m, rad (slopes: deg), kg; colours: 0..1.

`floor` has `friction` (the engine multiplies the coefficients of the two that touch) and may have `color`,
`tile_color`, `tile_size`, `slope_deg: [along x, along y]` (rising), `rugs` (a list of `center`, `size`, `color` and
maybe `yaw`) and `bumps` (see `bumps.py`). `light` may have `direction`, `color` and `ambient`; `background` may
have `top`, `horizon` and `haze`.

Objects are read by `objects.py`; on a slope all places count from the floor: z is along its normal.
`sounds` are read by `sounds.py`. `robots` says where the first, the second... robot starts: a list of `position`,
[x, y] of its torso, and maybe `yaw`.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from nao_sim_bridge.base.bounded_files import read_bounded
from nao_sim_bridge.base.config import LARGEST_FILE, check_keys, vector
from nao_sim_bridge.base.errors import BadValue, ConfigError, did_you_mean
from nao_sim_bridge.base.paths import world_directory
from nao_sim_bridge.base.yaml_values import load_yaml
from nao_sim_bridge.world.bumps import read_bumps
from nao_sim_bridge.world.entries import GREY, check_bounds, color, entries, number
from nao_sim_bridge.world.objects import read_object
from nao_sim_bridge.world.places import RobotPlace
from nao_sim_bridge.world.sounds import read_sounds
from nao_sim_bridge.world.world import FLOOR, Background, Floor, Light, Rug, World, WorldError

SECTIONS = ("description", "light", "background", "objects", "sounds", "robots")
FLOOR_OPTIONS = ("color", "tile_color", "tile_size", "slope_deg", "rugs", "bumps")
# Steeper than this no sole holds, deg.
MAX_SLOPE = 30.0


def read_world(content: Any, name: str, where: str, folder: Path | None = None) -> World:
    """A world from the content of its file.

    Args:
        folder: Where the file is: files that it names are beside it.

    Raises:
        WorldError: If an entry is wrong, unknown or missing.
    """
    check_keys(content, where, ("floor",), SECTIONS, WorldError)
    check_bounds(content, where)
    beside = lambda file: (folder or Path()) / file  # noqa: E731
    try:
        objects = tuple(read_object(entry, place, beside) for place, entry in entries(content, "objects", where))
        floor = _read_floor(content["floor"], f"{where}: floor")
    except WorldError:
        raise
    except ConfigError as error:
        raise WorldError(error.where, error.problem) from error
    names = [FLOOR, *(thing.name for thing in objects)]
    for index, thing in enumerate(objects):
        if thing.name in names[: index + 1]:
            raise WorldError(f"{where}: objects[{index}].name", f"{thing.name!r} is taken")
    sounds = read_sounds(entries(content, "sounds", where), names[1:], folder, WorldError)
    return World(
        name=name,
        description=str(content.get("description", "")),
        floor=floor,
        light=_read_light(content.get("light", {}), f"{where}: light"),
        background=_read_background(content.get("background", {}), f"{where}: background"),
        objects=objects,
        sounds=sounds,
        robots=tuple(_read_place(entry, place) for place, entry in entries(content, "robots", where)),
    )


def _read_place(entry: Any, where: str) -> RobotPlace:
    check_keys(entry, where, ("position",), ("yaw",), WorldError)
    x, y = vector(entry["position"], f"{where}.position", 2, WorldError).tolist()
    try:
        return RobotPlace(x, y, number(entry, "yaw", where, 0.0, lowest=-math.inf))
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
        bumps = read_bumps(entry["bumps"], f"{where}.bumps")
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
    return tuple(sorted(path.stem for path in world_directory().glob("*.yaml")))


def load_world(name_or_path: str) -> World:
    """Read a world.

    Args:
        name_or_path: Name of a world of this package (`empty`), or a path that ends in `.yaml`.

    Raises:
        WorldError: If there is no such world, or an entry of it is wrong, unknown or missing.
    """
    path = Path(name_or_path)
    if path.suffix not in (".yaml", ".yml"):
        if name_or_path not in world_names():
            hint = did_you_mean(name_or_path, world_names())
            there = f"there are: {', '.join(world_names())}; or give a path to a .yaml"
            raise WorldError("world", f"no world {name_or_path!r}{hint} ({there})")
        path = world_directory() / f"{name_or_path}.yaml"
    try:
        content = load_yaml(read_bounded(path, LARGEST_FILE).decode("utf-8"))
    except (OSError, ValueError, yaml.YAMLError) as error:
        raise WorldError(path.name, f"cannot be read: {error}") from error
    return read_world(content, path.stem, path.name, path.parent)
