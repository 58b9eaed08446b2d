"""From where a film is taken: the named views of pictures, but they follow the robot as a calm cameraman does."""

from __future__ import annotations

import math
from dataclasses import replace

from nao_sim_bridge.base.rotations import Vector3
from nao_sim_bridge.model.robot_model import RobotModel
from nao_sim_bridge.world.render_state import PRESETS, Camera, RenderState, preset_camera

CALM = 0.8
"""Time constant with which the camera follows the robot, s: steps and sway do not shake the picture."""
EYE_LEVEL = 0.3
"""Height of the torso of a standing robot, m. The camera stays there when the robot sits down."""


class FilmCamera:
    """A camera that keeps the robot in view, by the name of a view of `PRESETS`.

    Views of the body look from the side where the robot was ahead of them at the first frame, and move with it over
    the floor; they neither turn nor bob with it. Other views are those of pictures.

    Raises:
        UnknownName: There is no such view; when the first camera is asked for.
    """

    def __init__(self, view: str, model: RobotModel, width: int, height: int, supersampling: int) -> None:
        self._view = view
        self._model = model
        self._size = (width, height, supersampling)
        self._first: Camera | None = None
        self._origin = self._at = (0.0, 0.0)
        self._time = 0.0

    def at(self, time: float, state: RenderState) -> Camera:
        """The camera of a frame at a time in s, which rises from call to call."""
        if self._view not in PRESETS or PRESETS[self._view].follows != "body":
            return preset_camera(self._view, self._model, state, *self._size)
        x, y, _ = state.base_position
        if self._first is None:
            level = replace(state, base_position=(x, y, EYE_LEVEL))
            self._first = preset_camera(self._view, self._model, level, *self._size)
            self._origin = self._at = (x, y)
        else:
            share = 1.0 - math.exp(-max(0.0, time - self._time) / CALM)
            self._at = (self._at[0] + share * (x - self._at[0]), self._at[1] + share * (y - self._at[1]))
        self._time = time
        dx, dy = self._at[0] - self._origin[0], self._at[1] - self._origin[1]
        return replace(self._first, eye=_moved(self._first.eye, dx, dy), target=_moved(self._first.target, dx, dy))


def _moved(point: Vector3, dx: float, dy: float) -> Vector3:
    return (point[0] + dx, point[1] + dy, point[2])
