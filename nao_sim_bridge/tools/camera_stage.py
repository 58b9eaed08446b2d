"""Pictures of chosen things from chosen places, drawn and developed as those of the robot's cameras are."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any, Mapping, Sequence

import numpy as np

from nao_sim_bridge.base.rotations import from_roll_pitch_yaw
from nao_sim_bridge.cameras.optics import CameraOptics
from nao_sim_bridge.cameras.sensor import Shot, read_photograph
from nao_sim_bridge.model.kinematics import quaternion_matrix
from nao_sim_bridge.model.leds_layout import load_leds
from nao_sim_bridge.model.model_reader import load_model
from nao_sim_bridge.model.postures import posture
from nao_sim_bridge.render.client import Renderer
from nao_sim_bridge.world.objects import read_object
from nao_sim_bridge.world.render_state import RenderState
from nao_sim_bridge.world.world import WorldObject

BGR = 13
QVGA, VGA = (320, 240), (640, 480)
EYES = (-0.6, -1.6, 0.47)
"""Where the camera is in the lab, m: a standing robot's, with four metres of floor and a rug ahead."""
AHEAD = math.pi / 2.0
"""Heading of a camera there that looks along the free floor, rad."""
OUT_OF_SIGHT = (-60.0, 0.0, 0.3)
"""Where the robot is whose eyes these are not: a camera stands alone here."""


class Viewpoint:
    """Where a camera is and which way it looks.

    Args:
        position: In world, m.
        heading: Turn about the vertical, rad, to the left.
        pitch: Downwards, rad.
    """

    def __init__(self, position: Sequence[float], heading: float = 0.0, pitch: float = 0.0) -> None:
        self.position = np.array(position, dtype=float)
        self.heading = heading
        self.orientation = from_roll_pitch_yaw(0.0, pitch, heading)
        self._axes = quaternion_matrix(self.orientation)

    def at(self, distance: float, alpha: float, beta: float) -> np.ndarray:
        """(3,) point in world at a distance and in a direction as NAOqi gives it."""
        ray = np.array((1.0, math.tan(alpha), -math.tan(beta)))
        return self.position + self._axes @ (ray * distance / np.linalg.norm(ray))

    def direction_of(self, point: Sequence[float]) -> tuple[float, float]:
        """(alpha, beta), rad, in which a point in world is seen."""
        x, y, z = self._axes.T @ (np.asarray(point) - self.position)
        return math.atan2(y, x), math.atan2(-z, x)


class Stage:
    """A world by its name with things in it, and the upper camera of a robot of that version. To be closed."""

    def __init__(self, world: str = "empty", engine: str = "auto", version: str = "V6") -> None:
        self.optics = CameraOptics(version, 0)
        self._version = version
        self._renderer = Renderer(world, version, engine)
        self._joints = tuple(float(angle) for angle in posture(load_model(version), "Stand"))
        self._leds = (0.0,) * len(load_leds(version).devices)

    def __enter__(self) -> Stage:
        return self

    def __exit__(self, *_: object) -> None:
        self._renderer.close()

    def picture(
        self,
        viewpoint: Viewpoint,
        things: Sequence[WorldObject] = (),
        size: tuple[int, int] = QVGA,
        seed: int = 0,
        parameters: Mapping[int, int] | None = None,
        gone: Sequence[str] = (),
    ) -> np.ndarray:
        """What the camera sees of the world and of `things`.

        Args:
            seed: Of the noise.
            parameters: Of the camera, by NAOqi's id.
            gone: Names of things of the world that are not there.

        Returns:
            (h, w, 3) uint8, blue, green, red.
        """
        state = RenderState(
            OUT_OF_SIGHT, (0.0, 0.0, 0.0, 1.0), self._joints, self._leds, placed=tuple(things), gone=frozenset(gone)
        )
        shot = Shot(
            self._version,
            0,
            tuple(float(value) for value in viewpoint.position),
            viewpoint.orientation,
            *self.optics.fov,
            *size,
            BGR,
            parameters or {},
            seed,
        )
        pixels = read_photograph(self._renderer.capture(state, shot, 60.0)).data
        return np.frombuffer(pixels, np.uint8).reshape(size[1], size[0], 3)


def thing(name: str, position: Sequence[float], **entry: Any) -> WorldObject:
    """A thing as an entry of a world file describes it."""
    position = [float(value) for value in position]
    return read_object({"name": name, "position": position, **entry}, name, Path)
