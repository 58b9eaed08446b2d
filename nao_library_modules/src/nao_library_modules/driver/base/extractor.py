"""A module of the robot that looks or listens for something while it is subscribed. No ROS."""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from naoqi.errors import NaoError

from ...robot.event_relay import EventRelay
from ...ros.health import Report
from .lazy_subscription import LazySubscription

log = logging.getLogger(__name__)

MEMORY = "ALMemory"


@dataclass(frozen=True)
class ExtractorKind:
    """A module of the robot that detects something, and what it tells of it."""

    name: str  # for people
    module: str
    event: str
    key: str = ""  # in the robot's memory, of the value of an event without one; else empty
    states: tuple[str, str, str] = ("off", "on", "cannot run")  # in words: not wanted, works, fails


class Extractor:
    """Has the robot detect something while that is wanted, also after a lost connection.

    Any thread may call. Methods raise NaoError if the robot cannot be asked.
    """

    answer_limit = 5.0
    """s that a call to the robot may take."""

    def __init__(
        self,
        robot: Any,
        kind: ExtractorKind,
        subscriber: str,
        sink: Callable[[Any], None],
        prepare: Callable[[], None] = lambda: None,
    ) -> None:
        """Start switched off; the robot need not be connected yet.

        Args:
            kind: Module and event.
            subscriber: Name of the subscriber at the robot.
            sink: Gets the value of each event, in a thread of libqi: it must not wait.
            prepare: Called before the robot begins, for settings that it may have forgotten. May make calls, and choose
                another `kind`.
        """
        self.kind = kind
        self._robot = robot
        self._subscriber = subscriber
        self._sink = sink
        self._prepare = prepare
        self._relay = EventRelay(lambda: robot.proxy(MEMORY), self._on_event)
        self._looking = LazySubscription(robot, kind.name, self._begin, self._end)

    def want(self, wanted: bool) -> None:
        self._looking.want(wanted)

    def enable(self) -> None:
        """Switch on; after an error it is off. No effect if it is on."""
        self._looking.start_now()

    def disable(self) -> None:
        """Switch off, even after an error. No effect if it is off."""
        self._looking.stop_now()

    def call(self, method: str, *arguments: Any, limit: float | None = None) -> Any:
        """Call a method of the module. `limit`: s, if not `answer_limit`."""
        call = self._robot.proxy(self.kind.module).call_async(method, *arguments)
        return call.result(timeout=self.answer_limit if limit is None else limit)

    def report(self) -> Report:
        return self._looking.report(*self.kind.states, {"module": self.kind.module})

    def close(self) -> None:
        self._looking.close()

    def _begin(self) -> None:
        self._prepare()
        self._relay.close()  # events of a connection that was lost
        self._relay.subscribe(self.kind.event)
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
        if self.kind.key and not (isinstance(value, (list, tuple)) and value):
            self._robot.proxy(MEMORY).call_async("getData", self.kind.key).add_done_callback(self._on_value)
        elif self._looking.wanted:
            self._sink(value)

    def _on_value(self, call: Any) -> None:
        try:
            value = call.result(timeout=0)
        except NaoError as error:
            log.debug("%s: %s", self.kind.key, error)
            return
        if self._looking.wanted:
            self._sink(value)
