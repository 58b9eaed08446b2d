"""What the robot looks like: coloured shapes on its links and the lamps, from `config/appearance.json`.

Shapes are authored for the middle and the left side; the right side is their mirror image.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np

from nao_sim_bridge.base.config import check_keys, config_file, read_json, vector
from nao_sim_bridge.base.errors import ConfigError
from nao_sim_bridge.model.kinematics import matrix_rpy, rpy_matrix
from nao_sim_bridge.model.leds_layout import Lamp, load_leds
from nao_sim_bridge.model.model_reader import load_model
from nao_sim_bridge.model.robot_model import frozen_mapping
from nao_sim_bridge.model.shapes import SEEN_KINDS, Shape, read_shape, with_right_side

FILE = "appearance.json"
PHALANX = "Phalanx"
"""Entry of the shapes that every finger and thumb phalanx has."""
OFF = "led_off"
"""Material of a lamp without light."""


@dataclass(frozen=True)
class LampFigure:
    """How a lamp looks: the link that carries it, and its shape in the frame of the link."""

    lamp: Lamp
    link: str
    shape: Shape


@dataclass(frozen=True, eq=False)
class Appearance:
    """The looks of the robot.

    Attributes:
        materials: Name to (r, g, b) in 0..1.
        shapes: Link name to its shapes; links without an entry are not seen.
        phalanx: Shapes of each phalanx, X along the finger.
        lamps: All lamps, in the order of the LED layout.
    """

    materials: Mapping[str, tuple[float, float, float]]
    shapes: Mapping[str, tuple[Shape, ...]]
    phalanx: tuple[Shape, ...]
    lamps: tuple[LampFigure, ...]


@lru_cache(maxsize=None)
def load_appearance(version: str = "V6") -> Appearance:
    """The looks of a robot version, read once; the lamps carry the LED names of that version.

    Raises:
        ConfigError: If the file has a wrong, unknown or missing entry.
    """
    tables = check_keys(read_json(config_file(FILE)), FILE, ("_meta", "materials", "links", "lamps"))
    materials = {
        name: tuple(vector(color, f"{FILE}: materials.{name}").tolist()) for name, color in tables["materials"].items()
    }
    if OFF not in materials:
        raise ConfigError(f"{FILE}: materials", f"missing {OFF!r}")
    authored = {
        name: tuple(_seen_shape(entry, f"{FILE}: links.{name}[{i}]", materials) for i, entry in enumerate(entries))
        for name, entries in tables["links"].items()
    }
    phalanx = authored.pop(PHALANX, ())
    links = {link.name for link in load_model(version).links}
    unknown = sorted(set(authored) - links)
    if unknown:
        raise ConfigError(f"{FILE}: links", f"no link {unknown[0]!r}")
    lamps = _lamp_figures(tables["lamps"], load_leds(version).lamps)
    return Appearance(
        materials=frozen_mapping(materials),
        shapes=frozen_mapping(with_right_side(authored)),
        phalanx=phalanx,
        lamps=tuple(lamps),
    )


def _seen_shape(entry: Any, where: str, materials: Mapping[str, Any]) -> Shape:
    shape = read_shape(entry, where, kinds_known=SEEN_KINDS)
    if shape.material not in materials:
        raise ConfigError(f"{where}.material", f"is {shape.material!r} (allowed: {', '.join(materials)})")
    return shape


def _lamp_figures(tables: Any, lamps: tuple[Lamp, ...]) -> list[LampFigure]:
    where = f"{FILE}: lamps"
    check_keys(tables, where, ("eye", "ear", "brain", "chest", "foot"))
    figures = []
    for lamp in lamps:
        entry = tables[lamp.part]
        here = f"{where}.{lamp.part}"
        if lamp.part in ("eye", "ear"):
            shape, link = _on_ring(entry, lamp.angle, here)
        elif lamp.part == "brain":
            shape, link = _brain(entry, lamp, here)
        else:
            shape, link = read_shape(entry, here, ("link",), SEEN_KINDS), entry["link"]
        if lamp.side == "Right":
            shape = shape.mirrored()
            link = "R" + link[1:] if link.startswith("L") else link
        figures.append(LampFigure(lamp, link, replace(shape, material=OFF)))
    return figures


def _on_ring(entry: Any, angle: float, where: str) -> tuple[Shape, str]:
    """One piece of a ring whose frame has X outwards and Z up; angles count from Z towards -Y."""
    ring = read_shape(entry, where, ("link",), ("arc",))
    outwards = rpy_matrix(ring.rpy)
    turn = math.radians(angle)
    middle = math.cos(turn) * outwards[:, 2] - math.sin(turn) * outwards[:, 1]
    normal = outwards[:, 0]
    rotation = np.stack([middle, np.cross(normal, middle), normal], axis=1)
    return replace(ring, rpy=matrix_rpy(rotation)), entry["link"]


def _brain(entry: Any, lamp: Lamp, where: str) -> tuple[Shape, str]:
    """One light of the head: places are listed from the rear to the front of the left side."""
    check_keys(entry, where, ("link", "sphere", "places"))
    left_angle = lamp.angle if lamp.side == "Left" else 360.0 - lamp.angle
    number = round((left_angle - 195.0) / 30.0)
    if len(entry["places"]) != 6:
        raise ConfigError(f"{where}.places", f"has {len(entry['places'])} places, not 6")
    return read_shape({"sphere": entry["sphere"], "xyz": entry["places"][number]}, where), entry["link"]
