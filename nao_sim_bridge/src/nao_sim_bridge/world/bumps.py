"""Bumps of a floor: plates that lie about as chance will have it, the same at each run.

An entry has `count`, `size: [smallest, largest]` and `height: [lowest, highest]` in m, `area: [[x, y], [x, y]]` (two
corners), and may have `seed`, `color` and `keep_free: radius` around the origin, where the robot starts.
"""

from __future__ import annotations

import math
import random
from typing import Any, Mapping

from nao_sim_bridge.base.config import array, check_keys, vector
from nao_sim_bridge.model.shapes import Shape
from nao_sim_bridge.world.world import WorldError

KEYS = ("count", "size", "height", "area")
OPTIONS = ("seed", "color", "keep_free")
MAX_COUNT = 500
# So often a plate is thrown before its area is held for too small, for each plate asked for.
THROWS = 50


def read_bumps(entry: Any, where: str) -> tuple[Shape, ...]:
    """Boxes that lie on the floor, in its frame; they may overlap.

    Raises:
        WorldError: If a key is wrong, unknown or missing, or the area leaves no room.
    """
    check_keys(entry, where, KEYS, OPTIONS, WorldError)
    count, seed = _whole(entry, "count", where), _whole(entry, "seed", where)
    if not 1 <= count <= MAX_COUNT:
        raise WorldError(f"{where}.count", f"is {count}, allowed is 1..{MAX_COUNT}")
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
