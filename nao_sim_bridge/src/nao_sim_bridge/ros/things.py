"""Things and sounds of the simulated world as ROS services. Thin over the server."""

from __future__ import annotations

from typing import Any

from geometry_msgs.msg import Point, Pose

from nao_library_msgs import srv
from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.rotations import roll_pitch_yaw
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.ros.services import success_service
from nao_sim_bridge.server.simulator_server import SimulatorServer
from nao_sim_bridge.world.objects import THINGS

SHAPES = ("box", "sphere", "ball", "cylinder", "capsule")
SINGLE = ("sphere", "ball")
"""Shapes that a world file describes by one number."""
BALL_RADIUS = 0.03
"""m, of NAO's red ball: what a ball has that is given no size."""
SIZE_KEY = {"person": "height"}
COLOR_KEY = {"person": "clothes"}
KILLED = "it was stopped on its way"
SILENCED = "it was silenced before its end"


def offer_things(server: SimulatorServer) -> None:
    """Services that place, move and remove things: `~place_object`, `~move_object`, `~remove_object`."""

    def place(request: srv.PlaceObjectRequest) -> Task:
        if not request.description:
            return server.things.place(entry_of(request))
        if request.kind or request.name:
            raise BadValue("description", request.description[:40], "empty when there is a name or a kind")
        return server.things.place_described(request.description)

    def move(request: srv.MoveObjectRequest) -> Task:
        position, turn = _listed(request.pose.position), _turn(request.pose)
        return server.things.move(request.name, position, turn, request.time.to_sec(), request.wait)

    success_service("~place_object", srv.PlaceObject, place, KILLED)
    success_service("~move_object", srv.MoveObject, move, KILLED)
    success_service("~remove_object", srv.RemoveObject, lambda request: server.things.remove(request.name), KILLED)


def offer_sounds(server: SimulatorServer) -> None:
    """Services for sounds and persons who speak: `~place_sound`, `~move_sound`, `~remove_sound`, `~person_says`."""

    def place(request: srv.PlaceSoundRequest) -> Task:
        position, level = _listed(request.position), float(request.level_db)
        return server.sounds.add(request.name, request.sound, position, level, request.loop)

    def move(request: srv.MoveSoundRequest) -> Task:
        return server.sounds.move(request.name, _listed(request.position))

    def person_says(request: srv.PersonSaysRequest) -> Task:
        position, level = _listed(request.position), float(request.level_db)
        return server.sounds.person_says(request.text, position, request.voice, level)

    success_service("~place_sound", srv.PlaceSound, place, SILENCED)
    success_service("~move_sound", srv.MoveSound, move, SILENCED)
    success_service("~remove_sound", srv.RemoveSound, lambda request: server.sounds.remove(request.name), SILENCED)
    success_service("~person_says", srv.PersonSays, person_says, SILENCED)


def entry_of(request: srv.PlaceObjectRequest) -> dict[str, Any]:
    """The entry of a world file that the fields of a request stand for."""
    kinds = [*SHAPES, *(kind for kind in THINGS if kind not in (*SHAPES, "parts"))]  # parts have no content in a text
    if request.kind not in kinds:
        raise BadValue("kind", request.kind, f"one of {', '.join(kinds)}", kinds)
    entry: dict[str, Any] = {"name": request.name, "position": _listed(request.pose.position)}
    turn = _turn(request.pose)
    if turn:
        entry["rpy"] = turn
    size, color = list(request.size), list(request.color)
    if request.kind == "ball":
        size = size or [BALL_RADIUS]
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


def _listed(point: Point) -> list[float]:
    return [point.x, point.y, point.z]


def _turn(pose: Pose) -> list[float]:
    """Roll, pitch and yaw of a pose, rad; [] when it has none."""
    turn = pose.orientation
    length = (turn.x**2 + turn.y**2 + turn.z**2 + turn.w**2) ** 0.5
    if length == 0.0:
        return []
    return list(roll_pitch_yaw([value / length for value in (turn.x, turn.y, turn.z, turn.w)]))
