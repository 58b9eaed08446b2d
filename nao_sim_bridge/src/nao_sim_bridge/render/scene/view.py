"""How points of the world become points of a picture: a pinhole that both drawing engines share."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from nao_sim_bridge.model.kinematics import quaternion_matrix
from nao_sim_bridge.world.render_state import Camera

if TYPE_CHECKING:
    from nao_sim_bridge.cameras.sensor import Shot

NEAR = 0.02
"""Nearer things are not drawn, m: a camera of the robot looks through the shell in front of it."""

FEW_PIXELS = 160 * 120
"""Pictures of a robot's camera that are no larger have smooth edges: there it matters most and costs least."""


@dataclass(frozen=True, eq=False)
class View:
    """A pinhole camera. Its optical axis meets the middle of the picture; pixel centres are at +0.5.

    Attributes:
        eye: (3,) in world, m.
        axes: (3, 3) rows: to the right, upwards, and forward along the optical axis; unit vectors in world.
        tangents: Of half the horizontal and half the vertical field of view.
        samples: Rays along each edge of a pixel.
        shadows: Whether things throw shadows.
        from_head: The robot's own camera: its head is not drawn, for it would be in the way.
    """

    eye: np.ndarray
    axes: np.ndarray
    tangents: tuple[float, float]
    width: int
    height: int
    samples: int = 1
    shadows: bool = True
    from_head: bool = False

    @classmethod
    def of_camera(cls, camera: Camera) -> View:
        """The view of a camera outside."""
        eye = np.array(camera.eye, dtype=float)
        forward = np.subtract(camera.target, eye)
        forward /= np.linalg.norm(forward)
        right = np.cross(forward, camera.up)
        right /= np.linalg.norm(right)
        tangent = math.tan(camera.fov / 2.0)
        return cls(
            eye,
            np.stack([right, np.cross(right, forward), forward]),
            (tangent * camera.width / camera.height, tangent),
            camera.width,
            camera.height,
            camera.supersampling,
            camera.shadows,
        )

    @classmethod
    def of_shot(cls, shot: Shot) -> View:
        """The view of a robot's camera, whose X axis is the optical axis, Y left and Z up."""
        forward, left, up = quaternion_matrix(shot.orientation).T
        return cls(
            np.array(shot.position, dtype=float),
            np.stack([-left, up, forward]),
            (math.tan(shot.hfov / 2.0), math.tan(shot.vfov / 2.0)),
            shot.width,
            shot.height,
            samples=2 if shot.width * shot.height <= FEW_PIXELS else 1,
            from_head=True,
        )

    @property
    def key(self) -> tuple:
        """Equal for two views that show the same."""
        sizes = (self.width, self.height, self.samples, self.shadows, self.from_head)
        return (self.eye.tobytes(), self.axes.tobytes(), self.tangents, *sizes)

    def rays(self) -> np.ndarray:
        """(h, w, 3) float32 directions in world through the pixel centres, 1 long along the optical axis."""
        right, up, forward = self.axes
        vertical = (1.0 - (2.0 * np.arange(self.height) + 1.0) / self.height) * self.tangents[1]
        horizontal = ((2.0 * np.arange(self.width) + 1.0) / self.width - 1.0) * self.tangents[0]
        rays = forward + vertical[:, None, None] * up + horizontal[None, :, None] * right
        return rays.astype(np.float32)

    def project(self, point: np.ndarray) -> tuple[float, float]:
        """Column and row of a point of the world, in pixels from the upper left corner of the picture."""
        right, up, depth = self.axes @ (np.asarray(point, dtype=float) - self.eye)
        column = (right / depth / self.tangents[0] + 1.0) * self.width / 2.0
        row = (1.0 - up / depth / self.tangents[1]) * self.height / 2.0
        return float(column), float(row)

    def to_camera(self) -> np.ndarray:
        """(4, 4) from world to the camera's frame: X right, Y up, looking along -Z."""
        matrix = np.eye(4)
        matrix[:3, :3] = self.axes * np.array((1.0, 1.0, -1.0))[:, None]
        matrix[:3, 3] = -matrix[:3, :3] @ self.eye
        return matrix
