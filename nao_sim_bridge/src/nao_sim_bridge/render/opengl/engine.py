"""Draws with OpenGL: shadow maps, things, floor and sky, light around lamps."""

from __future__ import annotations

import math
from typing import Any

import moderngl
import numpy as np

from nao_sim_bridge.model.appearance import load_appearance
from nao_sim_bridge.model.model_reader import load_model
from nao_sim_bridge.render.opengl.geometry import POSITION_FORMAT, VERTEX_FORMAT, VERTEX_NAMES
from nao_sim_bridge.render.opengl.items import Items, spheres_in_sight
from nao_sim_bridge.render.opengl.looks import STEPS
from nao_sim_bridge.render.opengl.resources import Canvases, Textures, open_context
from nao_sim_bridge.render.opengl.scene_block import BLOCK, camera_block, world_constants
from nao_sim_bridge.render.opengl.shaders import sources
from nao_sim_bridge.render.opengl.shadow_map import ShadowMap
from nao_sim_bridge.render.scene.figure import CORE_WHITE
from nao_sim_bridge.render.scene.view import NEAR, View
from nao_sim_bridge.world.render_state import RenderState
from nao_sim_bridge.world.world import World

STILL_PIXELS, MOVING_PIXELS = 1024, 512
SOFTNESS = 1.5
"""Distance of the samples of a shadow's edge, in pixels of its map."""
MOVING_REACH = 3.5
"""What moves throws a shadow when it is as near to the robot, m."""
STILL_REACH = 8.0
"""What stands still, when it is as near to the origin of the world, m."""
UNSEEN = 0.5
"""Pixels by which the outline of what is round may be off."""
ENOUGH_UP_TO = [UNSEEN / (1.0 - math.cos(math.pi / steps)) for steps in reversed(STEPS[1:])]
"""Radius in pixels up to which few steps around it are enough, the fewest first."""
CLIP_DISTANCE_0 = 0x3000
ROWS = ("row_x", "row_y", "row_z", "glow")
HALO_SIZE, HALO_LIGHT = 2.6, 0.4
"""Of the light around a lamp: its radius in radii of the lamp, and its strength."""


class OpenGLEngine:
    """Draws a world with robots; one thread only.

    Raises:
        SimulationError: OpenGL cannot be had here.
    """

    def __init__(self, world: World, version: str) -> None:
        self._world = world
        self._model, self._appearance = load_model(version), load_appearance(version)
        self._context = context = open_context()
        self.name = f"OpenGL: {context.info['GL_RENDERER']}"
        constants = world_constants(world)
        self._normal, lamp = constants["UP"], constants["LAMP"]
        self._still = ShadowMap(context, STILL_PIXELS, lamp)
        self._moving = ShadowMap(context, MOVING_PIXELS, lamp)
        constants.update(STILL_APART=SOFTNESS / STILL_PIXELS, MOVING_APART=SOFTNESS / MOVING_PIXELS)
        self._programs = {name: context.program(*source) for name, source in sources(constants).items()}
        self._scene = context.buffer(reserve=BLOCK.itemsize)
        self._still_of: bytes | None = None
        self._moving_of: bytes | None = None
        self._textures = Textures(context)
        self._canvases = Canvases(context)
        self._sky = context.vertex_array(self._programs["backdrop"], [])
        self._buffers: list[Any] = []
        self._items: Items | None = None
        self._items_of: tuple = ()

    def close(self) -> None:
        self._context.release()

    def draw(self, state: RenderState, view: View) -> np.ndarray:
        """The (h, w, 3) uint8 picture of a state; the caller may write into it."""
        with self._context:  # there may be others in this process
            return self._draw(state, view)

    def _draw(self, state: RenderState, view: View) -> np.ndarray:
        items = self._items_for(state)
        items.show(state)
        context = self._context
        context.disable_direct(CLIP_DISTANCE_0)
        context.enable_only(moderngl.DEPTH_TEST | moderngl.CULL_FACE)
        self._rows.write(np.concatenate([items.matrices.reshape(-1, 12), items.glow], axis=1).tobytes())
        centers = items.centers()
        self._cast(items, centers, np.array(state.base_position), view.shadows)
        block = camera_block(view, self._normal, self._still.matrix, self._moving.matrix)
        self._scene.write(block.tobytes())
        self._scene.bind_to_uniform_block(0)
        self._still.texture.use(0)
        self._moving.texture.use(1)
        canvas = self._canvases.get(view.width, view.height, view.samples)
        canvas.begin()
        self._draw_things(items, centers, view)
        self._draw_backdrop()
        self._draw_halos(items, centers, view)
        return canvas.read()

    # --- what there is --------------------------------------------------------------------------------------------

    def _items_for(self, state: RenderState) -> Items:
        """The items for what a state has; their buffers are made anew when something was placed or removed."""
        wanted = (state.placed, len(state.others))
        if self._items is None or wanted != self._items_of:
            self._items = Items(self._world, state.placed, 1 + len(state.others), self._model, self._appearance)
            self._items_of = wanted
            self._upload(self._items)
            self._still_of = self._moving_of = None
        return self._items

    def _upload(self, items: Items) -> None:
        context = self._context
        for buffer in self._buffers:
            buffer.release()
        vertices, indices = items.buffers(context)
        count = len(items.radii)
        self._rows = context.buffer(reserve=64 * count)
        self._commands = context.buffer(reserve=20 * count)
        rows = (self._rows, "4f 4f 4f 4f/i", *ROWS)

        def drawing(program: Any) -> Any:
            parts = [(vertices, VERTEX_FORMAT, *VERTEX_NAMES), rows]
            return context.vertex_array(program, parts, indices, skip_errors=True)

        self._plain, self._with_picture = (drawing(self._programs[name]) for name in ("thing", "covered"))
        places = (self._rows, "4f 4f 4f 16x/i", *ROWS[:3])
        parts = [(vertices, POSITION_FORMAT, "position"), places]
        self._distances = context.vertex_array(self._programs["depth"], parts, indices)
        self._glows = context.buffer(reserve=28 * count)
        self._halos = context.vertex_array(self._programs["halo"], [(self._glows, "4f 3f/i", "place", "light")])
        drawings = [self._plain, self._with_picture, self._distances, self._halos]
        self._buffers = [*drawings, vertices, indices, self._rows, self._commands, self._glows]
        self._textures.keep(items.picture_list)

    # --- shadows --------------------------------------------------------------------------------------------------

    def _cast(self, items: Items, centers: np.ndarray, robot: np.ndarray, shadows: bool) -> None:
        """Draw what the lamp sees, as far as it has changed; nothing, if there are to be no shadows."""
        casts = items.casts & items.visible & shadows
        still = casts & items.still & (np.linalg.norm(centers, axis=1) - items.radii < STILL_REACH)
        moving = casts & ~items.still & (np.linalg.norm(centers - robot, axis=1) < MOVING_REACH)
        if still.tobytes() != self._still_of:
            self._draw_map(self._still, items, centers, np.flatnonzero(still))
            self._still_of = still.tobytes()
        key = moving.tobytes() + items.matrices[moving].tobytes()
        if key != self._moving_of:
            self._draw_map(self._moving, items, centers, np.flatnonzero(moving))
            self._moving_of = key

    def _draw_map(self, shadow: ShadowMap, items: Items, centers: np.ndarray, chosen: np.ndarray) -> None:
        if len(chosen) == 0:
            shadow.clear()
            return
        self._programs["depth"]["to_map"].write(
            shadow.fit(centers[chosen], items.radii[chosen]).T.astype("f4").tobytes()
        )
        self._context.front_face = "ccw"
        shadow.begin()
        self._commands.write(items.commands(chosen, -1).tobytes())
        self._distances.render_indirect(self._commands, moderngl.TRIANGLES, len(chosen))
        shadow.end()

    # --- the picture ----------------------------------------------------------------------------------------------

    def _draw_things(self, items: Items, centers: np.ndarray, view: View) -> None:
        seen = (centers - view.eye) @ view.axes.T
        chosen = items.visible & spheres_in_sight(seen, items.radii, view.tangents, NEAR)
        if view.from_head:
            chosen &= ~items.of_head
        order = np.flatnonzero(chosen)
        # Things of one picture together, and the near before the far, so that what is hidden costs little.
        order = order[np.lexsort((seen[order, 2], items.pictures[order]))]
        # The radius of what is seen of them, in pixels.
        size = items.radii[order] / np.maximum(seen[order, 2], NEAR) * (view.height / 2.0 / view.tangents[1])
        levels = len(STEPS) - 1 - np.searchsorted(ENOUGH_UP_TO, size)
        self._commands.write(items.commands(order, levels).tobytes())
        context = self._context
        context.front_face = "cw"  # the picture is upside down for OpenGL
        context.enable_direct(CLIP_DISTANCE_0)
        numbers, starts, counts = np.unique(items.pictures[order], return_index=True, return_counts=True)
        for number, start, count in zip(numbers, starts.tolist(), counts.tolist()):
            drawing = self._plain
            if number >= 0:
                drawing = self._with_picture
                self._textures.use(items.picture_list[number], 2)
            drawing.render_indirect(self._commands, moderngl.TRIANGLES, count, first=start)
        context.disable_direct(CLIP_DISTANCE_0)

    def _draw_backdrop(self) -> None:
        self._context.depth_func = "<="
        self._context.disable(moderngl.CULL_FACE)
        self._sky.render(moderngl.TRIANGLES, vertices=3)
        self._context.depth_func = "<"

    def _draw_halos(self, items: Items, centers: np.ndarray, view: View) -> None:
        lit = items.visible & (items.glow[:, 3] > 0.0)
        if view.from_head:
            lit &= ~items.of_head
        lit = np.flatnonzero(lit)
        if len(lit) == 0:
            return
        size = HALO_SIZE * items.radii[lit, None]
        # Only the core of the lamp is nearly white.
        light = (items.glow[lit, :3] - CORE_WHITE).clip(0.0) * items.glow[lit, 3:] * HALO_LIGHT
        self._glows.write(np.concatenate([centers[lit], size, light], axis=1).astype("f4").tobytes())
        context = self._context
        context.enable(moderngl.BLEND)
        context.fbo.depth_mask = False
        # Screen blending: bright stays below one and keeps its colour.
        context.blend_func = moderngl.ONE_MINUS_DST_COLOR, moderngl.ONE
        self._halos.render(moderngl.TRIANGLE_STRIP, vertices=4, instances=len(lit))
        context.fbo.depth_mask = True
        context.disable(moderngl.BLEND)
