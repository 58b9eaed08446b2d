"""What of the robot can be touched, and which of its links touch each other, from `config/collision.json`."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import lru_cache
from itertools import combinations
from typing import Any

from nao_sim_bridge.base.config import check_keys, config_file, read_json
from nao_sim_bridge.base.errors import ConfigError
from nao_sim_bridge.model.robot_model import RobotModel
from nao_sim_bridge.model.shapes import Shape, read_shape, with_right_side

FILE = "collision.json"
FINGERS = {"LHand": "LFingers", "RHand": "RFingers"}
"""Finger link of each hand joint."""


def read_collision_shapes(model: RobotModel) -> dict[str, tuple[Shape, ...]]:
    """Collision shapes by link name (and finger link name), the left ones mirrored to the right.

    Raises:
        ConfigError: If the file names a link that the robot does not have, or has a bad shape.
    """
    shapes = {
        name: tuple(read_shape(entry, f"{FILE}: links.{name}[{i}]") for i, entry in enumerate(entries))
        for name, entries in _tables()["links"].items()
    }
    for name in shapes:
        _check_link(model, name, f"{FILE}: links")
    return with_right_side(shapes)


def apart(model: RobotModel) -> Iterator[tuple[str, str]]:
    """Pairs of links that never touch each other, by their names in the URDF of the physics.

    PyBullet's flag that leaves out a link and all that carries it would also let the arms through the torso.

    Raises:
        ConfigError: If the file names a link that the robot does not have.
    """
    where = f"{FILE}: self_collision"
    keys = ("note", "reach_torso", "ignored_note", "ignored")
    section = check_keys(_tables()["self_collision"], where, keys)
    reach_torso = {side for name in section["reach_torso"] for side in (name, f"R{name[1:]}")}
    ignored = {frozenset(pair) for pair in section["ignored"]}
    for name in (*reach_torso, *(name for pair in ignored for name in pair)):
        _check_link(model, name, where)
    urdf_name = {link.name: link.alt_name for link in model.links}
    carriers = _carriers(model)
    for first, second in combinations(carriers, 2):
        related = first in carriers[second] or second in carriers[first]
        if "Torso" in (first, second) and {first, second} & reach_torso:
            related = False
        if related or frozenset((first, second)) in ignored:
            yield urdf_name.get(first, first), urdf_name.get(second, second)


def _carriers(model: RobotModel) -> dict[str, tuple[str, ...]]:
    """Each link, also of the fingers, with all links between it and the torso, torso included."""
    carriers: dict[str, tuple[str, ...]] = {"Torso": ()}
    for joint in model.joints:
        child = joint.child_link or FINGERS[joint.name]
        carriers[child] = (joint.parent_link, *carriers[joint.parent_link])
    return carriers


def _check_link(model: RobotModel, name: str, where: str) -> None:
    known = {link.name for link in model.links} | set(FINGERS.values())
    if name not in known:
        raise ConfigError(where, f"no link {name!r} (allowed: {', '.join(sorted(known))})")


@lru_cache(maxsize=None)
def _tables() -> Mapping[str, Any]:
    return check_keys(read_json(config_file(FILE)), FILE, ("_meta", "self_collision", "links"))
