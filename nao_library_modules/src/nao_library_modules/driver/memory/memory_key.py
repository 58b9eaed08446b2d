"""One watched key of the robot's memory: when it is due, and where its values go. No ROS."""

from __future__ import annotations

import logging
import math
import threading
from collections.abc import Callable
from typing import Any

from .memory_rules import MemoryRule
from .memory_values import TEXT, converted, kind_of

log = logging.getLogger(__name__)

DATA_RATE = 10.0
"""Hz at which data is read for a rule without a rate."""
NOTHING = object()
"""No value is held."""


class WatchedKey:
    """A key, its topic once there is one, and the pace of its messages.

    The lock is held while a value is passed to the topic: events come in several threads of libqi.

    Attributes:
        is_event: Whether the robot raises it as an event.
        subscribed: Whether the event is subscribed; for the thread that subscribes.
        to_be_told: Whether the present value is still to be read since then; for that thread as well.
        wanted: Whether the topic has subscribers.
        kind: Kind of message; empty as long as the type is unknown.
    """

    def __init__(self, name: str, topic_name: str, rule: MemoryRule, make_topic: Callable[..., Any]) -> None:
        """Watch a key; there is no topic yet.

        `make_topic` opens a topic: it gets its name, the kind of message and a function to call with whether there are
        subscribers. It returns an object with `publish(value)` and `close()`.
        """
        self.name = name
        self.topic_name = topic_name
        self.rule = rule
        self.is_event = False
        self.subscribed = self.to_be_told = False
        self.wanted = False
        self.kind = ""
        self.published = 0
        self._make_topic = make_topic
        self._lock = threading.Lock()
        self._topic: Any = None
        self._opening: object = None  # what tells the present topic from those before
        self._due: float | None = None
        self._last: float | None = None
        self._held: Any = NOTHING
        self._complained = False

    # --- the topic; for the thread that opens topics --------------------------------------------------------------

    def open(self, value: Any, tell: Callable[[], None]) -> None:
        """Open the topic, or another one for values of another type; nothing happens while the type is unknown.

        `value`: gives the type, unless the rule does; None for no value. `tell`: called when somebody begins or ceases
        to listen.
        """
        kind = self.rule.kind or ("" if value is None else kind_of(value))
        if not kind or kind == self.kind:
            return
        if self.kind:
            log.warning("%s is %s from now on, not %s: its topic is a new one", self.name, kind, self.kind)
        self.close()

        opening = self._opening = object()

        def demand(wanted: bool) -> None:
            if self._opening is opening:  # listeners leave a topic that was closed, and that means nothing
                self.wanted = wanted
                tell()

        topic = self._make_topic(self.topic_name, kind, demand)
        with self._lock:
            self.kind, self._topic = kind, topic

    def close(self) -> None:
        with self._lock:
            topic, self._topic, self.kind = self._topic, None, ""
            self._opening, self.wanted = None, False
        if topic is not None:
            topic.close()

    def deliver(self, value: Any) -> bool:
        """Publish a value; False if it first needs a topic of another kind."""
        with self._lock:
            if self._topic is None:
                return False
            if value is None and self.kind != TEXT:
                return True  # an event without a value, or a key that is gone, says nothing here
            message = converted(value, self.kind)
            if message is None:
                return self._refuse(value)
            self._topic.publish(message)
            self.published += 1
            return True

    def _refuse(self, value: Any) -> bool:
        if not self.rule.kind:
            return False
        if not self._complained:
            log.warning("%s was to be %s, and is %r: such values are left out", self.name, self.rule.kind, value)
            self._complained = True
        return True

    # --- the pace -------------------------------------------------------------------------------------------------

    @property
    def rate(self) -> float:
        """Most messages a second; 0 for no limit."""
        return self.rule.rate or (0.0 if self.is_event else DATA_RATE)

    @property
    def period(self) -> float:
        """Least time between two messages, s; 0 for no limit."""
        return 1.0 / self.rate if self.rate else 0.0

    def due_in(self, now: float) -> float:
        """Time until data is to be read, s, 0 if it is due now; keys of one rate are due together."""
        if self._due is None or self._due - now > 1.5 * self.period:
            self._due = now  # the first time, or the clock was set back
        return max(self._due - now, 0.0)

    def was_read(self, now: float) -> None:
        self._due = (math.floor(now / self.period + 1e-6) + 1) * self.period

    def hold(self, value: Any, now: float) -> float:
        """Take an event; a newer one replaces it while it is held.

        Returns:
            s until it may be published: 0 for at once.
        """
        with self._lock:
            early = self._last is not None and self._last <= now < self._last + self.period
            if not early:
                self._last = now
                return 0.0
            self._held = value
            return self._last + self.period - now

    def release(self, now: float) -> tuple[float | None, Any]:
        """The event that was held.

        Returns s until it may be published, None if none is held; and the event if that is 0.
        """
        with self._lock:
            if self._held is NOTHING:
                return None, None
            if self._last is not None and self._last <= now < self._last + self.period:
                return self._last + self.period - now, None
            value, self._held, self._last = self._held, NOTHING, now
            return 0.0, value
