"""Puts a world into PyBullet: to be touched by the physics, or to be seen in pictures."""

from __future__ import annotations

from typing import Callable, Sequence

from nao_sim_bridge.base.engine import Engine
from nao_sim_bridge.base.rotations import Quaternion, Vector3, from_roll_pitch_yaw, multiply, rotate
from nao_sim_bridge.model.shapes import Shape
from nao_sim_bridge.world.world import FLOOR, MOST_PARTS, Floor, Part, World, WorldObject

NOWHERE = (0.0, 0.0, 0.0)


def build_world(world: World, engine: Engine, visual: bool) -> dict[str, int]:
    """Put the floor and all objects into a PyBullet world.

    Args:
        visual: Make something to look at and nothing to touch (pictures), or the other way round (physics).

    Returns:
        PyBullet's body ids by name; `floor` is among them, its bumps are not.
    """
    build_floor, _ = _builders(visual)
    bodies = {FLOOR: build_floor(world.floor, engine)}
    for heap in heaps_of_bumps(world.floor):
        build_object(heap, world.floor, engine, visual)
    bodies.update({thing.name: build_object(thing, world.floor, engine, visual) for thing in world.objects})
    return bodies


def build_object(thing: WorldObject, floor: Floor, engine: Engine, visual: bool) -> int:
    """Put one thing into a PyBullet world, where it says; see `build_world`. Returns PyBullet's body id."""
    _, build = _builders(visual)
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


def _builders(visual: bool) -> tuple[Callable[..., int], Callable[..., int]]:
    """What makes a floor, and what makes a thing."""
    if not visual:
        return _touch_floor, _touch_object
    from nao_sim_bridge.world.visible import see_floor, see_object  # the physics needs nothing of it

    return see_floor, see_object


def _touch_floor(floor: Floor, engine: Engine) -> int:
    touched = engine.createCollisionShape(engine.GEOM_PLANE)
    body = engine.createMultiBody(0.0, touched, _speck(engine), baseOrientation=floor.orientation)
    engine.changeDynamics(body, -1, lateralFriction=floor.friction)
    return body


def _touch_object(thing: WorldObject, position: Sequence[float], orientation: Sequence[float], engine: Engine) -> int:
    body = engine.createMultiBody(
        thing.mass,
        _collision_shape(thing.touched, engine),
        _speck(engine),
        basePosition=position,
        baseOrientation=orientation,
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


def _speck(engine: Engine) -> int:
    """Something to be seen that nobody looks at: without, the engine makes a picture of all that can be touched."""
    return engine.createVisualShape(engine.GEOM_BOX, halfExtents=(0.01, 0.01, 0.01))


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
