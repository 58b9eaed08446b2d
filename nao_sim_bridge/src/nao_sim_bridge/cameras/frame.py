"""A picture as a camera gives it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Tuple

import numpy as np

Position6D = Tuple[float, float, float, float, float, float]


@dataclass(frozen=True, eq=False)
class Frame:
    """One picture of one camera.

    Attributes:
        time: Simulated time at which it was taken, s.
        camera: Index, 0 top, 1 bottom.
        color_space: NAOqi's id.
        layers: Bytes a pixel.
        data: The pixels, row by row from the upper left corner.
        hfov: Horizontal field of view, rad.
        vfov: Vertical field of view, rad.
        pose_in_torso: Where ALMotion would say the camera was: x, y, z in m, roll, pitch, yaw in rad.
        pose_in_robot: The same in the frame between the feet.
        number: Counts the frames of the camera that fell due.
    """

    time: float
    camera: int
    width: int
    height: int
    color_space: int
    layers: int
    data: bytes
    hfov: float
    vfov: float
    pose_in_torso: Position6D
    pose_in_robot: Position6D
    number: int = 0

    def array(self) -> np.ndarray:
        """(h, w) or (h, w, layers) uint8 view of the pixels, read-only."""
        shape = (self.height, self.width) if self.layers == 1 else (self.height, self.width, self.layers)
        return np.frombuffer(self.data, dtype=np.uint8).reshape(shape)

    @property
    def stamp(self) -> Tuple[int, int]:
        """Seconds and microseconds of `time`."""
        microseconds = round(self.time * 1e6)
        return microseconds // 1000000, microseconds % 1000000
