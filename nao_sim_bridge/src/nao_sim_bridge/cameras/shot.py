"""One picture that a camera is to take: from where, and with which settings. A small value for another process."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Mapping

from nao_sim_bridge.base.rotations import Quaternion, Vector3


@dataclass(frozen=True)
class Shot:
    """What a camera of the robot is asked for.

    Attributes:
        version: Robot version: what the numbers of the parameters mean.
        camera: Index, 0 top, 1 bottom.
        position: Of the camera in world, m.
        orientation: Of the camera in world, quaternion (x, y, z, w); X along the optical axis, Y left, Z up.
        hfov: Horizontal field of view, rad.
        vfov: Vertical field of view, rad.
        color_space: NAOqi's id.
        parameters: Settings of the camera, by NAOqi's id; what is not there is at its default.
    """

    version: str
    camera: int
    position: Vector3
    orientation: Quaternion
    hfov: float
    vfov: float
    width: int
    height: int
    color_space: int
    parameters: Mapping[int, int] = field(default_factory=dict)
    seed: int = 0
