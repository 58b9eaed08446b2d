"""Goes to places around obstacles, and along trajectories, with the sonars alone. Simulation thread only.

The sonars see what is ahead and not where in their cone, so the robot faces where it goes. Before an obstacle it turns,
first to the side where less is, until there is room ahead; it goes on for a bit there and turns to its goal again.
"""

from __future__ import annotations

import math
from typing import Generator, Iterable, Sequence

from nao_sim_bridge.base.errors import SimulationError
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.navigation.caution import NAME, Caution
from nao_sim_bridge.naoqi.navigation.trajectory import Stretch
from nao_sim_bridge.walk.footsteps import FootPose
from nao_sim_bridge.walk.gait import FeetGait

STATUS, LEAVES, PROGRESS, MODIFIED = (
    f"Navigation/AvoidanceNavigator/{event}"
    for event in ("Status", "MovingToFreeZone", "TrajectoryProgress", "AbsTargetModified")
)
MOVING, AVOIDING, ARRIVED, BLOCKED, STOPPED = "Moving", "Avoiding", "Arrived", "Blocked", "Stopped"
TURN, WIDEST = math.radians(35.0), math.radians(105.0)
"""Before an obstacle the robot turns by this, again and again, up to the second one to each side."""
BIT, ROOM = 0.5, 0.3
"""How far it goes aside, m, where this much more than the security distance is free."""
MOST_WAYS = 6
"""So many obstacles are gone around."""
INSIDE = 0.3
"""A goal this near to an obstacle, m, is in it."""
STRAIGHT, HERE = math.radians(6.0), 0.03
"""Smaller turns, rad, and ways, m, are not made."""
NEWS = 0.05
"""Progress is told when it has risen by this much."""
Legs = Generator[Task, bool, bool]


class Navigator:
    """One way at a time: a new one ends the one before."""

    def __init__(self, simulation: Simulation, memory: MemoryStore, caution: Caution) -> None:
        self._simulation = simulation
        self._memory = memory
        self._caution = caution
        self._task: Task | None = None
        self._legs: Legs | None = None
        self._leg: Task | None = None
        self._goal: FootPose | None = None
        self._whole = self._told = 0.0
        self._blocked = False
        self._side = 1  # to which it has gone aside last: 1 left, -1 right
        for event in (STATUS, LEAVES, PROGRESS, MODIFIED):
            memory.declare_event(event, NAME)
        simulation.after_tick.append(self._tick)

    def go_to(self, goal: FootPose, turns: bool, gait: FeetGait) -> Task:
        """Go to a pose as seen from the robot, and turn there if it should; ends with whether it is there.

        Raises:
            MoveRefused: The robot cannot walk now.
        """
        here = self._here()
        world = here.moved(*goal)
        return self._begin("navigateTo", self._to(world, turns, gait), world)

    def go_along(self, stretches: Sequence[Stretch], gait: FeetGait) -> Task:
        """Go through poses; ends with True at the end, and also before an obstacle, and with False elsewhere.

        Raises:
            MoveRefused: The robot cannot walk now.
        """
        world = self._here()
        for stretch in stretches:
            world = world.moved(*stretch.poses[-1])
        return self._begin("moveAlong", self._along(stretches, gait), world)

    def stop(self) -> None:
        """End the way, if any; its task ends with False."""
        task = self._task
        if task is not None:
            self._end(False, STOPPED)
            self._simulation.robot.locomotion.stop()

    # --- ways, leg by leg -----------------------------------------------------------------------------------------

    def _to(self, goal: FootPose, turns: bool, gait: FeetGait) -> Legs:
        for ways in range(MOST_WAYS + 1):
            x, y, _ = goal.seen_from(self._here())
            self._tell_status(MOVING)
            if math.hypot(x, y) > HERE and not (yield from self._turn(math.atan2(y, x), gait)):
                return False
            x, _, _ = goal.seen_from(self._here())
            if x <= HERE or (yield from self._walk([FootPose(x, 0.0, 0.0)], gait)):
                break
            obstacle = self._caution.obstacle
            if obstacle is None:
                return False
            if math.dist(obstacle, goal[:2]) < INSIDE:
                here = self._here()
                self._memory.raise_event(MODIFIED, [here.x, here.y, goal.yaw])
                break
            if ways == MOST_WAYS:
                self._blocked = True
                return False
            self._tell_status(AVOIDING)
            self._memory.raise_event(LEAVES, 1.0)
            free = yield from self._aside(gait)
            self._memory.raise_event(LEAVES, 0.0)
            if not free:
                return False
        return not turns or (yield from self._turn(goal.seen_from(self._here()).yaw, gait))

    def _aside(self, gait: FeetGait) -> Legs:
        """Turn to where there is room, and go there for a bit; False when there is none, or somebody stops it."""
        self._side = self._caution.free_side or self._side
        for side in (self._side, -self._side):
            turned = 0.0
            while turned < WIDEST - 1e-9:
                if not (yield from self._turn(side * TURN, gait)):
                    return False
                turned += TURN
                if min(self._simulation.snapshot.sonars) > self._caution.distance + ROOM:
                    self._side = side
                    reached = yield from self._walk([FootPose(BIT, 0.0, 0.0)], gait)
                    return reached or self._caution.obstacle is not None
            if not (yield from self._turn(-side * turned, gait)):
                return False
        self._blocked = True
        return False

    def _along(self, stretches: Iterable[Stretch], gait: FeetGait) -> Legs:
        self._tell_status(MOVING)
        for stretch in stretches:
            if not (yield from self._walk(stretch.poses, gait, stretch.time)):
                self._blocked = self._caution.obstacle is not None
                return self._blocked
        return True

    def _turn(self, angle: float, gait: FeetGait) -> Legs:
        return abs(angle) < STRAIGHT or (yield from self._walk([FootPose(0.0, 0.0, angle)], gait))

    def _walk(self, poses: Sequence[FootPose], gait: FeetGait, time: float | None = None) -> Legs:
        """Whether the robot got there."""
        return (yield self._caution.begin(lambda locomotion: locomotion.move_to(poses, gait, time)))

    # --- inside ---------------------------------------------------------------------------------------------------

    def _here(self) -> FootPose:
        return self._simulation.robot.locomotion.position(use_sensors=True)

    def _begin(self, name: str, legs: Legs, goal: FootPose) -> Task:
        self.stop()
        x, y, _ = goal.seen_from(self._here())
        self._goal, self._whole, self._told = goal, math.hypot(x, y), 0.0
        self._legs, self._blocked = legs, False
        self._task = task = self._simulation.task_ids.make(name, on_kill=lambda _: self.stop())
        self._proceed(False)
        return task

    def _tick(self, _: Snapshot) -> None:
        if self._task is None:
            return
        self._tell_progress()
        if self._leg is None or not self._leg.finished:
            return
        robot = self._simulation.robot
        if self._leg.value or self._caution.obstacle is None or not robot.walking:
            self._proceed(bool(self._leg.value), self._leg.error)
        elif not robot.locomotion.ending:  # else these are the last steps before the obstacle
            self._end(False, STOPPED)  # somebody has begun another walk

    def _proceed(self, reached: bool, error: Exception | None = None) -> None:
        """Begin the next leg; `reached` tells whether the one before has come to its end."""
        legs, first = self._legs, self._leg is None
        assert legs is not None
        try:
            if error is not None:
                raise error
            self._leg = next(legs) if first else legs.send(reached)
        except StopIteration as end:
            self._arrive(bool(end.value))
        except SimulationError as refused:
            self._end(False, BLOCKED, refused)
            if first:
                raise

    def _arrive(self, there: bool) -> None:
        if there and not self._blocked:
            self._told = 1.0
            self._memory.raise_event(PROGRESS, 1.0)
        self._end(there, BLOCKED if self._blocked else ARRIVED if there else STOPPED)

    def _end(self, there: bool, status: str, error: Exception | None = None) -> None:
        task, self._task, self._legs, self._leg, self._goal = self._task, None, None, None, None
        self._tell_status(status)
        if task is not None:
            task.finish(there, error)

    def _tell_status(self, status: str) -> None:
        self._memory.raise_event(STATUS, status)

    def _tell_progress(self) -> None:
        if self._goal is None or self._whole <= HERE:
            return
        x, y, _ = self._goal.seen_from(self._here())
        progress = min(1.0 - math.hypot(x, y) / self._whole, 1.0)
        if progress >= self._told + NEWS:
            self._told = progress
            self._memory.raise_event(PROGRESS, progress)
