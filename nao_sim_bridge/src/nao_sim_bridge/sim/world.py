"""Worlds: what surrounds the robot, read strictly from YAML, built alike for the physics and for pictures.

A world file has `floor`, and may have `description`, `light`, `background` and `objects`. An object is a
shape (`box: [x, y, z]`, `sphere: radius`, `cylinder: [radius, length]` or `capsule: [radius, length]`) with
`name`, `position`, and maybe `rpy`, `mass` (0, the default, is static), `color`, `friction`,
`rolling_friction`, `restitution`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pybullet
import yaml

from nao_sim_bridge.paths import world_directory
from nao_sim_bridge.sim.config import check_keys, vector
from nao_sim_bridge.sim.errors import ConfigError
from nao_sim_bridge.sim.meshes import tessellate
from nao_sim_bridge.sim.shapes import KINDS, Shape, read_shape
from nao_sim_bridge.sim.visuals import visual_shape

FLOOR = "floor"
OBJECT_OPTIONS = ("rpy", "mass", "color", "friction", "rolling_friction", "restitution")
FLOOR_EXTENT = 10.0
"""Half the edge length of the visible floor, m; the floor of the physics has no end."""

Color = tuple  # (r, g, b) in 0..1
GREY = (0.6, 0.6, 0.6)


class WorldError(ConfigError):
    """A world file cannot be used, or there is none of that name."""


@dataclass(frozen=True)
class Floor:
    """The floor at z = 0.

    Attributes:
        friction: Coefficient.
        color: Of every other tile.
        tile_color: Of the tiles between; equal to `color` for a plain floor.
        tile_size: Edge of a tile, m.
    """

    friction: float
    color: Color
    tile_color: Color
    tile_size: float


@dataclass(frozen=True)
class Light:
    """The lamp of the pictures.

    Attributes:
        direction: From the scene towards the light, any length.
        color: (r, g, b) in 0..1.
        ambient: Share of the light that comes from everywhere, 0..1.
    """

    direction: tuple[float, float, float]
    color: Color
    ambient: float


@dataclass(frozen=True)
class Background:
    """What fills a picture where nothing is.

    Attributes:
        top: (r, g, b) at the upper edge.
        horizon: (r, g, b) in the middle and below.
    """

    top: Color
    horizon: Color


@dataclass(frozen=True)
class WorldObject:
    """A thing in the world.

    Attributes:
        name: Unique in the world.
        shape: Kind and size; its place is the pose of the object in world.
        mass: kg; 0 is immovable.
        color: (r, g, b) in 0..1.
        friction: Coefficient.
        rolling_friction: m; keeps balls from rolling for ever.
        restitution: 0..1.
    """

    name: str
    shape: Shape
    mass: float
    color: Color
    friction: float
    rolling_friction: float
    restitution: float


@dataclass(frozen=True)
class World:
    """A world.

    Attributes:
        name: File name without ending.
        description: One line for people.
        floor: The floor.
        light: The light of the pictures.
        background: Colours behind everything.
        objects: Everything else.
    """

    name: str
    description: str
    floor: Floor
    light: Light
    background: Background
    objects: tuple[WorldObject, ...]


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
            there = ", ".join(world_names())
            raise WorldError("world", f"no world {name_or_path!r} (there are: {there}; or give a path to a .yaml)")
        path = world_directory() / f"{name_or_path}.yaml"
    try:
        content = yaml.safe_load(path.read_text(encoding="utf-8"))
    except (OSError, yaml.YAMLError) as error:
        raise WorldError(path.name, f"cannot be read: {error}") from error
    return read_world(content, path.stem, path.name)


def read_world(content: Any, name: str, where: str) -> World:
    """A world from the content of its file; `where` is the file name for error texts."""
    check_keys(content, where, ("floor",), ("description", "light", "background", "objects"), WorldError)
    entries = content.get("objects") or []
    if not isinstance(entries, list):
        raise WorldError(f"{where}: objects", f"is {entries!r}, not a list")
    objects = tuple(_read_object(entry, f"{where}: objects[{i}]") for i, entry in enumerate(entries))
    names = [FLOOR, *(thing.name for thing in objects)]
    for index, thing in enumerate(objects, start=1):
        if thing.name in names[:index]:
            raise WorldError(f"{where}: objects[{index - 1}].name", f"{thing.name!r} is taken")
    return World(
        name=name,
        description=str(content.get("description", "")),
        floor=_read_floor(content["floor"], f"{where}: floor"),
        light=_read_light(content.get("light", {}), f"{where}: light"),
        background=_read_background(content.get("background", {}), f"{where}: background"),
        objects=objects,
    )


def _read_floor(entry: Any, where: str) -> Floor:
    check_keys(entry, where, ("friction",), ("color", "tile_color", "tile_size"), WorldError)
    color = _color(entry, "color", where, (0.8, 0.79, 0.76))
    return Floor(
        friction=_number(entry, "friction", where, 1.0),
        color=color,
        tile_color=_color(entry, "tile_color", where, color),
        tile_size=_number(entry, "tile_size", where, 0.25, lowest=0.01),
    )


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
    check_keys(entry, where, (), ("top", "horizon"), WorldError)
    top = _color(entry, "top", where, (0.66, 0.74, 0.82))
    return Background(top, _color(entry, "horizon", where, (0.88, 0.90, 0.92)))


def _read_object(entry: Any, where: str) -> WorldObject:
    check_keys(entry, where, ("name", "position"), (*KINDS, *OBJECT_OPTIONS), WorldError)
    if not isinstance(entry["name"], str) or not entry["name"]:
        raise WorldError(f"{where}.name", f"is {entry['name']!r}, not a name")
    shape_entry = {key: entry[key] for key in KINDS if key in entry}
    shape_entry.update(xyz=entry["position"], rpy=entry.get("rpy", (0.0, 0.0, 0.0)))
    try:
        shape = read_shape(shape_entry, where)
    except WorldError:
        raise
    except ConfigError as error:
        raise WorldError(error.where, error.problem) from error
    return WorldObject(
        name=entry["name"],
        shape=shape,
        mass=_number(entry, "mass", where, 0.0),
        color=_color(entry, "color", where, GREY),
        friction=_number(entry, "friction", where, 0.7),
        rolling_friction=_number(entry, "rolling_friction", where, 0.0005),
        restitution=_number(entry, "restitution", where, 0.0, highest=1.0),
    )


def _number(
    entry: Mapping, key: str, where: str, default: float, lowest: float = 0.0, highest: float = float("inf")
) -> float:
    value = float(vector([entry.get(key, default)], f"{where}.{key}", 1, WorldError)[0])
    if not lowest <= value <= highest:
        upper = f"..{highest:g}" if highest != float("inf") else " or more"
        raise WorldError(f"{where}.{key}", f"is {value:g}, allowed is {lowest:g}{upper}")
    return value


def _color(entry: Mapping, key: str, where: str, default: Color) -> Color:
    color = vector(entry.get(key, default), f"{where}.{key}", 3, WorldError)
    if color.min() < 0.0 or color.max() > 1.0:
        raise WorldError(f"{where}.{key}", f"is {color.tolist()}, allowed is 0..1 each")
    return tuple(color.tolist())


def build_world(world: World, client: int, visual: bool) -> dict[str, int]:
    """Put the floor and all objects into a PyBullet world.

    Args:
        world: What to build.
        client: PyBullet's physics client.
        visual: Make something to look at and nothing to touch (pictures), or the other way round (physics).

    Returns:
        PyBullet's body ids by name; `floor` is among them.
    """
    bodies = {FLOOR: _build_floor(world.floor, client, visual)}
    for thing in world.objects:
        bodies[thing.name] = _build_object(thing, client, visual)
    return bodies


def _build_floor(floor: Floor, client: int, visual: bool) -> int:
    if visual:
        extents = (FLOOR_EXTENT, FLOOR_EXTENT, 0.005)
        seen = pybullet.createVisualShape(
            pybullet.GEOM_BOX,
            halfExtents=extents,
            rgbaColor=(*floor.color, 1.0),
            specularColor=(0.0, 0.0, 0.0),
            physicsClientId=client,
        )
        # The top face is the floor: half the thickness below z = 0.
        return pybullet.createMultiBody(0.0, -1, seen, basePosition=(0.0, 0.0, -extents[2]), physicsClientId=client)
    touched = pybullet.createCollisionShape(pybullet.GEOM_PLANE, physicsClientId=client)
    body = pybullet.createMultiBody(0.0, touched, physicsClientId=client)
    pybullet.changeDynamics(body, -1, lateralFriction=floor.friction, physicsClientId=client)
    return body


def _build_object(thing: WorldObject, client: int, visual: bool) -> int:
    shape = thing.shape
    touched, seen, mass = -1, -1, 0.0
    if visual:
        seen = visual_shape(tessellate(shape), thing.color, client)
    else:
        touched, mass = _collision_shape(shape, client), thing.mass
    body = pybullet.createMultiBody(
        mass,
        touched,
        seen,
        basePosition=shape.xyz,
        baseOrientation=pybullet.getQuaternionFromEuler(shape.rpy),
        physicsClientId=client,
    )
    if not visual:
        pybullet.changeDynamics(
            body,
            -1,
            lateralFriction=thing.friction,
            rollingFriction=thing.rolling_friction,
            spinningFriction=thing.rolling_friction,
            restitution=thing.restitution,
            physicsClientId=client,
        )
    return body


def _collision_shape(shape: Shape, client: int) -> int:
    if shape.kind == "box":
        half = [edge / 2.0 for edge in shape.size]
        return pybullet.createCollisionShape(pybullet.GEOM_BOX, halfExtents=half, physicsClientId=client)
    size: dict[str, Any] = {"radius": shape.size[0]}
    if shape.kind != "sphere":
        size["height"] = shape.size[1]
    kind = getattr(pybullet, f"GEOM_{shape.kind.upper()}")
    return pybullet.createCollisionShape(kind, physicsClientId=client, **size)
