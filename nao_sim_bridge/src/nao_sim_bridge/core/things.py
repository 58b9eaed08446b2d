"""Things of the world that come, move and go while the simulation runs."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Callable, Mapping, Protocol, Sequence

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
Path = Callable[[float], Sequence[float]]
"""Where a thing is at a time since its path began, s: x, y, z in m over the floor, roll, pitch, yaw in rad."""
DEEPEST = 0.002
"""How far a thing may be inside the robot when it appears, m: more would hurl one of both away."""
NOBODY: frozenset[str] = frozenset()
ROUNDING = 1e-9
"""s."""


class Things:
    """What is in the world besides the floor and the robots. Simulation thread only, but for `placed` and `gone`.

    A reset puts everything to where the world file says: what was placed goes, what was removed is back.

    Args:
        now: Tells simulated time, s.
        tick_s: Length of a tick, s.
        changed: Called when something was placed, moved at once or removed.
    """

    def __init__(
        self, world: World, task_ids: TaskIds, now: Callable[[], float], tick_s: float, changed: Callable[[], None]
    ) -> None:
        self._world = world
        self._ids = task_ids
        self._now = now
        self._tick_s = tick_s
        self._changed = changed
        self._physics: PhysicsWorld | None = None
        self._ways: dict[str, tuple[Way, Task]] = {}

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
        ways, self._ways = self._ways, {}
        for _, task in ways.values():
            task.kill()

    def tick(self) -> None:
        """Give what is on its way the velocity that brings it to where it is at the end of this tick.

        The physics moves it there: whatever stands on it or is pushed by it feels that velocity.
        """
        now = self._now()
        for name, (way, task) in list(self._ways.items()):
            try:
                before, after = way.at(now - self._tick_s), way.at(now)
                self._bodies.carry(name, before, after, self._tick_s)
            except Exception as error:
                self._fail(name, task, error)

    def arrive(self) -> None:
        """Let what is at the end of its way stand still there; the tick's step of physics has been made."""
        now = self._now()
        for name, (way, task) in list(self._ways.items()):
            if not way.ended(now):
                continue
            del self._ways[name]
            try:
                self._bodies.put(name, way.at(now))
            except Exception as error:
                self._fail(name, task, error)
            else:
                task.finish()

    def under_way(self) -> Mapping[str, tuple[Way, Task]]:
        """What is on its way, for `go_on`."""
        return dict(self._ways)

    def go_on(self, ways: Mapping[str, tuple[Way, Task]]) -> None:
        """Let exactly that be on its way which was so at an earlier time that it is again; the bodies are there."""
        kept = {name: task for name, (_, task) in ways.items() if self._ways.get(name, (None, None))[1] is task}
        for name, (_, task) in list(self._ways.items()):
            if name not in kept:
                del self._ways[name]
                task.kill()
        for name, (way, task) in ways.items():
            self._ways[name] = (way, task if name in kept else self._task(name))

    def place(self, thing: WorldObject) -> None:
        """Add a thing where it says.

        Raises:
            BadValue: Its name is taken, it is too large or too far away, or there are too many things.
            NotAllowed: The robot is there.
        """
        from nao_sim_bridge.base.sizes import load_sizes  # most things are those of the world

        taken = {FLOOR, *self.things}
        if thing.name in taken:
            allowed = f"one that is free (remove that thing, or move it); taken: {', '.join(sorted(taken))}"
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
        task = self._task(name)
        if duration == 0.0:
            self._put_at_once(name, target)
            task.finish()
        else:
            self._ways[name] = (Glide(start, target, self._now(), duration), task)
        self._changed()
        return task

    def move_along(self, name: str, path: Path, duration: float = math.inf) -> Task:
        """Move a thing along a path, from where that begins, which is reached at once.

        Args:
            name: As for `move`.
            path: Called twice in each tick, with s since the begin; equal runs need equal answers.
            duration: How long it takes, s of simulated time.

        Returns:
            A task that ends with the path, and with an error where `path` raises or has an answer that cannot be; the
            thing is where it was then. Another move of the thing, its removal and a reset kill it.

        Raises:
            UnknownName: There is no such thing.
            BadValue: The path begins at no place, or the duration is out of range.
            NotAllowed: The robot is where it begins.
        """
        thing = self._known(name)
        if not duration > 0.0:
            raise BadValue("duration", duration, "above 0 s")

        def pose(seconds: float) -> Pose:
            values = [float(value) for value in path(seconds)]
            if len(values) != 6:
                raise BadValue("path", values, "x, y, z in m, roll, pitch, yaw in rad")
            return self._pose_at(thing, _checked_place(values[:3]), values[3:])

        self._halt(name)
        self._put_at_once(name, pose(0.0))
        task = self._task(name)
        self._ways[name] = (PathWay(pose, self._now(), duration), task)
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
        return {name: self.place_of(name) for name in self.things}

    def place_of(self, name: str) -> tuple[float, ...]:
        """Where a thing is; see `places`.

        Raises:
            UnknownName: There is no such thing.
        """
        thing = self._known(name)
        floor, pose = self._world.floor.orientation, self._bodies.pose(name)
        point = (a + b for a, b in zip(pose.position, rotate(pose.orientation, thing.origin)))
        x, y, z, w = floor
        turn = multiply((-x, -y, -z, w), pose.orientation)
        return (*rotate_back(floor, tuple(point)), *roll_pitch_yaw(turn))

    @property
    def _bodies(self) -> WorldBodies:
        return self._physics.bodies

    def _known(self, name: str) -> WorldObject:
        if name not in self.things:
            raise UnknownName("object", name, sorted(self.things), "there are")
        return self.things[name]

    def _task(self, name: str) -> Task:
        return self._ids.make("moveObject", on_kill=lambda _: self._halt(name))

    def _halt(self, name: str) -> None:
        """End the way that a thing is on."""
        if name in self._ways:
            _, task = self._ways.pop(name)
            self._bodies.put(name, self._bodies.pose(name))
            task.kill()

    def _fail(self, name: str, task: Task, error: Exception) -> None:
        """End a way that cannot go on; the thing stays where it is."""
        self._ids.guard.caught(f"task {task.name}", error)
        self._ways.pop(name, None)
        self._bodies.put(name, self._bodies.pose(name))
        task.finish(error=error)

    def _put_at_once(self, name: str, pose: Pose) -> None:
        """Put a thing somewhere; it stays where it was if that is in a robot, and deeper than it is already."""
        before, touching = self._bodies.pose(name), self._depth_in_robots(name)
        self._bodies.put(name, pose)
        try:
            self._refuse_in_robot(name, max(DEEPEST, touching))
        except NotAllowed:
            self._bodies.put(name, before)
            raise

    def _refuse_in_robot(self, name: str, deepest: float = DEEPEST) -> None:
        depth = self._depth_in_robots(name)
        if depth > deepest:
            raise NotAllowed(f"{name!r} cannot be there: it would be {depth:.3f} m inside the robot")

    def _depth_in_robots(self, name: str) -> float:
        return max(self._bodies.depth_in(name, robot) for robot in self._physics.robots)

    def _pose_at(
        self, thing: WorldObject, place: Vector3, rpy: Sequence[float] | None, now: Pose | None = None
    ) -> Pose:
        """In world, of a thing whose point `origin` is at a place over the floor; without `rpy` as it is turned now."""
        floor = self._world.floor.orientation
        turn = now.orientation if rpy is None else multiply(floor, from_roll_pitch_yaw(*_checked_rpy(rpy)))
        offset = rotate(turn, thing.origin)
        x, y, z = (a - b for a, b in zip(rotate(floor, place), offset))
        return Pose((x, y, z), turn)


class Way(Protocol):
    """Where a thing is, as long as it is on its way."""

    def ended(self, now: float) -> bool:
        """Whether the end has been reached at a time in s."""

    def at(self, now: float) -> Pose:
        """The pose at a time in s; that of the end afterwards, that of the begin before."""


@dataclass(frozen=True)
class PathWay:
    """A way that a function tells.

    Attributes:
        pose: By s since the begin.
        begin: When, s.
        duration: How long it takes, s.
    """

    pose: Callable[[float], Pose]
    begin: float
    duration: float

    def ended(self, now: float) -> bool:
        return now >= self.begin + self.duration - ROUNDING

    def at(self, now: float) -> Pose:
        return self.pose(min(max(now - self.begin, 0.0), self.duration))


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

    def ended(self, now: float) -> bool:
        return now >= self.begin + self.duration - ROUNDING

    def at(self, now: float) -> Pose:
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
