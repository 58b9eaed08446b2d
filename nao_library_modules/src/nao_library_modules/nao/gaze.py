"""Where the head has to turn so that a camera looks at a point. Pure."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from functools import lru_cache

from ..base.paths import config_file

FILE = "head.json"


@dataclass(frozen=True)
class CameraMount:
    """A camera on the head."""

    ahead: float  # of the head's pitch axis, m, the head level
    above: float  # that axis, m
    down: float  # angle below the head's X axis that it looks at, rad


@dataclass(frozen=True)
class Head:
    height: float  # of the pitch axis above the torso's origin, m
    cameras: dict[str, CameraMount]


@lru_cache(maxsize=None)
def load_head() -> Head:
    content = json.loads(config_file(FILE).read_text(encoding="utf-8"))
    cameras = {name: CameraMount(**mount) for name, mount in content["cameras"].items()}
    return Head(content["height"], cameras)


def look_at(head: Head, camera: CameraMount, point: tuple[float, float, float]) -> tuple[float, float]:
    """Head angles that bring a point into the middle of a camera's picture.

    `point`: in the torso frame, m. Returns HeadYaw and HeadPitch, rad. Raises ValueError if the point is in the head.
    """
    x, y, z = point
    ahead, above = math.hypot(x, y), z - head.height
    distance = math.hypot(ahead, above)
    # How far the line of sight passes above the pitch axis, whatever the pitch.
    offset = camera.above * math.cos(camera.down) + camera.ahead * math.sin(camera.down)
    if distance <= abs(offset):
        raise ValueError(f"{distance:.3f} m from the neck is inside the head")
    yaw = math.atan2(y, x) if ahead > 0.0 else 0.0
    return yaw, math.asin(offset / distance) - math.atan2(above, ahead) - camera.down
