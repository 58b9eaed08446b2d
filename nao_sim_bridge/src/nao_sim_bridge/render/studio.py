"""Takes pictures: a PyBullet world with the robot and the objects of a world, a lamp and a camera."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from nao_sim_bridge.base.engine import Engine
from nao_sim_bridge.render.backdrop import Backdrop, Shadow, blur
from nao_sim_bridge.render.scene.figure import CORE_WHITE
from nao_sim_bridge.render.scene.stage import Stage
from nao_sim_bridge.render.scene.view import NEAR, View
from nao_sim_bridge.world.builder import build_world
from nao_sim_bridge.world.render_state import RenderState
from nao_sim_bridge.world.world import FLOOR, World

FAR = 30.0
LIGHT_DISTANCE = 6.0
"""Of the lamp for the shadows of things on each other, m; nearer, it leaves edges in rooms."""
LAMP_DISTANCE = 15.0
"""Of the lamp that throws the shadow, m; far enough for straight rays."""
SHADOW_REACH = 0.75
"""Half the width of what the lamp sees around the robot, m."""
SHADOW_PIXELS = 192
MOST_SHADOW_PIXELS = 384
STILL_REACH, STILL_PIXELS = 5.0, 1024
"""As both above, for the shadow of what never moves, around the origin of the world."""
DIFFUSE, SPECULAR = 0.62, 0.12
GLOW = 0.9


class Studio:
    """Where pictures are taken; one thread only."""

    name = "the built-in renderer (PyBullet's TinyRenderer)"

    def __init__(self, world: World, version: str) -> None:
        self._world = world
        self._engine = Engine()
        # The floor is drawn as part of the backdrop.
        self._stage = Stage(world, version, self._engine, floor=False, paint_lamps=False)
        self._backdrop = Backdrop(world)
        self._gone: frozenset[str] | None = None
        self._shadow: Shadow | None = None
        self._shadow_of: RenderState | None = None

    def close(self) -> None:
        self._engine.disconnect()

    def draw(self, state: RenderState, view: View) -> np.ndarray:
        """The (h, w, 3) uint8 picture of a state."""
        if state.gone != self._gone:
            self._backdrop, self._gone = Backdrop(self._world, self._cast_still_shadow(state.gone)), state.gone
        self._stage.show(state)
        shadow = self._floor_shadow(state) if view.shadows else None
        if view.from_head:
            # After the shadow, which has a head.
            self._stage.show(state, headless=True)
        factor = view.samples
        fine = replace(view, width=view.width * factor, height=view.height * factor)
        picture = self._draw(fine, shadow)
        if factor > 1:
            shape = (view.height, factor, view.width, factor, 3)
            picture = picture.reshape(shape).mean(axis=(1, 3))
        return (picture * 255.0 + 0.5).astype(np.uint8)

    def _draw(self, view: View, shadow: Shadow | None) -> np.ndarray:
        """(h, w, 3) float32 picture in 0..1, one ray a pixel."""
        right, top = (NEAR * tangent for tangent in view.tangents)
        # The engine looks through the lower left corner of a pixel, not through its middle.
        aside, up = right / view.width, top / view.height
        light = self._world.light
        colors, bodies = self._capture(
            view.width,
            view.height,
            view.to_camera().T.ravel().tolist(),
            self._engine.computeProjectionMatrix(aside - right, aside + right, up - top, up + top, NEAR, FAR),
            shadow=int(view.shadows),
            lightDirection=light.direction,
            lightDistance=LIGHT_DISTANCE,
            lightColor=light.color,
            lightAmbientCoeff=light.ambient,
            lightDiffuseCoeff=DIFFUSE,
            lightSpecularCoeff=SPECULAR,
        )
        picture = self._backdrop.draw(view, shadow)
        seen = bodies >= 0
        picture[seen] = colors[seen].astype(np.float32) / np.float32(255.0)
        self._light_up(picture, bodies)
        return np.clip(picture, 0.0, 1.0)

    def _capture(
        self,
        width: int,
        height: int,
        view: Sequence[float],
        projection: Sequence[float],
        engine: Engine | None = None,
        **light: object,
    ) -> tuple:
        """Colours (h, w, 3) and body ids (h, w), -1 where nothing is."""
        engine = engine or self._engine
        _, _, rgba, _, bodies = engine.getCameraImage(
            width, height, view, projection, renderer=engine.ER_TINY_RENDERER, **light
        )
        colors = np.asarray(rgba, dtype=np.uint8).reshape(height, width, 4)[..., :3]
        return colors, np.asarray(bodies).reshape(height, width)

    def _light_up(self, picture: np.ndarray, bodies: np.ndarray) -> None:
        """Let lit lamps shine: their pixels take the colour of the light, and some spills around them."""
        figures = self._stage.figures
        light = np.concatenate([figure.lamp_light for figure in figures])
        level = light.max(axis=1)
        if not np.any(level > 0.0):
            return
        table = np.zeros((bodies.max() + 2, 4), dtype=np.float32)
        for body, rgb, strength in zip([lamp for figure in figures for lamp in figure.lamp_bodies], light, level):
            if strength > 0.0 and body + 1 < len(table):
                full = rgb / strength
                table[body + 1, :3] = full * (1.0 - CORE_WHITE) + CORE_WHITE
                table[body + 1, 3] = strength
        rows, columns = np.nonzero(table[:, 3][bodies + 1])
        if len(rows) == 0:
            return
        entry = table[bodies[rows, columns] + 1]
        strength = entry[:, 3:]
        picture[rows, columns] = picture[rows, columns] * (1.0 - strength) + entry[:, :3] * strength
        self._add_glow(picture, rows, columns, entry)

    def _add_glow(self, picture: np.ndarray, rows: np.ndarray, columns: np.ndarray, entry: np.ndarray) -> None:
        """Spill light around lit pixels, within the part of the picture that it can reach."""
        height, width = picture.shape[:2]
        radius = max(1, round(height * 0.006))
        margin = 4 * radius
        top, bottom = max(rows.min() - margin, 0), min(rows.max() + margin + 1, height)
        left, right = max(columns.min() - margin, 0), min(columns.max() + margin + 1, width)
        spill = np.zeros((bottom - top, right - left, 3), dtype=np.float32)
        spill[rows - top, columns - left] = entry[:, :3] * entry[:, 3:]
        spill = blur(spill, radius, passes=3) * np.float32(GLOW)
        part = picture[top:bottom, left:right]
        # Screen blending: bright stays below one and keeps its colour.
        part[...] = 1.0 - (1.0 - np.clip(part, 0.0, 1.0)) * (1.0 - np.clip(spill, 0.0, 1.0))

    def _floor_shadow(self, state: RenderState) -> Shadow:
        """The shadow of everything, drawn again only when something has moved."""
        key = replace(state, led_values=(), objects=dict(state.objects))
        if self._shadow is None or key != self._shadow_of:
            self._shadow, self._shadow_of = self._cast_shadow(state), key
        return self._shadow

    def _cast_still_shadow(self, gone: frozenset[str]) -> Shadow | None:
        """The shadow of what never moves, which is in the world and not gone."""
        still = [thing for thing in self._world.objects if thing.mass == 0.0 and thing.name not in gone]
        if not still and not self._world.floor.bumps:
            return None
        bare = replace(self._world, objects=tuple(still))
        engine = Engine()
        try:
            engine.removeBody(build_world(bare, engine, visual=True)[FLOOR])
            return self._cast(np.zeros(3), STILL_REACH, STILL_PIXELS, engine)
        finally:
            engine.disconnect()

    def _cast_shadow(self, state: RenderState) -> Shadow:
        """The shadow of the robot and of what can be moved near it."""
        x, y, z = state.base_position
        center = np.array((x, y, max(z, 0.0) / 2.0))
        reach = SHADOW_REACH
        for place in (*self._stage.loose(), *(other.base_position for other in state.others)):
            distance = float(np.linalg.norm(place - center))
            if distance < 3.0:
                reach = max(reach, distance + 0.3)
        return self._cast(center, reach, min(round(SHADOW_PIXELS * reach / SHADOW_REACH), MOST_SHADOW_PIXELS))

    def _cast(self, center: np.ndarray, reach: float, pixels: int, engine: Engine | None = None) -> Shadow:
        """What the lamp does not see of the floor within `reach` of a point, m."""
        direction = np.array(self._world.light.direction)
        direction /= np.linalg.norm(direction)
        view = self._engine.computeViewMatrix(center + direction * LAMP_DISTANCE, center, (0.0, 1.0, 0.001))
        angle = 2.0 * math.degrees(math.atan(reach / LAMP_DISTANCE))
        projection = self._engine.computeProjectionMatrixFOV(angle, 1.0, LAMP_DISTANCE - 5.0, LAMP_DISTANCE + 5.0)
        _, bodies = self._capture(pixels, pixels, view, projection, engine, shadow=0)
        to_clip, to_lamp = (np.array(m).reshape(4, 4).T for m in (projection, view))
        return Shadow(bodies >= 0, to_clip @ to_lamp, center[:2], reach)
