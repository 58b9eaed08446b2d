"""A PyBullet window that mirrors states which come over a pipe."""

from __future__ import annotations

import time
from multiprocessing.connection import Connection

import pybullet

from nao_sim_bridge.sim.appearance import load_appearance
from nao_sim_bridge.sim.errors import SimulationError
from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.render.figure import Figure
from nao_sim_bridge.sim.render.scene import RenderState
from nao_sim_bridge.sim.world import World
from nao_sim_bridge.sim.world_builder import build_world

PERIOD = 1.0 / 30.0


class Window:
    """The window and the robot in it; one thread only.

    Args:
        pipe: Where ("show", state) comes from.
        world: Floor and objects.
        version: Robot version.

    Raises:
        SimulationError: If the window does not open.
    """

    def __init__(self, pipe: Connection, world: World, version: str) -> None:
        self._pipe = pipe
        self._client = pybullet.connect(pybullet.GUI)
        if self._client < 0:
            raise SimulationError("PyBullet could not open a window on this display")
        pybullet.configureDebugVisualizer(pybullet.COV_ENABLE_GUI, 0, physicsClientId=self._client)
        pybullet.configureDebugVisualizer(pybullet.COV_ENABLE_RENDERING, 0, physicsClientId=self._client)
        self._objects = build_world(world, self._client, visual=True)
        self._figure = Figure(self._client, load_model(version), load_appearance(version), paint_lamps=True)
        pybullet.resetDebugVisualizerCamera(0.85, 60.0, -14.0, (0.0, 0.0, 0.28), physicsClientId=self._client)
        lamp = [5.0 * part for part in world.light.direction]
        pybullet.configureDebugVisualizer(lightPosition=lamp, physicsClientId=self._client)
        pybullet.configureDebugVisualizer(pybullet.COV_ENABLE_RENDERING, 1, physicsClientId=self._client)

    def serve(self) -> None:
        """Show what comes, at most thirty times a second, until the pipe or the window is closed."""
        while pybullet.isConnected(self._client):
            # Without news, look now and then whether somebody has closed the window.
            if not self._pipe.poll(PERIOD):
                continue
            _, state = self._pipe.recv()
            began = time.monotonic()
            self._show(state)
            time.sleep(max(0.0, PERIOD - (time.monotonic() - began)))
            self._pipe.send(("shown", None))

    def _show(self, state: RenderState) -> None:
        self._figure.show(state)
        for name, pose in state.objects.items():
            pybullet.resetBasePositionAndOrientation(
                self._objects[name], pose.position, pose.orientation, physicsClientId=self._client
            )
