#!/usr/bin/env python3
"""Times frames of the robot's camera against a bare getCameraImage of the same room, robot and size.

Ours is all that a frame takes: the snapshot goes to the process that draws, is drawn with shadows, goes through the
camera's sensor, and comes back as bytes. Prints JSON: `ours` and `reference`, s of each frame.
"""

from __future__ import annotations

import math
import sys

from nao_benchmarks.errors import BenchmarkError
from nao_benchmarks.printing import print_times
from nao_benchmarks.stats import interleave

from nao_sim_bridge.base.engine import Engine
from nao_sim_bridge.cameras.darkroom import CameraPlaces
from nao_sim_bridge.cameras.optics import CameraOptics
from nao_sim_bridge.core.simulation import Scene, Simulation
from nao_sim_bridge.model.kinematics import quaternion_matrix
from nao_sim_bridge.render.scene.stage import Stage
from nao_sim_bridge.world.reader import load_world

WORLD = "lab"
RESOLUTIONS = {"320x240": 1, "640x480": 2}
RGB, TOP, RATE = 11, 0, 30
NEAR, FAR = 0.02, 30.0
WARM_UP = 5
PATIENCE = 60.0


class Bare:
    """PyBullet's own picture of the room and the robot, seen from the robot's top camera.

    Args:
        simulation: What is to be seen.
        width: Pixels.
        height: Pixels.
    """

    def __init__(self, simulation: Simulation, width: int, height: int) -> None:
        self._engine = engine = Engine()
        self._size = (width, height)
        state = simulation.render_state()
        world = load_world(WORLD)
        stage = Stage(world, simulation.scene.version, engine, floor=True, paint_lamps=False)
        stage.show(state, headless=True)
        eye, orientation = CameraPlaces(simulation.model).in_world(state, TOP)
        axes = quaternion_matrix(orientation)
        self._view = engine.computeViewMatrix(eye, axes[:, 0] + eye, axes[:, 2])
        vfov = math.degrees(CameraOptics(simulation.scene.version, TOP).vfov)
        self._projection = engine.computeProjectionMatrixFOV(vfov, width / height, NEAR, FAR)

    def take(self) -> None:
        """One picture."""
        engine = self._engine
        engine.getCameraImage(*self._size, self._view, self._projection, renderer=engine.ER_TINY_RENDERER, shadow=1)

    def close(self) -> None:
        """Free the engine."""
        self._engine.disconnect()


def time_frames(rounds: int, size: str) -> dict[str, list[float]]:
    """Alternate frames of both kinds.

    Raises:
        BenchmarkError: If a frame is not a new one.
    """
    simulation = Simulation(Scene(world=WORLD, posture="Stand"))
    resolution = simulation.cameras.tables.resolution(RESOLUTIONS[size])
    bare = Bare(simulation, resolution.width, resolution.height)
    stream = simulation.cameras.open("benchmark", TOP, resolution.id, RGB, RATE)
    due = round(1.0 / (RATE * simulation.settings.tick_s))
    numbers: list[int] = []

    def take() -> None:
        numbers.append(stream.take(PATIENCE).number)

    def prepared() -> None:
        """Time passes outside of what is timed: before the bare picture's turn, and after it."""
        for _ in range(due):
            simulation.tick()

    try:
        prepared()
        take()
        ours: list[float] = []
        reference: list[float] = []
        for turn in range(-WARM_UP, rounds):
            prepared()
            mine, other = interleave([take, bare.take], 1)
            if turn >= 0:
                ours += mine.seconds
                reference += other.seconds
    finally:
        simulation.close()
        bare.close()
    if len(set(numbers)) < len(numbers):
        raise BenchmarkError("a frame was taken twice")
    return {"ours": ours, "reference": reference}


if __name__ == "__main__":
    sys.exit(print_times(time_frames, __doc__, 60, ("--size", {"choices": RESOLUTIONS, "default": "320x240"})))
