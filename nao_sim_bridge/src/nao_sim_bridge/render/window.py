"""A PyBullet window that mirrors states which come over a pipe, and tells where the mouse is pressed in it."""

from __future__ import annotations

import time
from multiprocessing.connection import Connection
from typing import NamedTuple, Sequence

import numpy as np

from nao_sim_bridge.base.engine import Engine
from nao_sim_bridge.base.errors import SimulationError
from nao_sim_bridge.base.rotations import Vector3, vector3
from nao_sim_bridge.render.scene.stage import Stage
from nao_sim_bridge.world.render_state import StateReceiver
from nao_sim_bridge.world.world import World

# PyBullet's mouse events: kind and columns.
BUTTON_EVENT, KIND, X, Y, BUTTON, STATE = 2, 0, 1, 2, 3, 4
MOVE_EVENT, LEFT_BUTTON = 1, 0
# With these keys the mouse turns the camera.
CAMERA_KEYS = ("B3G_CONTROL", "B3G_ALT")
# Columns of PyBullet's debug camera.
WIDTH, HEIGHT, VIEW, PROJECTION = 0, 1, 2, 3
PERIOD = 1.0 / 30.0


class Ray(NamedTuple):
    """A line of sight: where it begins, m, and its unit vector, in world."""

    eye: Vector3
    direction: Vector3


def ray_through(view: Sequence[float], projection: Sequence[float], x: float, y: float) -> Ray:
    """The line of sight through a point of a picture.

    Args:
        view: (16,) OpenGL's matrix from world to camera, column by column.
        projection: (16,) OpenGL's matrix from camera to clip space, column by column.
        x: 0 at the left edge, 1 at the right one.
        y: 0 at the upper edge, 1 at the lower one.
    """
    to_camera, to_clip = (np.asarray(matrix, dtype=float).reshape(4, 4).T for matrix in (view, projection))
    to_world = np.linalg.inv(to_clip @ to_camera)
    near, far = (to_world @ (2.0 * x - 1.0, 1.0 - 2.0 * y, depth, 1.0) for depth in (-1.0, 1.0))
    eye = np.linalg.inv(to_camera)[:3, 3]
    direction = far[:3] / far[3] - near[:3] / near[3]
    return Ray(vector3(eye), vector3(direction / np.linalg.norm(direction)))


class Pointer:
    """Follows the left button of the mouse in the window of an engine."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine
        self._down = False
        # Else a click on a body pulls it about.
        engine.configureDebugVisualizer(engine.COV_ENABLE_MOUSE_PICKING, 0)

    def news(self) -> list[Ray | None]:
        """Where the mouse has pointed with its button down since the last call; None when the button went up."""
        told: list[Ray | None] = []
        for event in self._engine.getMouseEvents():
            if event[KIND] == BUTTON_EVENT and event[BUTTON] == LEFT_BUTTON:
                if event[STATE] & self._engine.KEY_WAS_TRIGGERED and not self._turns_camera():
                    self._down = True
                    told.append(self._ray(event[X], event[Y]))
                elif event[STATE] & self._engine.KEY_WAS_RELEASED and self._down:
                    self._down = False
                    told.append(None)
            elif event[KIND] == MOVE_EVENT and self._down:
                told.append(self._ray(event[X], event[Y]))
        return told

    def _turns_camera(self) -> bool:
        keys = self._engine.getKeyboardEvents()
        return any(keys.get(getattr(self._engine, key), 0) & self._engine.KEY_IS_DOWN for key in CAMERA_KEYS)

    def _ray(self, x: float, y: float) -> Ray:
        camera = self._engine.getDebugVisualizerCamera()
        return ray_through(camera[VIEW], camera[PROJECTION], x / camera[WIDTH], y / camera[HEIGHT])


class Window:
    """The window and the robot in it; one thread only.

    Args:
        pipe: Where ("show", state) comes from; ("shown", None) and ("pointer", ray or None) go back.

    Raises:
        SimulationError: If the window does not open.
    """

    def __init__(self, pipe: Connection, world: World, version: str) -> None:
        self._pipe = pipe
        self._engine = Engine(gui=True)
        if self._engine.client < 0:
            raise SimulationError("PyBullet could not open a window on this display")
        self._engine.configureDebugVisualizer(self._engine.COV_ENABLE_GUI, 0)
        self._engine.configureDebugVisualizer(self._engine.COV_ENABLE_RENDERING, 0)
        self._pointer = Pointer(self._engine)
        self._stage = Stage(world, version, self._engine, floor=True, paint_lamps=True)
        self._engine.resetDebugVisualizerCamera(0.85, 60.0, -14.0, (0.0, 0.0, 0.28))
        lamp = [5.0 * part for part in world.light.direction]
        self._engine.configureDebugVisualizer(lightPosition=lamp)
        self._engine.configureDebugVisualizer(self._engine.COV_ENABLE_RENDERING, 1)

    def serve(self) -> None:
        """Show what comes, at most thirty times a second, until the pipe or the window is closed."""
        states = StateReceiver()
        while self._engine.isConnected():
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
