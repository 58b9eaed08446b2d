"""Parameters of the picture, set and read at the robot. No ROS."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Mapping
from typing import Any

from naoqi.errors import CallTimeout, NaoError, RobotUnreachable, UnknownModule

from ...nao.camera_facts import CAMERA_NAMES
from .camera_settings import TUNINGS

log = logging.getLogger(__name__)

NO_ANSWER = (RobotUnreachable, UnknownModule, CallTimeout)
"""A robot that is gone, still starting, or busy: nothing is known about its camera then, and asking again may help."""


class CameraTuning:
    """Sets chosen values, again on a robot that has forgotten them, and leaves the rest as it is.

    They belong to the camera: other subscribers see the same. Any thread may call; the lock is held during calls to the
    robot, so that values of two callers do not mix. `ask` calls a method of ALVideoDevice.
    """

    def __init__(self, ask: Callable[..., Any], chosen: Mapping[str, int]) -> None:
        self._ask = ask
        self._chosen = dict(chosen)
        self._missing: set[tuple[int, str]] = set()  # not there when it was read
        self._told: set[tuple[int, str]] = set()
        self._lock = threading.Lock()

    def choose(self, camera: int, values: Mapping[str, int], connected: bool) -> None:
        """Set values, now if the robot is connected, and on a robot that comes later.

        Raises NaoError if the camera cannot be set to one of them; then none is set.
        """
        with self._lock:
            if connected:
                self._set(camera, self._possible(camera, values))
            self._chosen.update(values)

    def set_again(self, camera: int) -> None:
        """Set all chosen values; refusals are logged. Raises one of `NO_ANSWER`."""
        with self._lock:
            for name in TUNINGS:
                if name not in self._chosen:
                    continue
                try:
                    self._set(camera, self._possible(camera, {name: self._chosen[name]}))
                except NO_ANSWER:
                    raise
                except NaoError as error:
                    log.warning("%s", error)

    def read(self, camera: int) -> dict[str, int]:
        """Name -> value of all that the camera has; raises one of `NO_ANSWER`."""
        values = {}
        with self._lock:
            for name, tuning in TUNINGS.items():
                if (camera, name) in self._missing:
                    continue
                try:
                    value = self._ask("getParameter", camera, tuning.id)
                except NO_ANSWER:
                    raise
                except NaoError as error:
                    log.debug("%s has no %s: %s", CAMERA_NAMES[camera], name, error)
                    self._missing.add((camera, name))
                    continue
                if isinstance(value, int):
                    values[name] = value
        return values

    def _possible(self, camera: int, values: Mapping[str, int]) -> dict[str, int]:
        """Those of the values that this camera has, in the order in which it takes them.

        Raises NaoError if one is out of the camera's range.
        """
        possible = {}
        for name in (name for name in TUNINGS if name in values):
            limits = self._range(camera, name)
            if limits is None:
                continue
            lowest, highest = limits
            if not lowest <= values[name] <= highest:
                asked = f"{name} is {values[name]}"
                raise NaoError(f"{asked}: the robot's {CAMERA_NAMES[camera]} takes {lowest} to {highest}")
            possible[name] = values[name]
        return possible

    def _range(self, camera: int, name: str) -> tuple[int, int] | None:
        """Least and greatest value; None, and one warning, if the camera does not have the parameter."""
        try:
            lowest, highest = self._ask("getParameterRange", camera, TUNINGS[name].id)[:2]
        except NO_ANSWER:
            raise
        except NaoError as error:
            if (camera, name) not in self._told:
                log.warning("the robot's %s has no %s, which is left out", CAMERA_NAMES[camera], name)
            log.debug("%s of %s: %s", name, CAMERA_NAMES[camera], error)
            self._told.add((camera, name))
            return None
        return lowest, highest

    def _set(self, camera: int, values: Mapping[str, int]) -> None:
        for name, value in values.items():
            automatic = TUNINGS[name].automatic
            if automatic and self._ask("getParameter", camera, TUNINGS[automatic].id):
                continue  # the camera chooses it, and would refuse
            if self._ask("setParameter", camera, TUNINGS[name].id, value) is False:
                raise NaoError(f"the robot's {CAMERA_NAMES[camera]} refuses {name} {value}")
