"""The landmarks that the robot reads: which sectors of which mark are white, from `config/landmarks.json`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from nao_sim_bridge.base.config import check_keys, config_file, read_json, vector
from nao_sim_bridge.base.errors import ConfigError
from nao_sim_bridge.model.robot_model import frozen_mapping

FILE = "landmarks.json"
_KEYS = ("_meta", "sectors", "fan", "margin", "diameter", "marks")
PIXELS, FINER = 512, 3
"""Edge of the picture, and how many rays a pixel has each way: edges are soft."""
BLACK, WHITE = 18.0, 243.0
"""Of printed paper, not of a screen."""


@dataclass(frozen=True, eq=False)
class Landmarks:
    """How marks look: a black disc on a white card, with white fans around its centre.

    Attributes:
        sectors: Equal parts that a disc has; the first begins at the top, the others follow clockwise.
        fan_inner: Inner radius of a fan, as a share of the radius of the disc.
        fan_outer: Outer radius of a fan, likewise.
        margin: White card around the disc, likewise.
        diameter: Of the disc of a mark as it is usually printed, m.
        marks: Number to the sectors that are white.
    """

    sectors: int
    fan_inner: float
    fan_outer: float
    margin: float
    diameter: float
    marks: Mapping[int, tuple[bool, ...]]


@lru_cache(maxsize=None)
def load_landmarks() -> Landmarks:
    """The marks, read once.

    Raises:
        ConfigError: If the file has a wrong, unknown or missing entry.
    """
    table = check_keys(read_json(config_file(FILE)), FILE, _KEYS)
    sectors = int(table["sectors"])
    inner, outer = vector(table["fan"], f"{FILE}: fan", 2)
    if not 0.0 < inner < outer < 1.0:
        raise ConfigError(f"{FILE}: fan", f"is {table['fan']!r}, allowed are two rising numbers in 0..1")
    margin, diameter = vector([table["margin"], table["diameter"]], f"{FILE}: margin and diameter", 2)
    marks = {}
    for number, word in table["marks"].items():
        if len(word) != sectors or set(word) - {"0", "1"}:
            raise ConfigError(f"{FILE}: marks.{number}", f"is {word!r}, not {sectors} of 0 and 1")
        marks[int(number)] = tuple(digit == "1" for digit in word)
    return Landmarks(sectors, float(inner), float(outer), float(margin), float(diameter), frozen_mapping(marks))


def paint_landmark(number: int) -> np.ndarray:
    """A mark on its card, (512, 512, 3) uint8."""
    table = load_landmarks()
    count = PIXELS * FINER
    line = (np.arange(count) + 0.5) / count * 2.0 - 1.0
    x, down = np.meshgrid(line * (1.0 + table.margin), line * (1.0 + table.margin))
    radius = np.hypot(x, down)
    clockwise = np.arctan2(x, -down) % (2.0 * np.pi)
    sector = np.minimum((clockwise / (2.0 * np.pi) * table.sectors).astype(int), table.sectors - 1)
    fans = np.array(table.marks[number])[sector] & (radius > table.fan_inner) & (radius < table.fan_outer)
    white = (radius > 1.0) | fans
    shade = np.where(white, WHITE, BLACK).reshape(PIXELS, FINER, PIXELS, FINER).mean(axis=(1, 3))
    return np.repeat(shade.astype(np.uint8)[..., None], 3, axis=2)
