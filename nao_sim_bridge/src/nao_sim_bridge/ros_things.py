"""Things of the simulated world as ROS services. Thin over `things_control.py`."""

from __future__ import annotations

from typing import Any, Callable

import rospy
from geometry_msgs.msg import Pose

from nao_library_msgs.srv import (
    MoveObject,
    MoveObjectResponse,
    PlaceObject,
    PlaceObjectResponse,
    RemoveObject,
    RemoveObjectResponse,
)
from nao_sim_bridge.sim.errors import BadValue
from nao_sim_bridge.sim.rotations import roll_pitch_yaw
from nao_sim_bridge.sim.tasks import Task
from nao_sim_bridge.task_success import success_of
from nao_sim_bridge.things_control import ThingsControl

SHAPES = ("box", "sphere", "ball", "cylinder", "capsule")
SINGLE = ("sphere", "ball")
"""Shapes that a world file describes by one number."""
SIZE_KEY = {"person": "height"}
COLOR_KEY = {"person": "clothes"}


class RosThings:
    """Places, moves and removes things.

    ROS API: services `~place_object`, `~move_object`, `~remove_object` (nao_library_msgs).

    Args:
        things: The things of the running simulator.
    """

    def __init__(self, things: ThingsControl) -> None:
        self._things = things
        self._services = [
            rospy.Service("~place_object", PlaceObject, self._on_place),
            rospy.Service("~move_object", MoveObject, self._on_move),
            rospy.Service("~remove_object", RemoveObject, self._on_remove),
        ]

    def _on_place(self, request: PlaceObject) -> PlaceObjectResponse:
        def place() -> Task:
            if not request.description:
                return self._things.place(entry_of(request))
            if request.kind or request.name:
                raise BadValue("description", request.description[:40], "empty when there is a name or a kind")
            return self._things.place_described(request.description)

        return PlaceObjectResponse(*_success(place))

    def _on_move(self, request: MoveObject) -> MoveObjectResponse:
        move = lambda: self._things.move(  # noqa: E731
            request.name, _position(request.pose), _turn(request.pose), request.time.to_sec(), request.wait
        )
        return MoveObjectResponse(*_success(move))

    def _on_remove(self, request: RemoveObject) -> RemoveObjectResponse:
        return RemoveObjectResponse(*_success(lambda: self._things.remove(request.name)))


def entry_of(request: PlaceObject) -> dict[str, Any]:
    """The entry of a world file that the fields of a request stand for."""
    entry: dict[str, Any] = {"name": request.name, "position": _position(request.pose)}
    turn = _turn(request.pose)
    if turn:
        entry["rpy"] = turn
    size, color = list(request.size), list(request.color)
    if request.kind in SHAPES:
        entry[request.kind] = size[0] if request.kind in SINGLE and len(size) == 1 else size
    else:
        entry[request.kind] = request.content
        if len(size) > 1:
            raise BadValue("size", size, f"one number for a {request.kind[:40]}")
        if size:
            entry[SIZE_KEY.get(request.kind, "size")] = size[0]
    if color:
        entry[COLOR_KEY.get(request.kind, "color")] = color
    if request.stand:
        entry["stand"] = True
    if request.mass:
        entry["mass"] = request.mass
    return entry


def _position(pose: Pose) -> list[float]:
    return [pose.position.x, pose.position.y, pose.position.z]


def _turn(pose: Pose) -> list[float]:
    """Roll, pitch and yaw of a pose, rad; [] when it has none."""
    turn = pose.orientation
    length = (turn.x**2 + turn.y**2 + turn.z**2 + turn.w**2) ** 0.5
    if length == 0.0:
        return []
    return list(roll_pitch_yaw([value / length for value in (turn.x, turn.y, turn.z, turn.w)]))


def _success(begin: Callable[[], Task]) -> tuple[bool, str]:
    return success_of(begin, "it was stopped on its way")
