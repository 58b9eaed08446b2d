"""The robot as bodies of a PyBullet world that are only there to be seen.

Each link is one body a colour, each lamp a body of its own. The engine knows no joints between them: poses
come from forward kinematics, so a picture needs no physics.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from nao_sim_bridge.base.engine import Engine
from nao_sim_bridge.model.appearance import OFF, Appearance
from nao_sim_bridge.model.kinematics import matrix_quaternion
from nao_sim_bridge.model.meshes import Mesh, merged, tessellate
from nao_sim_bridge.model.robot_model import RobotModel
from nao_sim_bridge.model.shapes import Shape
from nao_sim_bridge.world.render_state import RobotLook, frames_in_world
from nao_sim_bridge.world.visible import visual_shape

HEAD = ("HeadYaw", "HeadPitch")
"""Links that are in the way of the cameras in the head."""
CORE_WHITE = 0.12
"""Share of white in the light of a lamp: a saturated colour alone looks like paint, not like light."""
FAR_AWAY = (-713.0, 1291.0, -977.0)
"""Where hidden things are, m. In no straight direction: the engine takes seconds for what a camera has exactly beside
it."""
UNTURNED = (0.0, 0.0, 0.0, 1.0)


@dataclass(frozen=True)
class _Part:
    """A body and the frame it is fixed to: a link name, or side and phalanx as `LFinger11`."""

    body: int
    frame: str


class Figure:
    """The robot in one PyBullet world.

    Attributes:
        lamp_bodies: PyBullet body of each lamp, in the order of the LED layout.
        lamp_light: (51, 3) light that each lamp gives, (r, g, b) in 0..1.

    Args:
        paint_lamps: Change the colour of lamp bodies in the engine. A window needs it; pictures light them up
            later.
    """

    def __init__(self, engine: Engine, model: RobotModel, appearance: Appearance, paint_lamps: bool) -> None:
        self._engine = engine
        self._model = model
        self._appearance = appearance
        self._paint_lamps = paint_lamps
        self._parts = self._build_links()
        self.lamp_bodies = tuple(self._build_lamps())
        self.lamp_light = np.zeros((len(self.lamp_bodies), 3))
        self._posed: tuple = ()
        self._lit: Sequence[float] = ()

    def hide(self) -> None:
        for part in self._parts:
            self._put(part, FAR_AWAY, UNTURNED)
        self.lamp_light = np.zeros_like(self.lamp_light)
        self._posed = self._lit = ()

    def show(self, state: RobotLook, headless: bool = False) -> None:
        """Put all bodies where the state says; what has not changed is left alone."""
        pose = (state.base_position, state.base_orientation, state.joint_positions, headless)
        if pose != self._posed:
            self._place(state, headless)
            self._posed = pose
        if state.led_values != self._lit:
            self._light(state.led_values)
            self._lit = state.led_values

    def _place(self, state: RobotLook, headless: bool) -> None:
        poses = frames_in_world(self._model, state)
        placed = {name: (pose[:3, 3].tolist(), matrix_quaternion(pose[:3, :3])) for name, pose in poses.items()}
        for part in self._parts:
            hidden = headless and part.frame in HEAD
            self._put(part, *((FAR_AWAY, UNTURNED) if hidden else placed[part.frame]))

    def _put(self, part: _Part, position: Sequence[float], orientation: Sequence[float]) -> None:
        self._engine.resetBasePositionAndOrientation(part.body, position, orientation)

    def _light(self, values: Sequence[float]) -> None:
        lamps = self._appearance.lamps
        light = np.array([figure.lamp.rgb(values) for figure in lamps])
        if self._paint_lamps:
            off = np.array(self._appearance.materials[OFF])
            for index in np.flatnonzero(np.any(light != self.lamp_light, axis=1)):
                level = light[index].max()
                color = off * (1.0 - level) + light[index]
                self._engine.changeVisualShape(self.lamp_bodies[index], -1, rgbaColor=[*np.clip(color, 0.0, 1.0), 1.0])
        self.lamp_light = light

    def _build_links(self) -> list[_Part]:
        parts = []
        for name, shapes in self._appearance.shapes.items():
            parts += self._build_frame(name, shapes)
        for side in ("L", "R"):
            for finger in self._model.fingers:
                for phalanx in finger.phalanges:
                    parts += self._build_frame(side + phalanx, self._appearance.phalanx)
        return parts

    def _build_frame(self, frame: str, shapes: Sequence[Shape]) -> list[_Part]:
        parts = []
        for material in dict.fromkeys(shape.material for shape in shapes):
            meshes = [tessellate(shape).placed(shape) for shape in shapes if shape.material == material]
            color = self._appearance.materials[material]
            parts.append(_Part(self._build_body(merged(meshes), color), frame))
        return parts

    def _build_lamps(self) -> list[int]:
        bodies = []
        for figure in self._appearance.lamps:
            mesh = tessellate(figure.shape).placed(figure.shape)
            bodies.append(self._build_body(mesh, self._appearance.materials[OFF]))
            self._parts.append(_Part(bodies[-1], figure.link))
        return bodies

    def _build_body(self, mesh: Mesh, color: Sequence[float]) -> int:
        seen = visual_shape(mesh, color, self._engine)
        return self._engine.createMultiBody(0.0, -1, seen)
