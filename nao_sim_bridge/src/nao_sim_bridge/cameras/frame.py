"""Frames of a camera: as they fall due, are asked for, and are given."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Callable, Mapping, Tuple, Union

import numpy as np

from nao_sim_bridge.base.errors import SimulationError
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.world.render_state import RenderState

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


Answer = Union[Frame, Exception]


class CameraClosed(SimulationError):
    """A stream, or all cameras, were closed while somebody waited for a frame."""


class Ask:
    """Somebody waits for a frame: `callback` is called once, with it or with an error."""

    def __init__(self, callback: Callable[[Answer], None]) -> None:
        self._callback: Callable[[Answer], None] | None = callback
        self.given_up = False

    @property
    def answered(self) -> bool:
        """Whether the callback has been called, or is about to be."""
        return self._callback is None

    def take_callback(self) -> Callable[[Answer], None]:
        """The callback, to be called; it can be had once: what it belongs to need not be kept."""
        callback, self._callback = self._callback, None
        return callback


@dataclass(frozen=True, eq=False)
class Moment:
    """A frame that falls due and has not been drawn: what is kept of its tick.

    Attributes:
        number: Counts the frames of the camera.
        snapshot: What was sensed.
        state: What there was to see.
        parameters: Settings of the camera, by NAOqi's id; never changed, only replaced.
        noise: Seed of the noise; equal runs have equal noise, after a reset as well.
        replaced_by: (h, w, 3) uint8 RGB that the camera sees instead of the world; None for the world.
    """

    camera: int
    number: int
    snapshot: Snapshot
    state: RenderState
    parameters: Mapping[int, int]
    noise: int
    replaced_by: np.ndarray | None = None

    @property
    def time(self) -> float:
        """Simulated time, s."""
        return self.snapshot.time
