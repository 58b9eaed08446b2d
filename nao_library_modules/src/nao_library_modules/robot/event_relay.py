"""Events of the robot's memory, passed on to a sink and subscribed again after a reconnection. No ROS."""

from __future__ import annotations

import logging
import threading
from typing import Any, Callable

from naoqi.errors import NaoError

log = logging.getLogger(__name__)

EventSink = Callable[[str, Any], None]


class EventRelay:
    """Subscriptions to events of ALMemory.

    The sink gets name and value of each event from a thread of libqi, so it must not block. `memory` gives the proxy of
    ALMemory. The lock guards the table of subscriptions; it is not held during calls to the robot or to the sink.
    """

    def __init__(self, memory: Callable[[], Any], sink: EventSink) -> None:
        self._memory = memory
        self._sink = sink
        self._lock = threading.Lock()
        self._links: dict[str, tuple[Any, Any] | None] = {}

    @property
    def names(self) -> list[str]:
        with self._lock:
            return sorted(self._links)

    def subscribe(self, name: str) -> None:
        """Subscribe to an event, unless it is subscribed already.

        Raises NaoError if the robot cannot be asked; then it is not subscribed.
        """
        with self._lock:
            if name in self._links:
                return
            self._links[name] = None  # a second call meanwhile must not subscribe twice
        try:
            self._link(name)
        except NaoError:
            with self._lock:
                self._links.pop(name, None)
            raise

    def unsubscribe(self, name: str) -> None:
        with self._lock:
            link = self._links.pop(name, None)
        self._unlink(name, link)

    def renew(self) -> None:
        """Subscribe to all events again: the robot behind a new connection knows nothing of them."""
        for name in self.names:
            try:
                self._link(name)
            except (NaoError, RuntimeError) as error:  # libqi's own where the connection breaks again meanwhile
                log.warning("event %s could not be subscribed again: %s", name, error)
            else:
                log.info("event %s is subscribed again", name)

    def close(self) -> None:
        for name in self.names:
            self.unsubscribe(name)

    def _link(self, name: str) -> None:
        subscriber = self._memory().subscriber(name)
        link = subscriber.signal.connect(lambda value=None, *_: self._pass_on(name, value))
        with self._lock:
            if name in self._links:
                # The subscriber is kept: the subscription ends with it.
                self._links[name] = (subscriber, link)
                return
        self._unlink(name, (subscriber, link))  # unsubscribed meanwhile

    def _pass_on(self, name: str, value: Any) -> None:
        try:
            self._sink(name, value)
        except Exception:
            log.exception("event %s could not be passed on", name)

    @staticmethod
    def _unlink(name: str, link: tuple[Any, Any] | None) -> None:
        if link is None:
            return
        subscriber, connection = link
        try:
            subscriber.signal.disconnect(connection)
        except (NaoError, RuntimeError) as error:  # a lost robot has forgotten it anyway
            log.debug("event %s: %s", name, error)
