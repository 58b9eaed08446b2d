"""Odometry that can be paused, moved and set. Arithmetic only."""

from __future__ import annotations

import threading
from collections.abc import Sequence

from naoqi.errors import NaoError

from ...base.places import ORIGIN, Place


class OdometryOffset:
    """The offset of the published odometry from the robot's own: a place on the floor and a heading.

    Height, roll and pitch of the torso stay those of the robot, so that the frame of odometry keeps level with the
    floor. Every change raises NaoError before the first reading.

    Threads: one corrects readings, others (services) change the offset; the lock guards all of it.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._offset = ORIGIN
        self._raw: Place | None = None
        self._paused_at: Place | None = None
        self._jumps = 0

    def correct(self, torso: Sequence[float]) -> tuple[tuple[float, ...], int]:
        """The torso's x, y, z (m) and roll, pitch, yaw (rad) in the published odometry, from those in the robot's own.

        Also how often the published odometry has jumped: speeds taken across a jump would be wrong.
        """
        x, y, z, roll, pitch, yaw = torso
        with self._lock:
            self._raw = Place(x, y, yaw)
            if self._paused_at is not None:  # whatever the robot thinks it does does not count
                self._offset = self._paused_at.then(self._raw.inverse())
            place, jumps = self._offset.then(self._raw), self._jumps
        return (place.x, place.y, z, roll, pitch, place.yaw), jumps

    def pause(self) -> None:
        """Let the published odometry stand still, for a robot that is carried or slips."""
        with self._lock:
            if self._paused_at is None:
                self._paused_at = self._published()

    def resume(self) -> None:
        with self._lock:
            self._paused_at = None

    def move_by(self, way: Place) -> None:
        """Move the torso in the published odometry; the way is in its frame there, seen from above."""
        with self._lock:
            self._jump_to(self._published().then(way))

    def set(self, place: Place) -> None:
        with self._lock:
            self._published()
            self._jump_to(place)

    def _published(self) -> Place:
        if self._raw is None:
            raise NaoError("no odometry of the robot was read yet")
        return self._offset.then(self._raw)

    def _jump_to(self, place: Place) -> None:
        self._offset = place.then(self._raw.inverse())
        if self._paused_at is not None:
            self._paused_at = place
        self._jumps += 1
