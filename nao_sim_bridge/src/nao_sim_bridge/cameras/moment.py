"""What is kept of a tick at which a picture falls due: enough to draw it later."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Mapping

import numpy as np

from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.world.render_state import RenderState


@dataclass(frozen=True, eq=False)
class Moment:
    """A frame of a camera that has not been drawn.

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
