"""Frames of /tf seen from above: where the robot is, and where goals in any frame are."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from contextlib import suppress
from functools import lru_cache
from typing import Any

import rospy
import tf2_ros
import yaml
from geometry_msgs.msg import PoseStamped, Transform, TransformStamped
from nav_msgs.msg import Path
from std_msgs.msg import Header

from naoqi.errors import NaoError

from ...core.errors import BadGoal
from ...core.fields import limit, require_length, require_within
from ...core.geometry import Place, product, rotate, yaw_of_quaternion
from ...ros.time_and_frames import pose_of, seen_from_above

PLACE, PLACES = limit("place"), limit("places")
PATIENCE = 2.0
"""s that a frame may take to appear."""
OLDEST = 2.0
"""s that the robot may have been where odometry has it last, also by the clock of its answers: simulated time may be
fast, and a robot that is silent does not say where it is."""


@lru_cache(maxsize=None)
def _frames_of_tf() -> tf2_ros.Buffer:
    """The transforms of /tf: a busy topic, subscribed once a process, at the first question."""
    buffer = tf2_ros.Buffer(debug=False)
    buffer.listener = tf2_ros.TransformListener(buffer)
    return buffer


class PlanarFrames:
    """Looks frames up, in /tf or in the given buffer. Any thread may ask.

    `answering_time`: of the connection to the robot; a robot that is silent is where it was.
    """

    def __init__(self, buffer: Any = None, answering_time: Callable[[], float] = time.monotonic) -> None:
        self._given = buffer
        self._answering_time = answering_time
        self._seen: dict[tuple[str, str], tuple[rospy.Time, float]] = {}

    @property
    def _buffer(self) -> Any:
        return self._given or _frames_of_tf()

    def locate(self, child: str, frame: str, patience: float = PATIENCE) -> Place:
        """Where `child` is in `frame`, by the latest transform, for which it waits up to `patience` s.

        Raises NaoError if they are not connected, or what is known is old.
        """
        transform = self._look_up(frame, child, rospy.Time(), patience)
        stamp = transform.header.stamp
        age = (rospy.Time.now() - stamp).to_sec()
        if stamp and age > OLDEST and self._unchanged(child, frame, stamp) > OLDEST:
            raise NaoError(f"{child} in {frame} was last published {age:.1f} s ago: does nao_joint_states run?")
        return seen_from_above(transform.transform)

    def place_in(self, frame: str, pose: PoseStamped, patience: float = PATIENCE) -> Place:
        """A pose in any frame, seen from above in another one, which it waits for up to `patience` s.

        The time of the pose counts as far back as /tf is known; without one it is the latest.

        Raises NaoError if the frames are not connected.
        """
        origin = pose.header.frame_id.lstrip("/")
        transform = self._look_up(frame, origin, rospy.Time(), patience)
        stamp = pose.header.stamp
        with suppress(NaoError):  # older than what is known
            ahead = stamp > self._buffer.get_latest_common_time(frame, origin)
            transform = self._look_up(frame, origin, stamp, patience if ahead else 0.0)
        move, turn = transform.transform.translation, transform.transform.rotation
        frame_turn = (turn.x, turn.y, turn.z, turn.w)
        point, own = pose.pose.position, pose.pose.orientation
        x, y, _ = rotate(frame_turn, (point.x, point.y, point.z))
        yaw = yaw_of_quaternion(*product(frame_turn, (own.x, own.y, own.z, own.w)))
        return Place(x + move.x, y + move.y, yaw or 0.0)

    def inside(self, frame: str, outer: str) -> bool:
        """Whether a frame is a descendant of another one, or that frame itself."""
        parents = yaml.safe_load(self._buffer.all_frames_as_yaml()) or {}
        seen = set()
        while frame != outer and isinstance(parents, dict) and frame in parents and frame not in seen:
            seen.add(frame)
            frame = str(parents[frame]["parent"])
        return frame == outer

    def _unchanged(self, child: str, frame: str, stamp: rospy.Time) -> float:
        """For how long, in s of the robot's answers, old transforms with this stamp have been found."""
        now = self._answering_time()
        last, since = self._seen.get((child, frame), (None, now))
        self._seen[child, frame] = (stamp, since if last == stamp else now)
        return now - self._seen[child, frame][1]

    def _look_up(self, frame: str, child: str, stamp: rospy.Time, patience: float) -> TransformStamped:
        try:
            return self._buffer.lookup_transform(frame, child, stamp, rospy.Duration.from_sec(patience))
        except (tf2_ros.TransformException, tf2_ros.InvalidArgumentException) as error:
            raise NaoError(f"{child} cannot be found in {frame}: {error}") from error


def read_place(field: str, pose: PoseStamped) -> tuple[Place, str]:
    """Place and frame of a pose, seen from above; `field` is its name for texts.

    Raises BadGoal if a coordinate is no number, the frame has no name or the orientation is no rotation.
    """
    frame = pose.header.frame_id.lstrip("/")
    if not frame:
        raise BadGoal(f"{field}.header.frame_id", frame, "the name of a frame, such as odom or base_footprint")
    place = read_point(field, pose)
    turn = pose.pose.orientation
    yaw = yaw_of_quaternion(turn.x, turn.y, turn.z, turn.w)
    if yaw is None:
        given = f"({turn.x:g}, {turn.y:g}, {turn.z:g}, {turn.w:g})"
        raise BadGoal(
            f"{field}.pose.orientation", given, "a rotation; w: 1 and the others 0 heads along X of its frame"
        )
    return place._replace(yaw=yaw), frame


def read_point(field: str, pose: PoseStamped) -> Place:
    """The point of a pose, with heading 0. Raises BadGoal if a coordinate is no number."""
    point = pose.pose.position
    require_within(f"{field}.pose.position.x", point.x, PLACE)
    require_within(f"{field}.pose.position.y", point.y, PLACE)
    return Place(point.x, point.y, 0.0)


def read_path(path: Path) -> tuple[list[Place], str]:
    """Places and frame of a path. Only the last heading counts; without one it is that of the path.

    Raises BadGoal if a coordinate is no number, the frame has no name, or poses are too many or in different frames.
    """
    require_length("path.poses", len(path.poses), PLACES)
    frames = {pose.header.frame_id.lstrip("/") for pose in path.poses} - {""}
    frame = path.header.frame_id.lstrip("/") or (min(frames) if frames else "")
    if not frame:
        raise BadGoal("path.header.frame_id", frame, "the name of a frame, such as odom or base_footprint")
    if frames - {frame}:
        raise BadGoal("path.poses", sorted(frames), f"all in the frame of the path, {frame}")
    places = [read_point(f"path.poses[{index}]", pose) for index, pose in enumerate(path.poses)]
    if places:
        turn = path.poses[-1].pose.orientation
        yaw = yaw_of_quaternion(turn.x, turn.y, turn.z, turn.w)
        before = next((place for place in reversed(places) if place.distance_to(places[-1]) > 0.0), places[-1])
        along = math.atan2(places[-1].y - before.y, places[-1].x - before.x)
        places[-1] = places[-1]._replace(yaw=along if yaw is None else yaw)
    return places, frame


def read_transform(transform: Transform) -> Place:
    """The part of a transform in the plane of the floor.

    Raises BadGoal if a coordinate is no number, or the rotation is no rotation.
    """
    move, turn = transform.translation, transform.rotation
    for name in ("x", "y"):
        require_within(f"offset.translation.{name}", getattr(move, name), PLACE)
    yaw = yaw_of_quaternion(turn.x, turn.y, turn.z, turn.w)
    if yaw is None:
        given = (turn.x, turn.y, turn.z, turn.w)
        raise BadGoal("offset.rotation", given, "a rotation; w: 1 and the others 0 turns nothing")
    return Place(move.x, move.y, yaw)


def pose_stamped(place: Place, frame: str, stamp: rospy.Time) -> PoseStamped:
    pose = pose_of((place.x, place.y, 0.0, 0.0, 0.0, place.yaw))
    return PoseStamped(Header(stamp=stamp, frame_id=frame), pose)
