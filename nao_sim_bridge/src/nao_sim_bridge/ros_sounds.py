"""Sounds of the simulated world as ROS services. Thin over `world_sounds_control.py`."""

from __future__ import annotations

from typing import Callable

import rospy
from geometry_msgs.msg import Point

from nao_library_msgs.srv import (
    MoveSound,
    MoveSoundResponse,
    PersonSays,
    PersonSaysResponse,
    PlaceSound,
    PlaceSoundResponse,
    RemoveSound,
    RemoveSoundResponse,
)
from nao_sim_bridge.sim.tasks import Task
from nao_sim_bridge.task_success import success_of
from nao_sim_bridge.world_sounds_control import WorldSoundsControl


class RosSounds:
    """Places sounds and lets persons speak.

    ROS API: services `~place_sound`, `~move_sound`, `~remove_sound`, `~person_says` (nao_library_msgs).

    Args:
        sounds: The sounds of the running simulator.
    """

    def __init__(self, sounds: WorldSoundsControl) -> None:
        self._sounds = sounds
        self._services = [
            rospy.Service("~place_sound", PlaceSound, self._on_place),
            rospy.Service("~move_sound", MoveSound, self._on_move),
            rospy.Service("~remove_sound", RemoveSound, self._on_remove),
            rospy.Service("~person_says", PersonSays, self._on_person),
        ]

    def _on_place(self, request: PlaceSound) -> PlaceSoundResponse:
        position, level = _listed(request.position), float(request.level_db)
        add = lambda: self._sounds.add(request.name, request.sound, position, level, request.loop)  # noqa: E731
        return PlaceSoundResponse(*_success(add))

    def _on_move(self, request: MoveSound) -> MoveSoundResponse:
        return MoveSoundResponse(*_success(lambda: self._sounds.move(request.name, _listed(request.position))))

    def _on_remove(self, request: RemoveSound) -> RemoveSoundResponse:
        return RemoveSoundResponse(*_success(lambda: self._sounds.remove(request.name)))

    def _on_person(self, request: PersonSays) -> PersonSaysResponse:
        position, level = _listed(request.position), float(request.level_db)
        say = lambda: self._sounds.person_says(request.text, position, request.voice, level)  # noqa: E731
        return PersonSaysResponse(*_success(say))


def _listed(point: Point) -> list[float]:
    return [point.x, point.y, point.z]


def _success(begin: Callable[[], Task]) -> tuple[bool, str]:
    return success_of(begin, "it was silenced before its end")
