"""Ends moves before obstacles that the sonars see. Simulation thread only."""

from __future__ import annotations

import logging
from typing import Any, Callable, Sequence, Tuple

from nao_sim_bridge.base.rotations import Vector3, plus, rotate
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.walk.courses import Course
from nao_sim_bridge.walk.footsteps import FootPose
from nao_sim_bridge.walk.locomotion import Locomotion

log = logging.getLogger("nao_sim.navigation")

NAME = "ALNavigation"
OBSTACLE = "Navigation/AvoidanceNavigator/ObstacleDetected"
SLOWEST = 0.004
"""A robot that goes less than this forward in a step, m, comes nearer to nothing ahead: it turns on the spot."""
ALIKE = 0.03
"""Echoes of both sides that differ by less than this, m, are of one thing straight ahead."""
Place = Tuple[float, float]


class Caution:
    """Looks ahead while a move lasts, from its `begin` until it ends or makes room for another one.

    It ends the move, and raises `Navigation/AvoidanceNavigator/ObstacleDetected` with [x, y] in FRAME_ROBOT, when
    something ahead is nearer than ALMotion's orthogonal security distance, however slow the robot is.

    Attributes:
        obstacle: Place in the world of the robot's odometry, m, of what has ended the present move; None for nothing.
        free_side: Where the sonars saw less of it: 1 left, -1 right, 0 when both saw the same.
    """

    def __init__(self, simulation: Simulation, memory: MemoryStore) -> None:
        self.obstacle: Place | None = None
        self.free_side = 0
        self._simulation = simulation
        self._memory = memory
        self._begins = False
        self._course: Course | None = None  # of the move
        self._echoes: Sequence[float] = ()
        memory.declare_event(OBSTACLE, NAME)
        simulation.after_tick.append(self._tick)

    @property
    def distance(self) -> float:
        """Security distance, m."""
        return self._simulation.robot.reflexes.external_collision.orthogonal

    @distance.setter
    def distance(self, distance: float) -> None:
        self._simulation.robot.reflexes.external_collision.orthogonal = distance

    def begin(self, command: Callable[[Locomotion], Any]) -> Any:
        """Begin a move; what its command answers. One that an obstacle prevents raises MovePrevented."""
        locomotion = self._simulation.robot.locomotion
        if self._failed not in locomotion.failures:
            locomotion.failures.append(self._failed)
        self.obstacle = self._course = None
        self._begins = True
        try:
            answer = command(locomotion)
        finally:
            self._begins = False
        self._course = locomotion.course
        self._echoes = ()
        return answer

    def _tick(self, now: Snapshot) -> None:
        if self._course is None:
            return
        locomotion = self._simulation.robot.locomotion
        if locomotion.course is not self._course:
            self._course = None
        elif now.sonars is not self._echoes:
            self._echoes = now.sonars
            if locomotion.ahead > SLOWEST and min(now.sonars) < self.distance:
                collision = self._simulation.robot.reflexes.external_collision
                seen = rotate(now.odometry.orientation, collision.obstacle_ahead(now.sonars).tolist())
                self._stop_at(plus(now.odometry.position, seen))

    def _failed(self, _: str, started: bool, obstacle: Vector3 | None) -> None:
        """ALMotion's own protection was quicker."""
        mine = self._course is not None and self._simulation.robot.locomotion.course is self._course
        if obstacle is not None and (self._begins or (mine and started)):
            self._stop_at(obstacle)

    def _stop_at(self, place: Any) -> None:
        if self.obstacle is not None:
            return
        self.obstacle = (place[0], place[1])
        left, right = self._simulation.snapshot.sonars
        self.free_side = 0 if abs(left - right) < ALIKE else 1 if left > right else -1
        locomotion = self._simulation.robot.locomotion
        x, y, _ = FootPose(place[0], place[1], 0.0).seen_from(locomotion.position(use_sensors=True))
        log.warning("the move ends: there is an obstacle %.2f m ahead", x)
        self._memory.raise_event(OBSTACLE, [x, y])
        locomotion.stop()
