"""What process modules share of a robot: its actions, joints, frames, and numbers. In ROS."""

from __future__ import annotations

import threading
from collections.abc import Mapping
from typing import Any, Callable

import rosgraph
import rospy
import tf2_ros
from sensor_msgs.msg import JointState

from ...base.places import FOOTPRINT, Place, yaw_of_quaternion
from ...base.rotations import rotate
from ...ros.driver_types import spoken
from ...ros.robot_frames import tf_prefix
from ...ros.ros_clock import RosClock
from ..language.failures import LowLevelFailure
from ..language.flow import sleep, wait_until
from ..language.fluents import Fluent
from ..language.settings import Settings, load_settings
from ..language.space import Point3
from .action_client import PlanActionClient
from .chains import Chain

STATE_LIMIT = 5.0
"""s to wait for the first joint states, and for frames."""
OLDEST = 10.0
"""s that joint states may be late; what is older is of a clock that was set back."""
LISTENER_PERIOD = 0.02
OTHERS_LIMIT = 2.0
"""s to wait, when the first listener is there, for others that the master knows: one that was killed never comes."""
TORSO = "torso"


class LatchedTopic:
    """Publishes when the listeners are connected, which takes a moment after the publisher has been made."""

    def __init__(self, topic: str, kind: type) -> None:
        self._publisher = rospy.Publisher(topic, spoken(kind), queue_size=1)
        self._publisher.impl.set_queue_size(None)  # what is published is sent then: the program may end right after it
        self._settled = False

    def tell(self, message: Any, limit: float) -> bool:
        """Publish a message; waits in a plan. False if nobody has listened for `limit` s."""
        if not self._listened():
            self._settled = False
            if not self._wait(self._listened, limit):
                return False
        if not self._settled:
            self._wait(self._all_listen, OTHERS_LIMIT)
            self._settled = True
        self._publisher.publish(message)
        return True

    def _listened(self) -> bool:
        return self._publisher.get_num_connections() > 0

    def _all_listen(self) -> bool:
        subscribers = dict(rosgraph.Master(rospy.get_name()).getSystemState()[1])
        known = subscribers.get(self._publisher.resolved_name, ())
        return self._publisher.get_num_connections() >= len(known)

    @staticmethod
    def _wait(condition: Callable[[], bool], limit: float) -> bool:
        waited = 0.0
        while not condition():
            if waited >= limit:
                return False
            sleep(LISTENER_PERIOD)
            waited += LISTENER_PERIOD
        return True


class RobotLink:
    """A robot as process modules know it: names are relative to the namespace of the node.

    `joints`: a fluent with the last joint states: name -> angle, rad. `held`: side of a hand that was closed last ->
    how far it stayed open, 0..1.
    """

    def __init__(self, settings: Settings | None = None) -> None:
        self.settings = settings or load_settings()
        self.clock = RosClock()
        self.joints = Fluent("joint states", {})
        self.held: dict[str, float] = {}
        self._clients: dict[str, PlanActionClient] = {}
        self._topics: dict[str, LatchedTopic] = {}
        self._lock = threading.Lock()
        self._known_since = 0.0
        self._chains: dict[str, Chain] = {}
        self._buffer = tf2_ros.Buffer()
        self._listener = tf2_ros.TransformListener(self._buffer)
        self._subscriber = rospy.Subscriber("joint_states", JointState, self._take, queue_size=1)

    def action(self, name: str, kind: type) -> PlanActionClient:
        """The client of an action; one for each name."""
        with self._lock:
            if name not in self._clients:
                self._clients[name] = PlanActionClient(name, kind)
            return self._clients[name]

    def topic(self, name: str, kind: type) -> LatchedTopic:
        """A topic to publish on; one for each name."""
        with self._lock:
            if name not in self._topics:
                self._topics[name] = LatchedTopic(name, kind)
            return self._topics[name]

    def angles(self) -> Mapping[str, float]:
        """Angles of the joints, rad by name; the first ones are waited for, in a plan.

        Raises LowLevelFailure if nobody publishes them.
        """
        if not wait_until(lambda: self.joints.value, [self.joints], STATE_LIMIT):
            raise LowLevelFailure(f"no joint states on {rospy.resolve_name('joint_states')}: is a driver running?")
        return self.joints.value

    def learn(self, state: JointState) -> None:
        """Take joint states from another source, as the result of an action: they may be ahead of the topic."""
        self._take(state, learned=True)

    def chain(self, base: str, tip: str) -> Chain:
        """Joints between two links of the robot description.

        Raises LowLevelFailure if there is no description, NaoError if it has no such chain.
        """
        key = f"{base} {tip}"
        if key not in self._chains:
            found = rospy.search_param("robot_description")
            if not found:
                raise LowLevelFailure("there is no robot_description: is a driver running?")
            self._chains[key] = Chain(rospy.get_param(found), base, tip)
        return self._chains[key]

    def place(self, frame: str) -> Place:
        """Where the robot is now, seen from above, in a frame; LowLevelFailure if the frame is unknown."""
        found = self._transform(frame, FOOTPRINT)
        turn = found.rotation
        yaw = yaw_of_quaternion(turn.x, turn.y, turn.z, turn.w)
        return Place(found.translation.x, found.translation.y, 0.0 if yaw is None else yaw)

    def point_in(self, point: Point3, frame: str) -> Point3:
        """A point in another frame, as the frames are now; LowLevelFailure if they are not connected."""
        if point.frame == frame:
            return point
        found = self._transform(frame, point.frame)
        turn, move = found.rotation, found.translation
        x, y, z = rotate((turn.x, turn.y, turn.z, turn.w), (point.x, point.y, point.z))
        return Point3(x + move.x, y + move.y, z + move.z, frame)

    def _transform(self, to: str, of: str) -> Any:
        """The transform that brings points of one frame into another, as soon as there is one.

        Raises LowLevelFailure if the frames are not connected.
        """
        target, source = tf_prefix() + to.lstrip("/"), tf_prefix() + of.lstrip("/")
        problem = ""

        def known() -> bool:
            nonlocal problem
            there, problem = self._buffer.can_transform_core(target, source, rospy.Time())
            return there

        # /tf comes in a thread of its own and has no fluent; joint states come as often.
        if not wait_until(known, [self.joints], STATE_LIMIT):
            raise LowLevelFailure(f"the frame {of} cannot be told in {to}: {problem or 'is a driver running?'}")
        return self._buffer.lookup_transform_core(target, source, rospy.Time()).transform

    def _take(self, state: JointState, learned: bool = False) -> None:
        stamp, angles = state.header.stamp.to_sec(), dict(zip(state.name, state.position))
        with self._lock:
            if learned:
                self._known_since = stamp
            elif 0.0 < self._known_since - stamp < OLDEST:  # from before what is known; a clock set back is older
                return
            # Within the lock: neither takes the place of what is newer.
            self.joints.update(lambda known: angles if not learned else {**known, **angles} if known else known)
