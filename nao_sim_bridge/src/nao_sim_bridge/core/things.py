"""Things of the world that come, move and go while the simulation runs."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Callable, Mapping, Sequence

import numpy as np

from nao_sim_bridge.base.errors import BadValue, NotAllowed, UnknownName
from nao_sim_bridge.base.readings import Pose
from nao_sim_bridge.base.rotations import (
    Quaternion,
    Vector3,
    from_roll_pitch_yaw,
    multiply,
    roll_pitch_yaw,
    rotate,
    rotate_back,
    vector3,
)
from nao_sim_bridge.base.tasks import Task, TaskIds
from nao_sim_bridge.model.shapes import Shape
from nao_sim_bridge.world.world import FLOOR, MOST_PARTS, World, WorldObject

if TYPE_CHECKING:
    from nao_sim_bridge.body.physics_world import PhysicsWorld
    from nao_sim_bridge.world.bodies import WorldBodies

LONGEST_NAME = 64
LARGEST = 10.0
"""Largest thing, m from its origin to its furthest point."""
FURTHEST = 100.0
"""Distance of a place from the origin along each axis, m, at most."""
LONGEST_GLIDE = 3600.0
DEEPEST = 0.002
"""How far a thing may be inside the robot when it appears, m: more would hurl one of both away."""
NOBODY: frozenset[str] = frozenset()


class Things:
    """What is in the world besides the floor and the robots. Simulation thread only, but for `placed` and `gone`.

    A reset puts everything to where the world file says: what was placed goes, what was removed is back.

    Args:
        now: Tells simulated time, s.
        changed: Called when something was placed, moved at once or removed.
    """

    def __init__(self, world: World, task_ids: TaskIds, now: Callable[[], float], changed: Callable[[], None]) -> None:
        self._world = world
        self._ids = task_ids
        self._now = now
        self._changed = changed
        self._physics: PhysicsWorld | None = None
        self._glides: dict[str, tuple[Glide, Task]] = {}

    @property
    def placed(self) -> tuple[WorldObject, ...]:
        """Things that were added to those of the world; replaced at every change, so that any thread may take it."""
        return self._physics.bodies.placed if self._physics is not None else ()

    @property
    def gone(self) -> frozenset[str]:
        """Names of things of the world that were taken away; as `placed`."""
        return self._physics.bodies.gone if self._physics is not None else NOBODY

    @property
    def things(self) -> Mapping[str, WorldObject]:
        return self._bodies.things

    def begin(self, physics: PhysicsWorld) -> None:
        """Start all over with the bodies of a new physics."""
        self.stop()
        self._physics = physics

    def stop(self) -> None:
        glides, self._glides = self._glides, {}
        for _, task in glides.values():
            task.kill()

    def tick(self) -> None:
        """Move what is on its way to where it is at the end of this tick."""
        if not self._glides:
            return
        now = self._now()
        for name, (glide, task) in list(self._glides.items()):
            ended = glide.ended(now)
            try:
                if not ended:
                    self._bodies.put(name, glide.at(now), glide.velocity)
                    continue
                self._bodies.put(name, glide.target)
            except Exception as error:
                self._ids.guard.caught(f"task {task.name}", error)
                del self._glides[name]
                task.finish(error=error)
            else:
                del self._glides[name]
                task.finish()

    def place(self, thing: WorldObject) -> None:
        """Add a thing where it says.

        Raises:
            BadValue: Its name is taken, it is too large or too far away, or there are too many things.
            NotAllowed: The robot is there.
        """
        from nao_sim_bridge.base.sizes import load_sizes  # most things are those of the world

        taken = {FLOOR, *self.things}
        if thing.name in taken:
            allowed = f"one that is free (remove that thing, or move it); taken: {_listed(taken)}"
            raise BadValue("name", thing.name, allowed)
        if not 1 <= len(thing.name) <= LONGEST_NAME:
            raise BadValue("name", thing.name, f"1 to {LONGEST_NAME} characters")
        most = load_sizes().clients.things
        if len(self.placed) >= most:
            raise BadValue("number of placed things", len(self.placed) + 1, f"{most} at most")
        if len(thing.touched) > MOST_PARTS:
            raise BadValue("parts", len(thing.touched), f"{MOST_PARTS} at most")
        reach = max(math.dist((0.0, 0.0, 0.0), shape.xyz) + _radius(shape) for shape in thing.touched)
        if reach > LARGEST:
            raise BadValue("size", round(reach, 3), f"{LARGEST:g} m at most from the middle to the furthest point")
        _checked_place(thing.position)
        self._bodies.add(thing)
        try:
            self._refuse_in_robot(thing.name)
        except NotAllowed:
            self._bodies.remove(thing.name)
            raise
        self._changed()

    def move(self, name: str, position: Sequence[float], rpy: Sequence[float] | None, duration: float = 0.0) -> Task:
        """Put a thing to another place, at once or on a straight way there.

        Args:
            name: Of the thing; also one that the physics cannot move.
            position: Where the point goes that `position` of its entry in a world file means, m, over the floor.
            rpy: Orientation there, rad; None to keep it.
            duration: How long it takes, s of simulated time.

        Returns:
            A task that ends on arrival. Another move of the thing, its removal and a reset kill it.

        Raises:
            UnknownName: There is no such thing.
            BadValue: The place or the duration is out of range.
            NotAllowed: The robot is there, and the move would be at once.
        """
        thing = self._known(name)
        place = _checked_place(position)
        if not 0.0 <= duration <= LONGEST_GLIDE:
            raise BadValue("duration", duration, f"0 to {LONGEST_GLIDE:g} s")
        start = self._bodies.pose(name)
        target = self._pose_at(thing, place, rpy, start)
        self._halt(name)
        task = self._ids.make("moveObject", on_kill=lambda _: self._halt(name))
        if duration == 0.0:
            self._bodies.put(name, target)
            try:
                self._refuse_in_robot(name)
            except NotAllowed:
                self._bodies.put(name, start)
                raise
            task.finish()
        else:
            self._glides[name] = (Glide(start, target, self._now(), duration), task)
        self._changed()
        return task

    def remove(self, name: str) -> None:
        """Take a thing away, also one of the world file.

        Raises:
            UnknownName: There is no such thing.
        """
        self._known(name)
        self._halt(name)
        self._bodies.remove(name)
        self._changed()

    def places(self) -> dict[str, tuple[float, ...]]:
        """Where everything is: x, y, z in m over the floor, roll, pitch, yaw in rad, as `move` takes them, by name."""
        return {name: self._place_of(thing) for name, thing in self.things.items()}

    @property
    def _bodies(self) -> WorldBodies:
        return self._physics.bodies

    def _known(self, name: str) -> WorldObject:
        if name not in self.things:
            error = UnknownName("object", name, self.things)
            error.args = (f"{error} (there are: {_listed(self.things)})",)
            raise error
        return self.things[name]

    def _halt(self, name: str) -> None:
        """End the way that a thing is on."""
        if name in self._glides:
            glide, task = self._glides.pop(name)
            self._bodies.put(name, glide.at(self._now()))
            task.kill()

    def _refuse_in_robot(self, name: str) -> None:
        depth = max(self._bodies.depth_in(name, robot) for robot in self._physics.robots)
        if depth > DEEPEST:
            raise NotAllowed(f"{name!r} cannot be there: it would be {depth:.3f} m inside the robot")

    def _pose_at(self, thing: WorldObject, place: Vector3, rpy: Sequence[float] | None, now: Pose) -> Pose:
        """In world, of a thing whose point `origin` is at a place over the floor."""
        floor = self._world.floor.orientation
        turn = now.orientation if rpy is None else multiply(floor, from_roll_pitch_yaw(*_checked_rpy(rpy)))
        offset = rotate(turn, thing.origin)
        x, y, z = (a - b for a, b in zip(rotate(floor, place), offset))
        return Pose((x, y, z), turn)

    def _place_of(self, thing: WorldObject) -> tuple[float, ...]:
        floor, pose = self._world.floor.orientation, self._bodies.pose(thing.name)
        point = (a + b for a, b in zip(pose.position, rotate(pose.orientation, thing.origin)))
        x, y, z, w = floor
        turn = multiply((-x, -y, -z, w), pose.orientation)
        return (*rotate_back(floor, tuple(point)), *roll_pitch_yaw(turn))


@dataclass(frozen=True)
class Glide:
    """A straight way, with a turn the short way round.

    Attributes:
        start: Where it begins.
        target: Where it ends.
        begin: When, s.
        duration: How long it takes, s.
    """

    start: Pose
    target: Pose
    begin: float
    duration: float

    @property
    def velocity(self) -> Vector3:
        """On the way, in m/s."""
        dx, dy, dz = (b - a for a, b in zip(self.start.position, self.target.position))
        return (dx / self.duration, dy / self.duration, dz / self.duration)

    def ended(self, now: float) -> bool:
        """Whether the end has been reached at a time in s."""
        return now >= self.begin + self.duration - 1e-9

    def at(self, now: float) -> Pose:
        """The pose at a time in s; that of the end afterwards."""
        if self.ended(now):
            return self.target
        share = max(now - self.begin, 0.0) / self.duration
        x, y, z = (a + share * (b - a) for a, b in zip(self.start.position, self.target.position))
        return Pose((x, y, z), slerp(self.start.orientation, self.target.orientation, share))


def slerp(first: Quaternion, second: Quaternion, share: float) -> Quaternion:
    """The orientation at a share 0..1 of the way between two, the short way round."""
    cosine = sum(a * b for a, b in zip(first, second))
    if cosine < 0.0:
        second, cosine = (-second[0], -second[1], -second[2], -second[3]), -cosine
    angle = math.acos(min(cosine, 1.0))
    if angle < 1e-6:
        return second
    near, far = (math.sin(part * angle) / math.sin(angle) for part in (1.0 - share, share))
    x, y, z, w = (near * a + far * b for a, b in zip(first, second))
    return (x, y, z, w)


def _listed(names: object) -> str:
    return ", ".join(sorted(names)) or "nothing"


def _checked_place(position: Sequence[float]) -> Vector3:
    if len(position) != 3 or not all(abs(value) <= FURTHEST for value in position):
        raise BadValue("position", list(position), f"[x, y, z] in m, each -{FURTHEST:g}..{FURTHEST:g}")
    return vector3(position)


def _checked_rpy(rpy: Sequence[float]) -> Vector3:
    if len(rpy) != 3 or not all(math.isfinite(value) for value in rpy):
        raise BadValue("rpy", list(rpy), "[roll, pitch, yaw] in rad")
    return vector3(rpy)


def _radius(shape: Shape) -> float:
    """From the middle of a shape to its furthest point, m."""
    if shape.kind == "box":
        return float(np.linalg.norm(shape.size)) / 2.0
    if shape.kind == "sphere":
        return shape.size[0]
    radius, length = shape.size
    return length / 2.0 + radius if shape.kind == "capsule" else math.hypot(length / 2.0, radius)
