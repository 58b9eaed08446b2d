"""Sounds of the simulated world as ROS services. Thin over `world_sounds_control.py`."""

from __future__ import annotations

from geometry_msgs.msg import Point

from nao_library_msgs.srv import (
    MoveSound,
    MoveSoundRequest,
    MoveSoundResponse,
    PersonSays,
    PersonSaysRequest,
    PersonSaysResponse,
    PlaceSound,
    PlaceSoundRequest,
    PlaceSoundResponse,
    RemoveSound,
    RemoveSoundRequest,
    RemoveSoundResponse,
)
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.ros.success import success_service
from nao_sim_bridge.server.simulator_server import SimulatorServer

KILLED = "it was silenced before its end"


class RosSounds:
    """Places sounds and lets persons speak.

    ROS API: services `~place_sound`, `~move_sound`, `~remove_sound`, `~person_says` (nao_library_msgs).
    """

    def __init__(self, server: SimulatorServer) -> None:
        self._server = server
        self._services = [
            success_service("~place_sound", PlaceSound, PlaceSoundResponse, self._place, KILLED),
            success_service("~move_sound", MoveSound, MoveSoundResponse, self._move, KILLED),
            success_service("~remove_sound", RemoveSound, RemoveSoundResponse, self._remove, KILLED),
            success_service("~person_says", PersonSays, PersonSaysResponse, self._person_says, KILLED),
        ]

    def _place(self, request: PlaceSoundRequest) -> Task:
        position, level = _listed(request.position), float(request.level_db)
        return self._server.sounds.add(request.name, request.sound, position, level, request.loop)

    def _move(self, request: MoveSoundRequest) -> Task:
        return self._server.sounds.move(request.name, _listed(request.position))

    def _remove(self, request: RemoveSoundRequest) -> Task:
        return self._server.sounds.remove(request.name)

    def _person_says(self, request: PersonSaysRequest) -> Task:
        position, level = _listed(request.position), float(request.level_db)
        return self._server.sounds.person_says(request.text, position, request.voice, level)


def _listed(point: Point) -> list[float]:
    return [point.x, point.y, point.z]
