"""A module of the robot that looks for something, switched on and off. No ROS."""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from naoqi.errors import NaoError

from ...robot.event_relay import EventRelay
from ...ros.health import Level, Report
from ..base.lazy_subscription import LazySubscription

log = logging.getLogger(__name__)

MEMORY = "ALMemory"
ANSWER_LIMIT = 5.0
CLOSE_LIMIT = 2.0


@dataclass(frozen=True)
class Kind:
    """What a module looks for.

    Attributes:
        name: For people.
        module: Name of the module.
        event: Event that it raises.
        key: Where in the robot's memory the value is, for an event that has none; else empty.
    """

    name: str
    module: str
    event: str
    key: str = ""


FACES = Kind("face detection", "ALFaceDetection", "FaceDetected")
LANDMARKS = Kind("landmark detection", "ALLandMarkDetection", "LandmarkDetected")
MOVEMENT = Kind(
    "motion detection",
    "ALMovementDetection",
    "MovementDetection/MovementDetected",
    "MovementDetection/MovementInfo",
)


class Detection:
    """Has the robot look for something while that is switched on, after a lost connection as well.

    Any thread may call.
    """

    def __init__(
        self,
        robot: Any,
        kind: Kind,
        subscriber: str,
        sink: Callable[[Any], None],
        prepare: Callable[[], None] = lambda: None,
    ) -> None:
        """Begin switched off; the robot need not be there yet.

        Args:
            robot: Its proxies and connection, see `nao_library_modules.robot`.
            kind: What to look for.
            subscriber: Name under which the robot knows who wants it.
            sink: Gets the value of each event, in a thread of libqi: it must not wait.
            prepare: Called before the robot begins, for settings that it may have forgotten. May make calls.
        """
        self._robot = robot
        self._kind = kind
        self._subscriber = subscriber
        self._sink = sink
        self._prepare = prepare
        self._relay = EventRelay(lambda: robot.proxy(MEMORY), self._on_event)
        self._looking = LazySubscription(robot, kind.name, self._begin, self._end)

    def enable(self) -> None:
        """Look from now on. No effect if it does.

        Raises:
            NaoError: If the robot cannot be asked; then it is switched off.
        """
        self._looking.start_now()

    def disable(self) -> None:
        """Look no longer. No effect if it does not.

        Raises:
            NaoError: If the robot cannot be asked; switched off it is all the same.
        """
        self._looking.stop_now()

    def call(self, method: str, *arguments: Any, limit: float = ANSWER_LIMIT) -> Any:
        """Call a method of the module.

        Raises:
            NaoError: If the call fails, or takes longer than `limit` s.
        """
        return self._robot.proxy(self._kind.module).call_async(method, *arguments).result(timeout=limit)

    def report(self) -> Report:
        """Whether the robot looks."""
        values = {"module": self._kind.module, "last error": self._looking.problem}
        if not self._looking.wanted:
            return Report(Level.OK, "off", values)
        if self._looking.running:
            return Report(Level.OK, "on", values)
        return Report(Level.ERROR, f"cannot run: {self._looking.problem or 'the robot is not connected'}", values)

    def close(self) -> None:
        """Look no longer, for good."""
        self._looking.close(CLOSE_LIMIT)

    def _begin(self) -> None:
        self._prepare()
        for event in self._relay.names:  # those of a connection that was lost
            self._relay.unsubscribe(event)
        self._relay.subscribe(self._kind.event)
        try:
            self.call("subscribe", self._subscriber)
        except NaoError:
            self._relay.close()
            raise

    def _end(self) -> None:
        self._relay.close()
        self.call("unsubscribe", self._subscriber)

    # --- in threads of libqi --------------------------------------------------------------------------------------

    def _on_event(self, _name: str, value: Any) -> None:
        if self._kind.key and not (isinstance(value, (list, tuple)) and value):
            self._robot.proxy(MEMORY).call_async("getData", self._kind.key).add_done_callback(self._on_value)
        elif self._looking.wanted:
            self._sink(value)

    def _on_value(self, call: Any) -> None:
        try:
            value = call.result(timeout=0)
        except NaoError as error:
            log.debug("%s: %s", self._kind.key, error)
            return
        if self._looking.wanted:
            self._sink(value)
