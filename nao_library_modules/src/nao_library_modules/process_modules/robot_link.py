"""The robot as process modules reach it: actions, topics, joints, frames, and the kinematics of its arms. In ROS.

`Chain` has the joints between two links of the robot description (URDF): where their tip is, and how to move it to a
point. The arm of a NAO has five joints and the hand is wanted at a point: its direction stays free. Solutions are found
by damped least squares (Nakamura and Hanafusa 1986) from several starts; angles stay within the limits.
"""

from __future__ import annotations

import math
import threading
import xml.etree.ElementTree as ElementTree
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Callable

import numpy as np
import rosgraph
import rospy
import tf2_ros
from sensor_msgs.msg import JointState

from naoqi.errors import NaoError

from ..core.geometry import FOOTPRINT, Place, Quaternion, about, from_roll_pitch_yaw, rotate, yaw_of_quaternion
from ..ros.driver_types import spoken
from ..ros.time_and_frames import RosClock, tf_prefix
from .designators.objects_and_locations import Point3
from .designators.rules import Settings, load_settings
from .failures import LowLevelFailure
from .fluents import Fluent, sleep, wait_until
from .plan_action_client import PlanActionClient

# --- kinematics -------------------------------------------------------------------------------------------------------

MARGIN = 0.02
"""rad that solutions stay away from the limits of joints: a motor does not get to its end."""
CLOSE = 1e-4
"""m; a solution is there."""
STEPS = 120
DAMPING = 0.03
LONGEST_STEP = 0.3
"""rad a joint, each step."""


@dataclass(frozen=True)
class Joint:
    """A joint of a chain; `name` is empty for a fixed one."""

    name: str
    origin: np.ndarray
    axis: np.ndarray
    lower: float
    upper: float


@dataclass(frozen=True)
class Solution:
    angles: Mapping[str, float]
    point: tuple[float, float, float]
    distance: float


class Chain:
    """Joints from a base link to the origin of a tip link; `joints` are the moving ones, from the base on.

    Raises NaoError if the description is no URDF, or has no such chain.
    """

    def __init__(self, description: str, base: str, tip: str) -> None:
        self._all = _joints(description, base, tip)
        moving = [joint for joint in self._all if joint.name]
        self.joints = tuple(joint.name for joint in moving)
        self.lower = np.array([joint.lower for joint in moving])
        self.upper = np.array([joint.upper for joint in moving])

    def tip(self, angles: Sequence[float] | Mapping[str, float]) -> np.ndarray:
        """(4, 4) of the tip in the base, for (n,) angles in rad, or angles by name."""
        return self._frames(self._listed(angles))[-1][0]

    def reach(self, point: Sequence[float], now: Sequence[float] | Mapping[str, float]) -> Solution:
        """Angles that bring the tip to a point (x, y, z) in the base, m, or as near as they can.

        The search begins from the angles `now`, and prefers solutions near them. Returns the first solution that
        reaches the point; the nearest one if none does.
        """
        target = np.asarray(point, dtype=float)
        best: Solution | None = None
        for start in self._starts(self._listed(now)):
            found = self._search(target, start)
            if best is None or found.distance < best.distance:
                best = found
            if best.distance < 10.0 * CLOSE:
                break
        assert best is not None
        return best

    def _search(self, target: np.ndarray, start: np.ndarray) -> Solution:
        low, high = self.lower + MARGIN, self.upper - MARGIN
        angles = np.clip(start, low, high)
        best, best_error = angles, math.inf
        for _ in range(STEPS):
            frames = self._frames(angles)
            place = frames[-1][0][:3, 3]
            error = target - place
            distance = float(np.linalg.norm(error))
            if distance < best_error:
                best, best_error = angles, distance
            if distance < CLOSE:
                break
            jacobian = np.stack([np.cross(axis, place - frame[:3, 3]) for frame, axis in frames[:-1]], axis=1)
            # A joint at its limit that would go on has no say in this step.
            wanted = jacobian.T @ error
            stuck = ((angles <= low) & (wanted < 0.0)) | ((angles >= high) & (wanted > 0.0))
            jacobian[:, stuck] = 0.0
            damped = jacobian @ jacobian.T + DAMPING**2 * min(1.0, distance / 0.1) * np.eye(3)
            step = jacobian.T @ np.linalg.solve(damped, error)
            longest = float(np.abs(step).max())
            if longest < 1e-7:
                break
            angles = np.clip(angles + step * min(1.0, LONGEST_STEP / longest), low, high)
        place = self._frames(best)[-1][0][:3, 3]
        x, y, z = map(float, place)
        return Solution(dict(zip(self.joints, map(float, best))), (x, y, z), best_error)

    def _starts(self, now: np.ndarray) -> list[np.ndarray]:
        middle, span = (self.lower + self.upper) / 2.0, (self.upper - self.lower) / 2.0
        # The corners of half the range, in a fixed order: the same question has the same answer.
        corners = [middle + 0.5 * span * np.array(signs) for signs in _signs(len(self.joints))]
        return [now, middle, *corners]

    def _frames(self, angles: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
        """Frame of each moving joint and its axis, in the base; at the end that of the tip."""
        frames, here, place = [], np.eye(4), 0
        for joint in self._all:
            here = here @ joint.origin
            if not joint.name:
                continue
            frames.append((here, here[:3, :3] @ joint.axis))
            here = here.copy()
            here[:3, :3] = here[:3, :3] @ _matrix(about(joint.axis.tolist(), float(angles[place])))
            place += 1
        return [*frames, (here, np.zeros(3))]

    def _listed(self, angles: Sequence[float] | Mapping[str, float]) -> np.ndarray:
        if isinstance(angles, Mapping):
            missing = [name for name in self.joints if name not in angles]
            if missing:
                raise NaoError(f"no angle of {', '.join(missing)} is known")
            angles = [angles[name] for name in self.joints]
        return np.asarray(angles, dtype=float)


def _joints(description: str, base: str, tip: str) -> list[Joint]:
    try:
        root = ElementTree.fromstring(description)
    except ElementTree.ParseError as error:
        raise NaoError(f"the robot description is no XML: {error}") from error
    by_child = {_attribute(joint, "child", "link"): joint for joint in root.findall("joint")}
    found: list[Joint] = []
    link = tip
    while link != base:
        joint = by_child.get(link)
        if joint is None:
            raise NaoError(f"the robot description has no chain from {base} to {tip}: it ends at {link}")
        found.append(_joint(joint))
        link = _attribute(joint, "parent", "link")
    return found[::-1]


def _joint(joint: ElementTree.Element) -> Joint:
    origin = np.eye(4)
    place = joint.find("origin")
    if place is not None:
        origin[:3, :3] = _matrix(from_roll_pitch_yaw(*_floats(place.get("rpy", "0 0 0"))))
        origin[:3, 3] = _floats(place.get("xyz", "0 0 0"))
    if joint.get("type") not in ("revolute", "continuous"):
        return Joint("", origin, np.zeros(3), 0.0, 0.0)
    axis = np.array(_floats(_attribute(joint, "axis", "xyz") or "1 0 0"))
    lower = float(_attribute(joint, "limit", "lower") or -math.pi)
    upper = float(_attribute(joint, "limit", "upper") or math.pi)
    return Joint(joint.get("name", ""), origin, axis / np.linalg.norm(axis), lower, upper)


def _attribute(element: ElementTree.Element, child: str, name: str) -> str:
    found = element.find(child)
    return "" if found is None else found.get(name, "")


def _floats(text: str) -> list[float]:
    return [float(word) for word in text.split()]


def _matrix(turn: Quaternion) -> np.ndarray:
    """(3, 3) of a rotation."""
    return np.array([rotate(turn, axis) for axis in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))]).T


def _signs(count: int) -> list[list[int]]:
    """Eight corners of a cube of any dimension, spread over it."""
    return [[1 if (corner >> (place % 3)) & 1 else -1 for place in range(count)] for corner in range(8)]


# --- the robot --------------------------------------------------------------------------------------------------------

STATE_LIMIT = 5.0
"""s to wait for the first joint states, and for frames."""
OLDEST = 10.0
"""s that joint states may be late; what is older is of a clock that was set back."""
LISTENER_PERIOD = 0.02
OTHERS_LIMIT = 2.0
"""s to wait, when the first listener is there, for others that the master knows: one that was killed never comes."""


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
