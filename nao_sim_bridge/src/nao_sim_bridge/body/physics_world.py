"""The PyBullet world that robots are put into: gravity, floor, things, and the steps of time for all of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Callable, Sequence

from nao_sim_bridge.base.engine import Engine
from nao_sim_bridge.base.settings import Settings
from nao_sim_bridge.world.bodies import Inventory, WorldBodies
from nao_sim_bridge.world.world import FLOOR, World

DISTANCE = 8
"""Column of PyBullet's closest points."""
MOVING, ALL = 1, -1
"""Group of the engine for what moves, and the mask of what meets every group."""
DEEPEST = 0.002
"""What is inside the robot by less only touches it, m."""


@dataclass(frozen=True)
class SavedBodies:
    """Where all bodies were at a moment, for `PhysicsWorld.load`.

    Attributes:
        state: The engine's number of its own record.
        count: How many bodies there were, robots included.
        things: Which of them were things.
    """

    state: int
    count: int
    things: Inventory


class PhysicsWorld:
    """A world with gravity; whoever calls this owns it: one thread only.

    Attributes:
        engine: The world in the physics engine.
        bodies: The floor and the things of the world.
        robots: PyBullet's body ids of the robots.

    Args:
        engine: An empty one, see `clear`; None for a new one, which takes as long as 20 steps.
    """

    def __init__(self, world: World, settings: Settings, engine: Engine | None = None) -> None:
        self.world = world
        self._steps = settings.steps_per_tick
        self.engine = engine or Engine()
        self.engine.setGravity(0, 0, -settings.gravity_m_s2)
        self.engine.setPhysicsEngineParameter(
            fixedTimeStep=settings.time_step_s,
            numSolverIterations=settings.solver_iterations,
            deterministicOverlappingPairs=1,
        )
        self.bodies = WorldBodies(world, self.engine)
        self.robots: list[int] = []
        self._kept: SavedBodies | None = None
        self._lost = False
        self._dropped: list[int] = []
        self._groups: dict[tuple[int, int], int] = {}

    def step(self, pushes: Sequence[Callable[[], None]] = ()) -> None:
        """Advance by one tick; `pushes` are called before each step, for the engine forgets forces after one."""
        if self._dropped:
            self._free()
        for _ in range(self._steps):
            for push in pushes:
                push()
            self.engine.stepSimulation()

    def keep(self) -> None:
        """Remember all bodies as they are now, for `restore`, if it can put them back."""
        if not self.bodies.loose:
            self._kept = self.save()

    def lose(self) -> None:
        """Forget what was kept: the engine is not to be trusted any more."""
        self._kept = None
        self._lost = True

    def clear(self) -> Engine | None:
        """Take everything out of the engine and give it away, for another world; None if it is not to be trusted."""
        if self._lost:
            self.close()
            return None
        self.engine.resetSimulation()
        return self.engine

    def restore(self) -> bool:
        """Put all bodies, to the last bit, to where they were at `keep`, if it can; what motors were told stays."""
        # What can roll away is not put back to the last bit: what the engine knows of neighbours stays in its order.
        if self._kept is None or self.bodies.loose or not self.fits(self._kept):
            return False
        self.load(self._kept)
        return True

    def save(self) -> SavedBodies:
        """The state of all bodies, for `load`; the engine keeps it until `drop`, or as long as the world."""
        self._free()
        state = self.engine.saveState()
        return SavedBodies(state, self.engine.getNumBodies(), self.bodies.inventory())

    def fits(self, saved: SavedBodies) -> bool:
        """Whether nothing has come or gone since `save`."""
        return saved.count == self.engine.getNumBodies() and self.bodies.fits(saved.things)

    def load(self, saved: SavedBodies) -> None:
        """Put all bodies, which `fits` must say are the same, to where they were at `save`."""
        # The engine keeps pairs of shapes that are near each other, in the order and with the forces of before. It
        # forgets those of a link that is put into its groups anew.
        for robot in self.robots:
            for link in range(-1, self.engine.getNumJoints(robot)):
                self.let_meet(robot, link, self.groups(robot, link))
        self.engine.restoreState(stateId=saved.state)
        self.bodies.believe(saved.things)

    def drop(self, saved: SavedBodies) -> None:
        """Free what the engine keeps of a state, which is of no use from now on, with the next step or `save`.

        Any thread: the garbage collector may call this in the midst of another call of the engine.
        """
        self._dropped.append(saved.state)

    def _free(self) -> None:
        while self._dropped:
            self.engine.removeState(self._dropped.pop())

    def groups(self, robot: int, link: int) -> int:
        """The groups that a link of a robot is in, as bits."""
        return self._groups.get((robot, link), MOVING)

    def let_meet(self, robot: int, link: int, groups: int) -> None:
        """Put a link (-1: the torso) of a robot into groups, as bits; it meets what is in any, and what meets them."""
        self._groups[robot, link] = groups
        self.engine.setCollisionFilterGroupMask(robot, link, groups, ALL)

    def inside(self, robot: int) -> dict[str, float]:
        """How deep a robot is in what is there, m: in things by name, in "robot 1"...; what only touches is left out.

        The floor does not count.
        """
        others = {name: body for name, body in self.bodies.ids.items() if name != FLOOR}
        others.update((f"robot {number + 1}", body) for number, body in enumerate(self.robots) if body != robot)
        depths = {name: self._depth(robot, body) for name, body in others.items()}
        return {name: depth for name, depth in depths.items() if depth > DEEPEST}

    def _depth(self, robot: int, body: int) -> float:
        points = self.engine.getClosestPoints(robot, body, 0.0)
        return max((-point[DISTANCE] for point in points), default=0.0)

    def close(self) -> None:
        """Free the engine's memory; the object and its robots are of no use afterwards."""
        self.engine.disconnect()
