"""What robots and things are made of, as pieces to draw: shapes become triangles once."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Iterable, Sequence

import numpy as np

from nao_sim_bridge.model.appearance import OFF, Appearance
from nao_sim_bridge.model.meshes import AROUND, Mesh, front_and_rest, merged, tessellate
from nao_sim_bridge.model.robot_model import RobotModel
from nao_sim_bridge.model.shapes import Shape
from nao_sim_bridge.world.pictures import WorldPicture
from nao_sim_bridge.world.world import Part

GLOSS = {"white": 0.22, "shell": 0.22, "grey": 0.15, "dark": 0.12, "glass": 0.6, OFF: 0.25}
"""Of the robot's materials: how much of the lamp they reflect."""
GLOSS_OF_THINGS = 0.05
STEPS = (AROUND, 20, 16, 12)
"""Steps around round shapes, the finest first: in shadows, and for what is small in the picture, few are enough."""


@dataclass(frozen=True, eq=False)
class Look:
    """Triangles of one frame with the colours of their vertices.

    Attributes:
        colors: (n, 3) in 0..1, or (3,) for all.
        gloss: Of each vertex or of all, 0..1.
        picture: What covers it instead of the colour.
        shining: It is lit by itself.
        frame: Of a robot: link name, or side and phalanx as `LFinger11`.
        lamp: Of a robot: number of the lamp in the LED layout; -1 if it is none.
        coarser: The same of fewer and fewer triangles, as `STEPS` says; empty if it is not round.
    """

    mesh: Mesh
    colors: np.ndarray
    gloss: np.ndarray | float
    picture: WorldPicture | None = None
    shining: bool = False
    frame: str = ""
    lamp: int = -1
    coarser: tuple[Look, ...] = ()


@lru_cache(maxsize=2)
def robot_looks(model: RobotModel, appearance: Appearance) -> tuple[Look, ...]:
    """One look a link and phalanx, and one a lamp."""
    return _by_steps(_robot_looks(model, appearance, around) for around in STEPS)


@lru_cache(maxsize=64)
def thing_looks(parts: tuple[Part, ...]) -> tuple[Look, ...]:
    """One look for all parts that are plain, and one each for pictures and lights."""
    if all(part.shape.kind == "box" for part in parts):
        return tuple(_thing_looks(parts, AROUND))
    return _by_steps(_thing_looks(parts, around) for around in STEPS)


def _by_steps(levels: Iterable[list[Look]]) -> tuple[Look, ...]:
    return tuple(replace(finest, coarser=tuple(coarser)) for finest, *coarser in zip(*levels))


def _robot_looks(model: RobotModel, appearance: Appearance, around: int) -> list[Look]:
    looks = [_link_look(name, shapes, appearance, around) for name, shapes in appearance.shapes.items()]
    for side in ("L", "R"):
        for finger in model.fingers:
            looks += [_link_look(side + name, appearance.phalanx, appearance, around) for name in finger.phalanges]
    for number, figure in enumerate(appearance.lamps):
        mesh = tessellate(figure.shape, around).placed(figure.shape)
        color = np.array(appearance.materials[OFF])
        looks.append(Look(mesh, color, GLOSS[OFF], frame=figure.link, lamp=number))
    return looks


def _link_look(frame: str, shapes: Sequence[Shape], appearance: Appearance, around: int) -> Look:
    meshes = [tessellate(shape, around).placed(shape) for shape in shapes]
    counts = [len(mesh.vertices) for mesh in meshes]
    colors = np.repeat([appearance.materials[shape.material] for shape in shapes], counts, axis=0)
    gloss = np.repeat([GLOSS.get(shape.material, 0.1) for shape in shapes], counts)
    return Look(merged(meshes), colors, gloss, frame=frame)


def _thing_looks(parts: tuple[Part, ...], around: int) -> list[Look]:
    looks, meshes, colors = [], [], []
    for part in parts:
        color, mesh = np.array(part.color), tessellate(part.shape, around)
        if part.picture is not None:
            front, mesh = front_and_rest(mesh)
            looks.append(Look(front.placed(part.shape), color, GLOSS_OF_THINGS, picture=part.picture))
        mesh = mesh.placed(part.shape)
        if part.shining:
            looks.append(Look(mesh, color, 0.0, shining=True))
        elif len(mesh.faces):
            meshes.append(mesh)
            colors.append(np.broadcast_to(color, (len(mesh.vertices), 3)))
    if meshes:
        looks.append(Look(merged(meshes), np.vstack(colors), GLOSS_OF_THINGS))
    return looks
