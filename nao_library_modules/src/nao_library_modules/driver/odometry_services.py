"""Services that pause, move and set the published odometry."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import rospy
from geometry_msgs.msg import Transform
from std_srvs.srv import Empty, EmptyResponse

from nao_library_msgs.srv import SetTransform, SetTransformResponse
from naoqi.errors import NaoError

from ..errors import BadGoal
from ..places import Place, yaw_of_quaternion
from .odometry_offset import OdometryOffset


def offer_odometry_services(offset: OdometryOffset) -> None:
    """Offer `pause_odometry`, `resume_odometry`, `odometry_offset` and `set_odometry_pose`.

    Args:
        offset: What they change.
    """
    _offer("pause_odometry", Empty, EmptyResponse, lambda _: offset.pause())
    _offer("resume_odometry", Empty, EmptyResponse, lambda _: offset.resume())
    _offer("odometry_offset", SetTransform, SetTransformResponse, lambda r: offset.move_by(read_transform(r.offset)))
    _offer("set_odometry_pose", SetTransform, SetTransformResponse, lambda r: offset.set(read_transform(r.offset)))


def read_transform(transform: Transform) -> Place:
    """What of a transform lies in the plane of the floor.

    Raises:
        BadGoal: If a number is none, or the rotation is no rotation.
    """
    move, turn = transform.translation, transform.rotation
    for name in ("x", "y"):
        if not math.isfinite(getattr(move, name)):
            raise BadGoal(f"offset.translation.{name}", getattr(move, name), "a finite number, in m")
    yaw = yaw_of_quaternion(turn.x, turn.y, turn.z, turn.w)
    if yaw is None:
        given = (turn.x, turn.y, turn.z, turn.w)
        raise BadGoal("offset.rotation", given, "a rotation; w: 1 and the others 0 turns nothing")
    return Place(move.x, move.y, yaw)


def _offer(name: str, kind: type, answer: type, action: Callable[[Any], None]) -> None:
    def serve(request: Any) -> Any:
        try:
            action(request)
        except NaoError as error:
            rospy.logerr("%s: %s", name, error)
            raise rospy.ServiceException(str(error)) from error
        return answer()

    rospy.Service(name, kind, serve)
