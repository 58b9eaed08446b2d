"""The floor and the things of a world as bodies of PyBullet that can be seen and not touched."""

from __future__ import annotations

import io
from typing import Sequence

from nao_sim_bridge.base.engine import Engine
from nao_sim_bridge.base.memory_file import memory_file
from nao_sim_bridge.model.meshes import Mesh, front_and_rest, merged, tessellate
from nao_sim_bridge.model.shapes import Shape
from nao_sim_bridge.world.pictures import WorldPicture, paint
from nao_sim_bridge.world.world import Color, Floor, Rug, WorldObject

FLOOR_EXTENT = 10.0
"""Half the edge length of the visible floor, m; the floor of the physics has no end."""
RUG_THICKNESS = 0.001
NOWHERE = (0.0, 0.0, 0.0)
UNTURNED = (0.0, 0.0, 0.0, 1.0)
WHITE = (1.0, 1.0, 1.0)


def see_floor(floor: Floor, engine: Engine) -> int:
    """Id of a body."""
    extents = (FLOOR_EXTENT, FLOOR_EXTENT, 0.005)
    seen = engine.createVisualShape(
        engine.GEOM_BOX,
        halfExtents=extents,
        rgbaColor=(*floor.color, 1.0),
        specularColor=NOWHERE,
        # The top face is the floor: half the thickness below it.
        visualFramePosition=(0.0, 0.0, -extents[2]),
    )
    return _body(
        [seen, *(_see_rug(rug, number, engine) for number, rug in enumerate(floor.rugs, 1))],
        NOWHERE,
        floor.orientation,
        engine,
    )


def _see_rug(rug: Rug, number: int, engine: Engine) -> int:
    # Each is higher than the one before it, on which it may lie.
    height = number * RUG_THICKNESS
    shape = Shape("box", (*rug.size, height), (*rug.center, height / 2.0), (0.0, 0.0, rug.yaw))
    return visual_shape(tessellate(shape).placed(shape), rug.color, engine)


def see_object(thing: WorldObject, position: Sequence[float], orientation: Sequence[float], engine: Engine) -> int:
    """Id of a body at a position (m) and orientation in world."""
    by_color: dict[Color, list[Mesh]] = {}
    pictures: list[tuple[WorldPicture, Mesh]] = []
    for part in thing.parts:
        mesh = tessellate(part.shape)
        if part.picture is not None:
            front, mesh = front_and_rest(mesh)
            pictures.append((part.picture, front.placed(part.shape)))
        by_color.setdefault(part.color, []).append(mesh.placed(part.shape))
    seen = [visual_shape(merged(meshes), color, engine) for color, meshes in by_color.items()]
    covered = [visual_shape(mesh, WHITE, engine) for _, mesh in pictures]
    body = _body([*seen, *covered], position, orientation, engine)
    for link, (picture, _) in enumerate(pictures, len(seen) - 1):
        engine.changeVisualShape(body, link, textureUniqueId=texture(picture, engine))
    return body


def _body(seen: Sequence[int], position: Sequence[float], orientation: Sequence[float], engine: Engine) -> int:
    """One body of several visual shapes: each has one colour, so all but the first are links that never move."""
    count = len(seen) - 1
    return engine.createMultiBody(
        0.0,
        -1,
        seen[0],
        basePosition=position,
        baseOrientation=orientation,
        linkMasses=[0.0] * count,
        linkCollisionShapeIndices=[-1] * count,
        linkVisualShapeIndices=list(seen[1:]),
        linkPositions=[NOWHERE] * count,
        linkOrientations=[UNTURNED] * count,
        linkInertialFramePositions=[NOWHERE] * count,
        linkInertialFrameOrientations=[UNTURNED] * count,
        linkParentIndices=[0] * count,
        linkJointTypes=[engine.JOINT_FIXED] * count,
        linkJointAxis=[(0.0, 0.0, 1.0)] * count,
    )


def visual_shape(mesh: Mesh, color: Sequence[float], engine: Engine) -> int:
    """Id of a visual shape, of a colour in 0..1; those that PyBullet makes itself are a few dozen flat triangles."""
    return engine.createVisualShape(
        engine.GEOM_MESH,
        vertices=mesh.vertices.tolist(),
        normals=mesh.normals.tolist(),
        uvs=[(0.0, 0.0)] * len(mesh.vertices) if mesh.uvs is None else mesh.uvs.tolist(),
        indices=mesh.faces.ravel().tolist(),
        rgbaColor=(*color, 1.0),
    )


def texture(picture: WorldPicture, engine: Engine) -> int:
    """Id of a texture for `changeVisualShape`; PyBullet takes them from files only."""
    from PIL import Image  # most worlds have no pictures

    content = io.BytesIO()
    Image.fromarray(paint(picture)).save(content, "PNG")
    with memory_file(content.getvalue()) as path:
        return engine.loadTexture(path)
