"""Primitive shapes of the body: read from data files, mirrored to the right side, placed in link frames."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from nao_sim_bridge.base.config import check_keys, vector
from nao_sim_bridge.base.errors import ConfigError

KINDS = ("box", "sphere", "cylinder", "capsule")
"""What the physics and worlds know."""
SEEN_KINDS = (*KINDS, "ellipsoid", "pillow", "arc")
"""What pictures know."""
SIZE_COUNT = {"box": 3, "sphere": 1, "cylinder": 2, "capsule": 2, "ellipsoid": 3, "pillow": 3, "arc": 4}


@dataclass(frozen=True)
class Shape:
    """A primitive in a link frame.

    Attributes:
        kind: `box`, `sphere`, `cylinder`, `capsule`, `ellipsoid`, `pillow` (a box with soft edges) or `arc`
            (a piece of a flat ring). Cylinder, capsule and arc have Z as axis; the arc is centred on X.
        size: Box, pillow: edge lengths; sphere: radius; cylinder, capsule: radius and length (of a capsule
            without its caps); ellipsoid: half axes; arc: inner and outer radius and thickness; all in m. The
            fourth number of an arc is its angle in deg.
        xyz: Centre, m.
        rpy: Fixed-axis roll, pitch, yaw, rad.
        material: Name of a colour, or empty.
    """

    kind: str
    size: tuple[float, ...]
    xyz: tuple[float, float, float]
    rpy: tuple[float, float, float] = (0.0, 0.0, 0.0)
    material: str = ""

    def moved(self, way: Sequence[float]) -> Shape:
        return replace(self, xyz=_floats(np.add(self.xyz, way)))

    def mirrored(self) -> Shape:
        """The same shape on the other side of the XZ plane; exact, as all kinds are symmetric themselves."""
        (x, y, z), (roll, pitch, yaw) = self.xyz, self.rpy
        return replace(self, xyz=(x, -y, z), rpy=(-roll, pitch, -yaw))


def read_shape(entry: Any, where: str, extra: Iterable[str] = (), kinds_known: Sequence[str] = KINDS) -> Shape:
    """A shape from one entry of a data file.

    Args:
        entry: One of the kinds as key, with optional `xyz` and `rpy`; cylinder and capsule also with a radius
            alone and `from` and `to` instead. Optional `material`.
        where: File and path for error texts.
        extra: Further keys that the caller reads itself.
        kinds_known: Kinds that make sense to the caller.

    Raises:
        ConfigError: If the entry is not such a shape.
    """
    check_keys(entry, where, (), (*kinds_known, "xyz", "rpy", "from", "to", "material", *extra))
    kinds = [kind for kind in kinds_known if kind in entry]
    if len(kinds) != 1:
        known = ", ".join(kinds_known)
        raise ConfigError(where, f"needs exactly one of {known}, has {', '.join(kinds) or 'none'}")
    kind, material = kinds[0], str(entry.get("material", ""))
    if "from" in entry or "to" in entry:
        if kind not in ("cylinder", "capsule") or not {"from", "to"} <= set(entry) or {"xyz", "rpy"} & set(entry):
            raise ConfigError(where, "from and to go together, with cylinder or capsule, without xyz and rpy")
        start, end = vector(entry["from"], f"{where}.from"), vector(entry["to"], f"{where}.to")
        radius = vector([entry[kind]], f"{where}.{kind}", 1)[0]
        return rod(kind, float(radius), start, end, material)
    raw = [entry[kind]] if kind == "sphere" else entry[kind]
    size = vector(raw, f"{where}.{kind}", SIZE_COUNT[kind])
    if np.any(size <= 0.0):
        raise ConfigError(f"{where}.{kind}", f"is {entry[kind]!r}, sizes must be above 0")
    xyz = vector(entry.get("xyz", (0.0, 0.0, 0.0)), f"{where}.xyz")
    rpy = vector(entry.get("rpy", (0.0, 0.0, 0.0)), f"{where}.rpy")
    return Shape(kind, _floats(size), _floats(xyz), _floats(rpy), material)


def with_right_side(shapes: Mapping[str, tuple[Shape, ...]]) -> dict[str, tuple[Shape, ...]]:
    """Shapes by link of both sides, from those of the middle and of the left side, which are mirrored."""
    left = {name: of_link for name, of_link in shapes.items() if name.startswith("L")}
    return {**shapes, **{f"R{name[1:]}": tuple(shape.mirrored() for shape in left[name]) for name in left}}


def rod(kind: str, radius: float, start: np.ndarray, end: np.ndarray, material: str = "") -> Shape:
    """A cylinder or capsule between two points (the centres of the caps), in m."""
    along = end - start
    length = float(np.linalg.norm(along))
    pitch = math.atan2(math.hypot(along[0], along[1]), along[2])
    yaw = math.atan2(along[1], along[0])
    return Shape(kind, (radius, length), _floats((start + end) / 2.0), (0.0, pitch, yaw), material)


def _floats(values: Sequence[float]) -> tuple[float, ...]:
    return tuple(float(value) for value in values)
