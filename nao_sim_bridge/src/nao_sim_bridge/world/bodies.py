"""The things of a world as bodies of the physics: those of the world file, and those that come and go."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Mapping, Sequence

from nao_sim_bridge.base.engine import Engine
from nao_sim_bridge.base.errors import check_finite
from nao_sim_bridge.base.readings import Pose
from nao_sim_bridge.base.rotations import Vector3, angular_velocity, vector3
from nao_sim_bridge.world.builder import build_object, build_world, place_of
from nao_sim_bridge.world.world import World, WorldObject

UNMOVED: Vector3 = (0.0, 0.0, 0.0)
NEARLY = 0.02
"""What is nearer is woken by a change, m."""
DISTANCE = 8
"""Column of PyBullet's closest points."""


@dataclass(frozen=True)
class Inventory:
    """Which things were there, and where those were that no physics moves.

    Attributes:
        ids: As of `WorldBodies`.
        placed: As there.
        gone: As there.
        fixed: Poses in world, by name.
    """

    ids: Mapping[str, int]
    placed: tuple[WorldObject, ...]
    gone: frozenset[str]
    fixed: Mapping[str, Pose]


class WorldBodies:
    """Bodies by name. Simulation thread only, but for the attributes, which are replaced and never changed.

    Attributes:
        ids: PyBullet's body ids by name; `floor` is among them.
        placed: Things that were added to those of the world.
        gone: Names of things of the world that were taken away.
    """

    def __init__(self, world: World, engine: Engine) -> None:
        self._floor = world.floor
        self._engine = engine
        self.ids = build_world(world, engine, visual=False)
        self._things = {thing.name: thing for thing in world.objects}
        self._of_world = frozenset(self._things)
        self.placed: tuple[WorldObject, ...] = ()
        self.gone: frozenset[str] = frozenset()
        self._loose = {thing.name: self.ids[thing.name] for thing in world.objects if thing.mass > 0.0}
        # What cannot be moved by the physics is where it was put last: no need to ask the engine.
        self._fixed: dict[str, Pose] = {}

    def inventory(self) -> Inventory:
        """What is there now, and where."""
        return Inventory(dict(self.ids), self.placed, self.gone, dict(self._fixed))

    def fits(self, then: Inventory) -> bool:
        """Whether nothing has come or gone since then; the engine gives numbers of removed bodies to new ones."""
        same = [*map(id, self.placed)] == [*map(id, then.placed)]
        return same and self.ids == then.ids and self.gone == then.gone

    def believe(self, then: Inventory) -> None:
        """Take what no physics moves to be where it was then."""
        self._fixed = dict(then.fixed)

    @property
    def loose(self) -> bool:
        """Whether the physics can move something."""
        return bool(self._loose)

    @property
    def things(self) -> Mapping[str, WorldObject]:
        return self._things

    def read(self) -> Mapping[str, Pose]:
        """Poses of what can be moved, was placed, or was put elsewhere.

        Raises:
            NotFinite: The engine has lost one of them.
        """
        poses = {}
        for name, body in self._loose.items():
            poses[name] = pose = Pose(*self._engine.getBasePositionAndOrientation(body))
            check_finite(name, (*pose.position, *pose.orientation))
        poses.update(self._fixed)
        return poses

    def pose(self, name: str) -> Pose:
        return Pose(*self._engine.getBasePositionAndOrientation(self.ids[name]))

    def add(self, thing: WorldObject) -> None:
        """Add a thing, whose name nothing has."""
        self.ids[thing.name] = build_object(thing, self._floor, self._engine, visual=False)
        self._things[thing.name] = thing
        self.placed += (thing,)
        if thing.mass > 0.0:
            self._loose[thing.name] = self.ids[thing.name]
        else:
            self._fixed[thing.name] = Pose(*place_of(thing, self._floor))
        self._wake(self._around(self.ids[thing.name]))

    def remove(self, name: str) -> None:
        around = self._around(self.ids[name])
        self._engine.removeBody(self.ids.pop(name))
        removed = self._things.pop(name)
        self._loose.pop(name, None)
        self._fixed.pop(name, None)
        self._wake(around)
        if removed in self.placed:
            self.placed = tuple(thing for thing in self.placed if thing is not removed)
        elif name in self._of_world:
            self.gone |= {name}

    def put(self, name: str, pose: Pose) -> None:
        """Put a thing somewhere, at rest.

        Raises:
            NotFinite: One of the numbers is not.
        """
        self._put(name, pose, UNMOVED, UNMOVED)
        if name not in self._loose:
            self._fixed[name] = pose

    def carry(self, name: str, before: Pose, after: Pose, seconds: float) -> None:
        """Have the physics move a thing from one pose to another within the coming seconds.

        It does so also with what nothing else moves. What touches the thing meanwhile is carried along or pushed away.

        Raises:
            NotFinite: One of the numbers is not.
        """
        velocity = vector3((b - a) / seconds for a, b in zip(before.position, after.position))
        self._put(name, before, velocity, angular_velocity(before.orientation, after.orientation, seconds))
        if name not in self._loose:
            self._fixed[name] = after

    def _put(self, name: str, pose: Pose, velocity: Vector3, turn: Vector3) -> None:
        """With a velocity in m/s and an angular velocity in rad/s, both in world, which what is fixed keeps."""
        check_finite(f"place of {name}", (*pose.position, *pose.orientation, *velocity, *turn))
        body = self.ids[name]
        self._wake(self._around(body))
        self._engine.resetBasePositionAndOrientation(body, pose.position, pose.orientation)
        self._engine.resetBaseVelocity(body, velocity, turn)
        self._wake(self._around(body))

    def depth_in(self, name: str, other: int) -> float:
        """How far a thing is inside another body, m; 0 when it is not."""
        points: Sequence = self._engine.getClosestPoints(self.ids[name], other, 0.0)
        return max((-point[DISTANCE] for point in points), default=0.0)

    def _around(self, body: int) -> set[int]:
        """Bodies that touch another one, or nearly."""
        low, high = self._engine.getAABB(body)
        low, high = [value - NEARLY for value in low], [value + NEARLY for value in high]
        found = self._engine.getOverlappingObjects(low, high) or ()
        return {entry[0] for entry in found}

    def _wake(self, bodies: set[int]) -> None:
        """Let those of the bodies that sleep look whether what they lie on is still there."""
        for body in self._loose.values():
            if body in bodies:
                self._engine.changeDynamics(body, -1, activationState=self._engine.ACTIVATION_STATE_WAKE_UP)
