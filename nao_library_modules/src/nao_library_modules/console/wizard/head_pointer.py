"""Turns the head by a click on a camera picture, or by dragging it.

The only part of the wizard that uses topics itself.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Tuple

import rospy
from sensor_msgs.msg import CameraInfo, JointState

from nao_library_msgs.msg import JointAnglesWithSpeed
from naoqi.errors import NaoError

from ...core.geometry import about, product, rotate
from ...core.goal_checks import robot_facts
from ...core.nao_facts import CAMERA_NAMES, CAMERAS, CameraMount, Head, load_head, look_at
from ...ros.driver_types import spoken
from ...studies.commands import Stopped

Angles = Tuple[float, float]
"""HeadYaw, positive to the left, and HeadPitch, positive down, rad."""
HEAD = ("HeadYaw", "HeadPitch")
DISTANCE = 2.0
"""m that a clicked point is taken to be away. The eye moves by a few cm with the head: what is 0.5 m away is missed by
4 degrees at most, what is farther by less."""


@dataclass(frozen=True)
class CameraLens:
    """A pinhole: focal lengths and centre as shares of the picture's width and height."""

    focal_x: float
    focal_y: float
    centre_x: float = 0.5
    centre_y: float = 0.5

    @staticmethod
    def of(width: int, height: int, k: Tuple[float, ...]) -> CameraLens:
        """From a camera matrix, row by row, in pixels of a picture of this size; raises ValueError if it is none."""
        if len(k) != 9 or width <= 0 or height <= 0 or not (k[0] > 0.0 and k[4] > 0.0):
            raise ValueError(f"no camera matrix for pictures of {width}x{height}: {tuple(k)}")
        return CameraLens(k[0] / width, k[4] / height, k[2] / width, k[5] / height)

    def slopes(self, x: float, y: float) -> tuple[float, float]:
        """Of the ray through a point of the picture: to the right and down, for each m ahead.

        `x`, `y`: from 0 at the left and at the top to 1.
        """
        return (x - self.centre_x) / self.focal_x, (y - self.centre_y) / self.focal_y


def looked_at(head: Head, mount: CameraMount, lens: CameraLens, at: tuple[float, float], now: Angles) -> Angles:
    """Angles that bring a point of the picture into its middle, within what the joints can do.

    `at`: the point, as `CameraLens.slopes` takes it. `now`: angles when the picture was taken.
    """
    right, down = lens.slopes(*at)
    yaw, pitch = now
    turned = product(about((0.0, 0.0, 1.0), yaw), about((0.0, 1.0, 0.0), pitch))
    ray = rotate(product(turned, about((0.0, 1.0, 0.0), mount.down)), (1.0, -right, -down))
    eye = rotate(turned, (mount.ahead, 0.0, mount.above))
    reach = DISTANCE / math.sqrt(sum(part * part for part in ray))
    x, y, z = (of_eye + reach * of_ray for of_eye, of_ray in zip(eye, ray))
    return within_limits(look_at(head, mount, (x, y, z + head.height)))


def dragged(lens: CameraLens, start: tuple[float, float], at: tuple[float, float], before: Angles) -> Angles:
    """Angles that keep what was under the pointer under it, within what the joints can do.

    `start`, `at`: where the drag began and where it is. `before`: angles when it began.
    """
    (right0, down0), (right1, down1) = lens.slopes(*start), lens.slopes(*at)
    yaw, pitch = before
    return within_limits((yaw + math.atan(right1) - math.atan(right0), pitch - (math.atan(down1) - math.atan(down0))))


def within_limits(angles: Angles) -> Angles:
    """The closest angles that the joints can have; the pitch may have to stay below that, depending on the yaw."""
    (yaw_low, yaw_high), (pitch_low, pitch_high) = head_limits()
    return min(max(angles[0], yaw_low), yaw_high), min(max(angles[1], pitch_low), pitch_high)


@lru_cache(maxsize=None)
def head_limits() -> tuple[tuple[float, float], tuple[float, float]]:
    """Least and greatest HeadYaw and HeadPitch, rad, of all robots of the family."""
    facts = robot_facts()["ALMotion"]
    names, limits = (
        dict((tuple(asked), answer) for asked, answer in facts[method])[("Body",)]
        for method in ("getBodyNames", "getLimits")
    )
    of = dict(zip(names, limits))
    return tuple((of[joint][0], of[joint][1]) for joint in HEAD)  # type: ignore[return-value]


ANGLES, STATES = "joint_angles", "joint_states"
PATIENCE = 3.0
"""s of this computer that the first message may take."""
DRAG_SPEED, LOOK_SPEED = 0.3, 0.15
"""Fractions of the joints' top speed."""
_NAMES = {name: CAMERA_NAMES[number] for number, name in CAMERAS.items()}


class NoHead(NaoError):
    """The head cannot be turned by a picture; the text tells what is missing."""


class HeadPointer:
    """Pointing on the pictures of one robot, for one page. One thread at a time.

    Nothing is subscribed before the first pointing, and all of it ends with `close`.

    ROS API:
        Publishes `joint_angles` (nao_library_msgs/JointAnglesWithSpeed). Subscribes `joint_states` and, of the cameras
        that are pointed on, `nao_robot/camera/NAME/camera_info`.
    """

    def __init__(self, robot: Any) -> None:
        """`robot`: the `RobotClient`."""
        self._robot = robot
        self._ends: list[Callable[[], None]] = []
        self._changed = threading.Condition()
        self._now: Angles | None = None
        self._lenses: dict[str, CameraLens] = {}
        self._asked: set[str] = set()
        self._publisher: Any = None
        self._drag: tuple[CameraLens, tuple[float, float], Angles, int] | None = None

    def point(self, kind: str, camera: str, x: float, y: float, by: str, stops: int | None = None) -> None:
        """Take one event of the picture.

        Args:
            kind: click looks at the point; start, drag and end move the picture along.
            camera: top or bottom.
            x: Place in the picture, from 0 at the left to 1.
            y: The same, from 0 at the top.
            by: User who points.
            stops: Stops of the robot when it was pointed; None: as many as now.

        Raises:
            NoHead: The driver or the camera does not run.
            Stopped: The robot was stopped since, or since the drag began.
        """
        stops = self._robot.stops if stops is None else stops
        if kind == "click":
            lens, now = self._lens(camera), self._angles()
            head = load_head()
            angles = looked_at(head, head.cameras[_NAMES[camera]], lens, (x, y), now)
            self._send(angles, LOOK_SPEED, stops)
            told = f"looks at a point of the {camera} picture"
            self._robot.events.add("looked", told, by, camera=camera, x=x, y=y, angles=list(angles))
        elif kind == "start":
            self._drag = (self._lens(camera), (x, y), self._angles(), stops)
        elif self._drag is not None:
            lens, start, before, stops = self._drag
            angles = dragged(lens, start, (x, y), before)
            self._send(angles, DRAG_SPEED, stops)
            if kind == "end":
                self._drag = None
                told = f"turns the head by the {camera} picture"
                self._robot.events.add("looked", told, by, camera=camera, angles=list(angles))

    def close(self) -> None:
        """Forget the robot."""
        for end in self._ends:
            end()
        self._ends.clear()
        if self._publisher is not None:
            self._publisher.unregister()
            self._publisher = None

    def _send(self, angles: Angles, speed: float, stops: int) -> None:
        if stops != self._robot.stops:
            self._drag = None
            raise Stopped("the robot was stopped: point again")
        self._publisher.publish(JointAnglesWithSpeed(joint_names=list(HEAD), joint_angles=list(angles), speed=speed))

    def _angles(self) -> Angles:
        if self._publisher is None:
            connected = threading.Event()
            self._publisher = rospy.Publisher(
                self._robot.namespace + ANGLES,
                spoken(JointAnglesWithSpeed, self._robot.namespace),
                subscriber_listener=_Connected(connected),
                queue_size=1,
                tcp_nodelay=True,
            )
            self._ends.append(self._robot.topic(STATES, JointState, self._on_states))
            connected.wait(PATIENCE)
        if not self._publisher.get_num_connections():
            raise NoHead("nobody takes joint_angles: the driver's part nao_controller does not run")
        with self._changed:
            if not self._changed.wait_for(lambda: self._now is not None, PATIENCE):
                raise NoHead("nobody tells where the head is: the driver's part nao_joint_states does not run")
            return self._now  # type: ignore[return-value]

    def _lens(self, camera: str) -> CameraLens:
        if camera not in _NAMES:
            raise NoHead(f"there is no camera {camera!r}: there are {', '.join(_NAMES)}")
        if camera not in self._asked:
            self._asked.add(camera)
            topic = f"nao_robot/camera/{camera}/camera_info"
            self._ends.append(self._robot.topic(topic, CameraInfo, lambda info: self._on_lens(camera, info)))
        with self._changed:
            if not self._changed.wait_for(lambda: camera in self._lenses, PATIENCE):
                raise NoHead(f"nobody tells what the {camera} camera sees: the driver's part nao_camera does not run")
            return self._lenses[camera]

    def _on_states(self, states: JointState) -> None:
        of = dict(zip(states.name, states.position))
        if all(joint in of for joint in HEAD):
            with self._changed:
                self._now = (of[HEAD[0]], of[HEAD[1]])
                self._changed.notify_all()

    def _on_lens(self, camera: str, info: CameraInfo) -> None:
        try:
            lens = CameraLens.of(info.width, info.height, tuple(info.K))
        except ValueError:
            return
        with self._changed:
            self._lenses[camera] = lens
            self._changed.notify_all()


class _Connected(rospy.SubscribeListener):
    """Sets an event once somebody subscribes."""

    def __init__(self, event: threading.Event) -> None:
        self._event = event

    def peer_subscribe(self, topic_name: str, topic_publish: Any, peer_publish: Any) -> None:
        self._event.set()
