"""Puts a world into PyBullet: to be touched by the physics, or to be seen in pictures."""

from __future__ import annotations

import io
from typing import Sequence

from nao_sim_bridge.base.engine import Engine
from nao_sim_bridge.base.rotations import Quaternion, Vector3, from_roll_pitch_yaw, multiply, rotate
from nao_sim_bridge.base.whole_file import memory_file
from nao_sim_bridge.model.meshes import Mesh, front_and_rest, merged, tessellate
from nao_sim_bridge.model.shapes import Shape
from nao_sim_bridge.world.pictures import WorldPicture, paint
from nao_sim_bridge.world.world import FLOOR, MOST_PARTS, Color, Floor, Part, Rug, World, WorldObject

FLOOR_EXTENT = 10.0
"""Half the edge length of the visible floor, m; the floor of the physics has no end."""
RUG_THICKNESS = 0.001
NOWHERE = (0.0, 0.0, 0.0)
UNTURNED = (0.0, 0.0, 0.0, 1.0)
WHITE = (1.0, 1.0, 1.0)


def build_world(world: World, engine: Engine, visual: bool) -> dict[str, int]:
    """Put the floor and all objects into a PyBullet world.

    Args:
        visual: Make something to look at and nothing to touch (pictures), or the other way round (physics).

    Returns:
        PyBullet's body ids by name; `floor` is among them, its bumps are not.
    """
    build_floor = _see_floor if visual else _touch_floor
    bodies = {FLOOR: build_floor(world.floor, engine)}
    for heap in heaps_of_bumps(world.floor):
        build_object(heap, world.floor, engine, visual)
    bodies.update({thing.name: build_object(thing, world.floor, engine, visual) for thing in world.objects})
    return bodies


def build_object(thing: WorldObject, floor: Floor, engine: Engine, visual: bool) -> int:
    """Put one thing into a PyBullet world, where it says; see `build_world`. Returns PyBullet's body id."""
    build = _see_object if visual else _touch_object
    return build(thing, *place_of(thing, floor), engine)


def place_of(thing: WorldObject, floor: Floor) -> tuple[Vector3, Quaternion]:
    """Position (m) and orientation in world of a thing where it says."""
    turn = from_roll_pitch_yaw(*thing.rpy)
    return rotate(floor.orientation, thing.position), multiply(floor.orientation, turn)


def heaps_of_bumps(floor: Floor) -> list[WorldObject]:
    """All bumps, as many in one thing as can be: many bodies would cost the engine more."""
    parts = [Part(shape, floor.bump_color) for shape in floor.bumps]
    return [
        WorldObject("", NOWHERE, NOWHERE, tuple(parts[start : start + MOST_PARTS]), 0.0, floor.friction, 0.0, 0.0)
        for start in range(0, len(parts), MOST_PARTS)
    ]


# --- touched ----------------------------------------------------------------------------------------------------------


def _touch_floor(floor: Floor, engine: Engine) -> int:
    touched = engine.createCollisionShape(engine.GEOM_PLANE)
    body = engine.createMultiBody(0.0, touched, baseOrientation=floor.orientation)
    engine.changeDynamics(body, -1, lateralFriction=floor.friction)
    return body


def _touch_object(thing: WorldObject, position: Sequence[float], orientation: Sequence[float], engine: Engine) -> int:
    body = engine.createMultiBody(
        thing.mass, _collision_shape(thing.touched, engine), basePosition=position, baseOrientation=orientation
    )
    engine.changeDynamics(
        body,
        -1,
        lateralFriction=thing.friction,
        rollingFriction=thing.rolling_friction,
        spinningFriction=thing.rolling_friction,
        restitution=thing.restitution,
        # What lies still costs nothing then, until something touches it.
        activationState=engine.ACTIVATION_STATE_ENABLE_SLEEPING,
    )
    return body


def _collision_shape(shapes: Sequence[Shape], engine: Engine) -> int:
    """One shape of several, in the frame of their body."""
    return engine.createCollisionShapeArray(
        shapeTypes=[getattr(engine, f"GEOM_{shape.kind.upper()}") for shape in shapes],
        # Each list has an entry for each shape, of a meaning or not.
        halfExtents=[[edge / 2.0 for edge in shape.size] if shape.kind == "box" else NOWHERE for shape in shapes],
        radii=[shape.size[0] for shape in shapes],
        lengths=[shape.size[1] if shape.kind in ("cylinder", "capsule") else 0.0 for shape in shapes],
        collisionFramePositions=[shape.xyz for shape in shapes],
        collisionFrameOrientations=[from_roll_pitch_yaw(*shape.rpy) for shape in shapes],
    )


# --- seen -------------------------------------------------------------------------------------------------------------


def _see_floor(floor: Floor, engine: Engine) -> int:
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


def _see_object(thing: WorldObject, position: Sequence[float], orientation: Sequence[float], engine: Engine) -> int:
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
