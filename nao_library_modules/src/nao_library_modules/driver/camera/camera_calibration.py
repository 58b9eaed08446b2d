"""Calibrations of cameras: computed, scaled, and in the YAML of camera_calibration_parsers. No ROS."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any, Tuple

import yaml

from naoqi.errors import NaoError

from ...base.yaml_values import Budget, load_within

Row = Tuple[float, ...]

PLUMB_BOB = "plumb_bob"
NO_DISTORTION = (0.0,) * 5
NO_ROTATION = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
MOST_VALUES, DEEPEST = 1000, 10
"""Of a file: values, and lists in each other."""
SAME_SHAPE = 0.01
"""Share by which width over height may differ between two sizes of the same field of view."""
MATRICES = {
    "camera_matrix": ("k", 3, 3),
    "distortion_coefficients": ("d", 1, None),
    "rectification_matrix": ("r", 3, 3),
    "projection_matrix": ("p", 3, 4),
}
"""Name in the file -> attribute, rows, columns (None: any)."""


@dataclass(frozen=True)
class Calibration:
    """Contents of sensor_msgs/CameraInfo for pictures of one size; matrices row by row, in pixels."""

    width: int
    height: int
    k: Row  # (9,) camera matrix
    d: Row = NO_DISTORTION  # (n,) distortion
    r: Row = NO_ROTATION  # (9,) rectification
    p: Row = ()  # (12,) projection; empty: that of k
    model: str = PLUMB_BOB
    name: str = ""  # of the camera; may be empty

    def __post_init__(self) -> None:
        """Raises NaoError for a wrong number or size."""
        if self.width <= 0 or self.height <= 0:
            raise NaoError(f"a calibration for pictures of {self.width}x{self.height} pixels is none")
        for name, row, count in (("K", self.k, 9), ("R", self.r, 9), ("P", self.p or (0.0,) * 12, 12)):
            if len(row) != count or not all(math.isfinite(each) for each in row):
                raise NaoError(f"{name} of a calibration has {count} finite numbers, not {row}")
        if not (self.k[0] > 0.0 and self.k[4] > 0.0):
            raise NaoError(f"K of a calibration has focal lengths above 0, not {self.k[0]} and {self.k[4]}")
        if not all(math.isfinite(each) for each in self.d):
            raise NaoError(f"D of a calibration has finite numbers, not {self.d}")
        if not self.p:
            fx, skew, cx, _, fy, cy = self.k[:6]
            object.__setattr__(self, "p", (fx, skew, cx, 0.0, 0.0, fy, cy, 0.0, 0.0, 0.0, 1.0, 0.0))


def ideal(width: int, height: int, hfov: float, vfov: float) -> Calibration:
    """A pinhole without distortion; fields of view from edge to edge of the picture, rad."""
    fx, fy = width / 2.0 / math.tan(hfov / 2.0), height / 2.0 / math.tan(vfov / 2.0)
    return Calibration(width, height, (fx, 0.0, width / 2.0, 0.0, fy, height / 2.0, 0.0, 0.0, 1.0))


def scaled(calibration: Calibration, width: int, height: int) -> Calibration:
    """The same for pictures of another size: a NAO's camera has one field of view in all sizes.

    Raises NaoError if width over height differs.
    """
    x, y = width / calibration.width, height / calibration.height
    if abs(x / y - 1.0) > SAME_SHAPE:
        size = f"{calibration.width}x{calibration.height}"
        raise NaoError(f"a calibration for {size} is of no use for {width}x{height}: another shape of the picture")
    factors = (x, y, 1.0)
    k = tuple(value * factors[place // 3] for place, value in enumerate(calibration.k))
    p = tuple(value * factors[place // 4] for place, value in enumerate(calibration.p))
    return replace(calibration, width=width, height=height, k=k, p=p)


def to_yaml(calibration: Calibration) -> str:
    content: dict[str, Any] = {
        "image_width": calibration.width,
        "image_height": calibration.height,
        "camera_name": calibration.name,
        "distortion_model": calibration.model,
    }
    for key, (attribute, rows, columns) in MATRICES.items():
        values = list(getattr(calibration, attribute))
        content[key] = {"rows": rows, "cols": columns or len(values), "data": values}
    return yaml.safe_dump(content, sort_keys=False, default_flow_style=None)


def from_yaml(text: str) -> Calibration:
    """Calibration from the text of a file; raises NaoError if it holds none."""
    try:
        content = load_within(text, Budget(MOST_VALUES, DEEPEST))
    except yaml.YAMLError as error:
        raise NaoError(f"it is no YAML: {error}") from error
    if not isinstance(content, dict):
        raise NaoError("it holds no calibration")
    try:
        width, height = int(content["image_width"]), int(content["image_height"])
        rows = {attribute: _matrix(content, key, columns) for key, (attribute, _, columns) in MATRICES.items()}
    except KeyError as error:
        raise NaoError(f"it has no {error.args[0]}") from error
    except (TypeError, ValueError, OverflowError) as error:
        raise NaoError(f"it holds something else than numbers: {error}") from error
    model = str(content.get("distortion_model", PLUMB_BOB))
    return Calibration(width, height, model=model, name=str(content.get("camera_name", "")), **rows)


def _matrix(content: dict[str, Any], key: str, columns: int | None) -> Row:
    entry = content[key] if key in ("camera_matrix", "distortion_coefficients") else content.get(key)
    if entry is None:
        return NO_ROTATION if columns == 3 else ()
    return tuple(float(each) for each in entry["data"])
