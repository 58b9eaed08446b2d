"""What is around one robot in a PyBullet world: the surfaces that its sonars may hear."""

from __future__ import annotations

from typing import List, Sequence, Tuple

from nao_sim_bridge.base.engine import Engine
from nao_sim_bridge.base.rotations import Vector3
from nao_sim_bridge.body.sensors.sonar import Surface

# Columns of PyBullet's closest points and of its hits of rays.
LINK_B, POSITION_ON_B = 4, 6
HIT_BODY = 0
PROBE_RADIUS = 0.001
AHEAD, AROUND = 0.5, 0.9
"""A box around what sonars may hear: its middle is so far ahead, and it reaches so far, as shares of their reach."""


class PhysicalSurroundings:
    """The other bodies of the world; the robot does not hear itself. Simulation thread only."""

    def __init__(self, engine: Engine, robot: int) -> None:
        self._engine = engine
        self._robot = robot
        self._probe = engine.createCollisionShape(engine.GEOM_SPHERE, radius=PROBE_RADIUS)

    def surfaces(self, place: Vector3, ahead: Vector3, reach: float) -> List[Surface]:
        """Nearest points of all shapes of other bodies that are within `reach` m of a place, ahead of it."""
        middle = [a + AHEAD * reach * b for a, b in zip(place, ahead)]
        low, high = ([value + side * AROUND * reach for value in middle] for side in (-1.0, 1.0))
        found = self._engine.getOverlappingObjects(low, high) or ()
        (x, y, z), (ax, ay, az) = place, ahead
        surfaces = []
        for body in sorted({entry[0] for entry in found} - {self._robot}):
            for point in self._engine.getClosestPoints(
                bodyA=-1, bodyB=body, distance=reach, collisionShapeA=self._probe, collisionShapePositionA=place
            ):
                px, py, pz = point[POSITION_ON_B]
                if (px - x) * ax + (py - y) * ay + (pz - z) * az >= 0.0:
                    surfaces.append(Surface((px, py, pz), body, point[LINK_B]))
        return surfaces

    def extents(self, surface: Surface, sight: Vector3) -> Tuple[float, float]:
        """Sides of the box around a link, m, without the one that is most along a line of sight."""
        low, high = self._engine.getAABB(surface.body, surface.link)
        along = max(range(3), key=lambda axis: abs(sight[axis]))
        first, second = (high[axis] - low[axis] for axis in range(3) if axis != along)
        return first, second

    def visible(self, places: Sequence[Vector3], surfaces: Sequence[Surface]) -> List[bool]:
        """Whether nothing but this robot is between a place and a surface, for pairs of them.

        Sound finds its way around the robot's own arms.
        """
        points = [surface.point for surface in surfaces]
        hits = self._engine.rayTestBatch(list(places), points)
        return [hit[HIT_BODY] in (-1, self._robot, surface.body) for hit, surface in zip(hits, surfaces)]
