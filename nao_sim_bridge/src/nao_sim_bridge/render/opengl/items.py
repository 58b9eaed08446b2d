"""Everything that can be drawn of a world with robots: what it is made of, and where it is in a state."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Sequence

import numpy as np

from nao_sim_bridge.base.errors import UnknownName
from nao_sim_bridge.base.readings import Pose
from nao_sim_bridge.model.appearance import Appearance
from nao_sim_bridge.model.kinematics import quaternion_matrix, transform
from nao_sim_bridge.model.meshes import tessellate
from nao_sim_bridge.model.robot_model import RobotModel
from nao_sim_bridge.model.shapes import Shape
from nao_sim_bridge.render.opengl.geometry import COMMAND, Geometry, Piece
from nao_sim_bridge.render.opengl.looks import STEPS, Look, robot_looks, thing_looks
from nao_sim_bridge.render.scene.figure import CORE_WHITE, HEAD
from nao_sim_bridge.world.builder import heaps_of_bumps, place_of
from nao_sim_bridge.world.pictures import WorldPicture
from nao_sim_bridge.world.render_state import RenderState, RobotLook, frames_in_world
from nao_sim_bridge.world.world import World, WorldObject

RUG = "rug"
"""Frame of the looks of rugs, which throw no shadow."""
RUG_HEIGHT = 0.0002
"""Of each rug over the one before it, m."""
AT_HOME = 0.005
"""A thing that has moved by less is where it was put: m, and of its axes."""


class RobotRows:
    """One robot, at the rows `items` of all; what has not changed is not worked out again."""

    def __init__(self, model: RobotModel, appearance: Appearance, looks: Sequence[Look], items: slice) -> None:
        self._model = model
        self._appearance = appearance
        self._items = items
        self._frames = list(dict.fromkeys(look.frame for look in looks))
        self._frame_of_item = np.array([self._frames.index(look.frame) for look in looks])
        self._lamps = np.array([look.lamp for look in looks])
        self._posed: tuple | None = None
        self._lit: tuple[float, ...] | None = None

    def show(self, look: RobotLook, matrices: np.ndarray, glow: np.ndarray) -> None:
        """Write where its items are, and their light."""
        pose = (look.base_position, look.base_orientation, look.joint_positions)
        if pose != self._posed:
            poses = frames_in_world(self._model, look)
            matrices[self._items] = np.array([poses[frame][:3] for frame in self._frames])[self._frame_of_item]
            self._posed = pose
        if look.led_values != self._lit:
            glow[self._items] = self._light(look.led_values)
            self._lit = look.led_values

    def _light(self, values: Sequence[float]) -> np.ndarray:
        """(items, 4) glow of all items."""
        light = np.zeros((len(self._lamps), 4))
        colors = np.array([figure.lamp.rgb(values) for figure in self._appearance.lamps])
        level = colors.max(axis=1)
        full = colors / np.where(level > 0.0, level, 1.0)[:, None] * (1.0 - CORE_WHITE) + CORE_WHITE
        of_lamp = self._lamps >= 0
        light[of_lamp, :3] = full[self._lamps[of_lamp]]
        light[of_lamp, 3] = level[self._lamps[of_lamp]]
        return light


@dataclass(frozen=True)
class _Thing:
    """A thing and the items that it consists of."""

    name: str
    home: np.ndarray
    items: slice


class Items:
    """All that can be drawn, in arrays with one row an item.

    Attributes:
        matrices: (n, 3, 4) float32 from each item's frame to the world.
        glow: (n, 4) float32 own light (r, g, b), and its share of what is seen.
        visible: (n,) whether it is there.
        still: (n,) whether it is where it was put: then it need not be in the shadow that is drawn each time.
        casts: (n,) whether it throws a shadow.
        of_head: (n,) whether it belongs to the head of the robot itself.
        pictures: (n,) number of the picture on it, -1 for none.
        picture_list: The pictures by number.
    """

    def __init__(
        self, world: World, placed: Sequence[WorldObject], robots: int, model: RobotModel, appearance: Appearance
    ) -> None:
        self._model = model
        self._appearance = appearance
        self._geometry = Geometry()
        self._pieces: list[list[Piece]] = []  # of each item, as `STEPS` says
        self._looks: list[Look] = []
        self._starts: list[np.ndarray] = []
        self._add_ground(world)
        self._things = {thing.name: self._add_thing(thing, world) for thing in world.objects}
        self._placed = {thing.name: self._add_thing(thing, world) for thing in placed}
        first_robot = len(self._looks)
        self._add_robots(robots)
        count = len(self._looks)
        self.matrices = np.array([start[:3] for start in self._starts], dtype="f4")
        self.visible = np.ones(count, dtype=bool)
        self.still = np.arange(count) < first_robot
        self.casts = np.array([look.frame != RUG for look in self._looks])
        self.casts[first_robot:] = [look.lamp < 0 for look in self._looks[first_robot:]]
        self.glow = np.zeros((count, 4), dtype="f4")
        for index, look in enumerate(self._looks):
            if look.shining:
                self.glow[index] = *look.colors, 1.0
        self.picture_list: list[WorldPicture] = list(
            dict.fromkeys(look.picture for look in self._looks if look.picture is not None)
        )
        self.pictures = np.array(
            [-1 if look.picture is None else self.picture_list.index(look.picture) for look in self._looks]
        )
        per_robot = (count - first_robot) // robots
        self.of_head = np.zeros(count, dtype=bool)
        mine = slice(first_robot, first_robot + per_robot)
        self.of_head[mine] = [look.frame in HEAD for look in self._looks[mine]]
        self._robots = [
            RobotRows(model, appearance, self._looks[mine], slice(start, start + per_robot))
            for start in range(first_robot, count, per_robot)
        ]
        self._centers = np.array([levels[0].center for levels in self._pieces])
        self.radii = np.array([levels[0].radius for levels in self._pieces])
        self._commands = np.array(
            [[(p.count, 1, p.first, p.base, row) for p in levels] for row, levels in enumerate(self._pieces)], COMMAND
        )

    def buffers(self, context: Any) -> tuple[Any, Any]:
        return self._geometry.buffers(context)

    def commands(self, chosen: np.ndarray, levels: np.ndarray | int) -> np.ndarray:
        """What draws these items, by number, each (or all) in as many steps as that place of `STEPS` says."""
        return self._commands[chosen, levels]

    def centers(self) -> np.ndarray:
        """(n, 3) middles of the items in world, m."""
        return np.einsum("nij,nj->ni", self.matrices[:, :, :3], self._centers) + self.matrices[:, :, 3]

    def show(self, state: RenderState) -> None:
        """Put everything where the state says.

        Raises:
            UnknownName: If the state has a pose for something that is not there.
        """
        for name in (*state.objects, *state.gone):
            if name not in self._things and name not in self._placed:
                raise UnknownName("object", name, {*self._things, *self._placed})
        for name, thing in self._things.items():
            # The name of what is gone may belong to something that was placed.
            there = name not in state.gone and name not in self._placed
            self.visible[thing.items] = there
            if there:
                self._move(thing, state.objects.get(name))
        for name, thing in self._placed.items():
            self._move(thing, state.objects.get(name))
        for robot, look in zip(self._robots, (state, *state.others)):
            robot.show(look, self.matrices, self.glow)

    def _move(self, thing: _Thing, pose: Pose | None) -> None:
        matrix = thing.home
        if pose is not None:
            matrix = transform(quaternion_matrix(pose.orientation), pose.position)
        self.still[thing.items] = bool(np.all(np.abs(matrix - thing.home) < AT_HOME))
        self.matrices[thing.items] = matrix[:3]

    # --- what there is --------------------------------------------------------------------------------------------

    def _add(self, looks: Sequence[Look], matrix: np.ndarray) -> slice:
        start = len(self._looks)
        for look in looks:
            levels = [self._geometry.add(each.mesh, each.colors, each.gloss) for each in (look, *look.coarser)]
            self._pieces.append(levels if look.coarser else levels * len(STEPS))
            self._looks.append(look)
            self._starts.append(matrix)
        return slice(start, len(self._looks))

    def _add_thing(self, thing: WorldObject, world: World) -> _Thing:
        position, orientation = place_of(thing, world.floor)
        home = transform(quaternion_matrix(orientation), position)
        return _Thing(thing.name, home, self._add(thing_looks(thing.parts), home))

    def _add_ground(self, world: World) -> None:
        """Rugs and bumps; the floor itself is drawn without triangles."""
        floor = transform(quaternion_matrix(world.floor.orientation), (0.0, 0.0, 0.0))
        for number, rug in enumerate(world.floor.rugs):
            middle = (*rug.center, RUG_HEIGHT * (number + 0.5))
            shape = Shape("box", (*rug.size, RUG_HEIGHT), middle, (0.0, 0.0, rug.yaw))
            self._add([Look(tessellate(shape).placed(shape), np.array(rug.color), 0.0, frame=RUG)], floor)
        for heap in heaps_of_bumps(world.floor):
            self._add(thing_looks(heap.parts), floor)

    def _add_robots(self, count: int) -> None:
        """The same pieces for each."""
        looks = robot_looks(self._model, self._appearance)
        first = self._add(looks, np.eye(4))
        for _ in range(count - 1):
            self._looks += looks
            self._pieces += self._pieces[first]
            self._starts += self._starts[first]


def spheres_in_sight(centers: np.ndarray, radii: np.ndarray, tangents: tuple[float, float], near: float) -> np.ndarray:
    """(n,) whether spheres reach into what a pinhole camera sees.

    Args:
        centers: (n, 3) m, in the camera's frame: to the right, upwards, ahead.
        radii: (n,) m.
        tangents: Of half the horizontal and half the vertical field of view.
        near: What is nearer is not seen, m.
    """
    inside = centers[:, 2] + radii > near
    for axis, tangent in enumerate(tangents):
        outside = np.abs(centers[:, axis]) - centers[:, 2] * tangent
        inside &= outside <= radii * math.hypot(1.0, tangent)
    return inside
