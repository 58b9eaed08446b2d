"""What is in the simulated world beside floor and robots, as a topic."""

from __future__ import annotations

import time
from typing import Iterator

import rospy
from geometry_msgs.msg import Point, Pose, Quaternion
from std_msgs.msg import ColorRGBA

from nao_library_msgs.msg import WorldShape, WorldShapes
from nao_sim_bridge.base.rotations import from_roll_pitch_yaw, multiply, rotate
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.server.simulator_server import SimulatorServer
from nao_sim_bridge.world.world import World, WorldObject

PERIOD = 0.2
"""s of wall time between two messages."""
WORLD_FRAME = "world"


class ShapesTopic:
    """Publishes where all things are, while somebody listens.

    ROS API:
        Publishes `~shapes` (nao_library_msgs/WorldShapes), 5 Hz of wall time.

    Args:
        server: The running simulator; of several robots that of the first.
    """

    def __init__(self, server: SimulatorServer) -> None:
        self._server = server
        self._next = 0.0
        self._publisher = rospy.Publisher("~shapes", WorldShapes, queue_size=1)

    @property
    def listened(self) -> bool:
        return self._publisher.get_num_connections() > 0

    def tick(self) -> None:
        """Publish when it is time, and somebody listens."""
        now = time.monotonic()
        if now < self._next or not self.listened:
            return
        self._next = now + PERIOD
        message = WorldShapes(shapes=list(shapes_of(self._server.simulation.shared.world, self._server.now[0])))
        message.header.stamp, message.header.frame_id = rospy.Time.now(), WORLD_FRAME
        self._publisher.publish(message)


def shapes_of(world: World, snapshot: Snapshot) -> Iterator[WorldShape]:
    """Shapes of all that there is: what is gone is left out, what was placed comes after the rest."""
    placed = {thing.name for thing in snapshot.placed}
    kept = [thing for thing in world.objects if thing.name not in snapshot.gone and thing.name not in placed]
    for thing in (*kept, *snapshot.placed):
        yield from _shapes(thing, world, snapshot)


def _shapes(thing: WorldObject, world: World, snapshot: Snapshot) -> Iterator[WorldShape]:
    pose = snapshot.objects.get(thing.name)
    if pose is None:
        floor = world.floor.orientation
        place, turn = rotate(floor, thing.position), multiply(floor, from_roll_pitch_yaw(*thing.rpy))
    else:
        place, turn = pose.position, pose.orientation
    for part in thing.parts:
        shape = part.shape
        point = [a + b for a, b in zip(place, rotate(turn, shape.xyz))]
        orientation = Quaternion(*multiply(turn, from_roll_pitch_yaw(*shape.rpy)))
        color = ColorRGBA(*part.color, 1.0)
        yield WorldShape(thing.name, thing.kind, shape.kind, list(shape.size), Pose(Point(*point), orientation), color)
