"""Numbers of the detectors, from `config/vision.json`."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Tuple

from nao_sim_bridge.base.config import config_file, read_settings

FILE = "vision.json"


@dataclass(frozen=True)
class BallSettings:
    """What a red ball is; the file has the meanings. Radii in rad."""

    redness: Tuple[float, float]
    dark: float
    least_pixels: int
    most_candidates: int
    rays: int
    edges: float
    roundness: Tuple[float, float]
    filled: float
    arc: float
    least_cut: float
    least_radius: float
    most_radius: float


@dataclass(frozen=True)
class LandmarkSettings:
    """What a landmark is; the file has the meanings. Diameters in pixels."""

    levels: Tuple[float, float, int]
    least_diameter: float
    least_ratio: float
    roundness: Tuple[float, float]
    rim: float
    contrast: float
    likeness: float
    lead: float


@dataclass(frozen=True)
class VisionSettings:
    """All of the file."""

    ball: BallSettings
    landmarks: LandmarkSettings


@lru_cache(maxsize=None)
def load_vision() -> VisionSettings:
    """The settings of the package; a ConfigError when the file does not hold what it should."""
    return read_settings(VisionSettings, config_file(FILE), ["_note", "_note"])
