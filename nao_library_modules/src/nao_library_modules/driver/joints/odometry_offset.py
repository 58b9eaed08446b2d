"""Odometry that can be paused, moved and set. Arithmetic only."""

from __future__ import annotations

import threading
from collections.abc import Sequence

from naoqi.errors import NaoError

from ...base.places import ORIGIN, Place


class OdometryOffset:
    """What lies between the robot's own odometry and the one that is published: a place on the floor and a heading.

    Height, roll and pitch of the torso stay those of the robot, so that the frame of odometry keeps level with the
    floor.

    Threads: one corrects readings, others (services) change the offset; the lock guards all of it.
    """

    def __init__(self) -> None:
        """Begin with the robot's own odometry."""
        self._lock = threading.Lock()
        self._offset = ORIGIN
        self._raw: Place | None = None
        self._paused_at: Place | None = None
        self._jumps = 0

    @property
    def paused(self) -> bool:
        """Whether the published odometry stands still."""
        return self._paused_at is not None

    def correct(self, torso: Sequence[float]) -> tuple[tuple[float, ...], int]:
        """The torso in the published odometry.

        Args:
            torso: Its x, y, z (m) and roll, pitch, yaw (rad) in the robot's own odometry.

        Returns:
            The same in the published one, and how often that has jumped: speeds taken across a jump would be wrong.
        """
        x, y, z, roll, pitch, yaw = torso
        with self._lock:
            self._raw = Place(x, y, yaw)
            if self._paused_at is not None:  # whatever the robot thinks it does does not count
                self._offset = self._paused_at.then(self._raw.inverse())
            place, jumps = self._offset.then(self._raw), self._jumps
        return (place.x, place.y, z, roll, pitch, place.yaw), jumps

    def pause(self) -> None:
        """Let the published odometry stand still, for a robot that is carried or slips.

        Raises:
            NaoError: If nothing was read yet.
        """
        with self._lock:
            if self._paused_at is None:
                self._paused_at = self._published()

    def resume(self) -> None:
        """Go on from where the published odometry stands."""
        with self._lock:
            self._paused_at = None

    def move_by(self, way: Place) -> None:
        """Move the torso in the published odometry.

        Args:
            way: In the frame of the torso as published, seen from above.

        Raises:
            NaoError: If nothing was read yet.
        """
        with self._lock:
            self._jump_to(self._published().then(way))

    def set(self, place: Place) -> None:
        """Set where the torso is in the published odometry.

        Raises:
            NaoError: If nothing was read yet.
        """
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
