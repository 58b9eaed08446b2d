"""Services that pause, move and set the published odometry."""

from __future__ import annotations

from geometry_msgs.msg import Transform
from std_srvs.srv import Empty

from nao_library_msgs.srv import SetTransform

from ...base.errors import BadGoal
from ...base.field_checks import require_within
from ...base.places import Place, yaw_of_quaternion
from ...ros.node_interface import NodeInterface
from .odometry_offset import OdometryOffset
from .planar_frames import PLACE


def offer_odometry_services(node: NodeInterface, offset: OdometryOffset) -> None:
    """Offer `pause_odometry`, `resume_odometry`, `odometry_offset` and `set_odometry_pose`.

    Args:
        node: That offers them.
        offset: What they change.
    """
    node.offer("pause_odometry", Empty, lambda _: offset.pause())
    node.offer("resume_odometry", Empty, lambda _: offset.resume())
    node.offer("odometry_offset", SetTransform, lambda request: offset.move_by(read_transform(request.offset)))
    node.offer("set_odometry_pose", SetTransform, lambda request: offset.set(read_transform(request.offset)))


def read_transform(transform: Transform) -> Place:
    """What of a transform lies in the plane of the floor.

    Raises:
        BadGoal: If a number is none, or the rotation is no rotation.
    """
    move, turn = transform.translation, transform.rotation
    for name in ("x", "y"):
        require_within(f"offset.translation.{name}", getattr(move, name), PLACE)
    yaw = yaw_of_quaternion(turn.x, turn.y, turn.z, turn.w)
    if yaw is None:
        given = (turn.x, turn.y, turn.z, turn.w)
        raise BadGoal("offset.rotation", given, "a rotation; w: 1 and the others 0 turns nothing")
    return Place(move.x, move.y, yaw)
