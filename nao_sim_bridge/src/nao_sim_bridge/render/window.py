"""A PyBullet window that mirrors states which come over a pipe, and tells where the mouse is pressed in it."""

from __future__ import annotations

import time
from multiprocessing.connection import Connection

import pybullet

from nao_sim_bridge.base.errors import SimulationError
from nao_sim_bridge.render.pointer import Pointer
from nao_sim_bridge.render.scene.stage import Stage
from nao_sim_bridge.world.render_state import StateReceiver
from nao_sim_bridge.world.world import World

PERIOD = 1.0 / 30.0


class Window:
    """The window and the robot in it; one thread only.

    Args:
        pipe: Where ("show", state) comes from; ("shown", None) and ("pointer", ray or None) go back.

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
        self._pointer = Pointer(self._client)
        self._stage = Stage(world, version, self._client, floor=True, paint_lamps=True)
        pybullet.resetDebugVisualizerCamera(0.85, 60.0, -14.0, (0.0, 0.0, 0.28), physicsClientId=self._client)
        lamp = [5.0 * part for part in world.light.direction]
        pybullet.configureDebugVisualizer(lightPosition=lamp, physicsClientId=self._client)
        pybullet.configureDebugVisualizer(pybullet.COV_ENABLE_RENDERING, 1, physicsClientId=self._client)

    def serve(self) -> None:
        """Show what comes, at most thirty times a second, until the pipe or the window is closed."""
        states = StateReceiver()
        while pybullet.isConnected(self._client):
            for ray in self._pointer.news():
                self._pipe.send(("pointer", ray))
            # Without news, look now and then whether somebody has closed the window.
            if not self._pipe.poll(PERIOD):
                continue
            _, packed = self._pipe.recv()
            began = time.monotonic()
            self._stage.show(states.unpack(packed))
            time.sleep(max(0.0, PERIOD - (time.monotonic() - began)))
            self._pipe.send(("shown", None))
