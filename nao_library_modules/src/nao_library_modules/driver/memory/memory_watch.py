"""Watches keys of the robot's memory, by events and by reading, as rules ask for. No ROS."""

from __future__ import annotations

import logging
import math
import threading
from collections import deque
from collections.abc import Callable, Iterable
from typing import Any

from naoqi.errors import NaoError, RobotUnreachable

from ...core.errors import BadGoal
from ...core.health import Level, Report
from ...core.robot_events import EventRelay
from ...core.waiting import CancellationToken
from ..base.polling import FASTEST, RETRY, RateMeter
from .memory_rules import MEMORY, TEXT, MemoryAccess, MemoryRule, MemoryRules, converted, kind_of, matching, topics_of

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
        """Watch a key, without a topic yet.

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
        self._opening: object = None  # identifies the present topic
        self._due: float | None = None
        self._last: float | None = None
        self._held: Any = NOTHING
        self._complained = False

    # --- the topic; for the thread that opens topics --------------------------------------------------------------

    def open(self, value: Any, changed: Callable[[], None]) -> None:
        """Open the topic, or another one for values of another type; nothing happens while the type is unknown.

        `value`: gives the type, unless the rule does; None for no value. `changed`: called when subscribers
        come or all have gone.
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
                changed()

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


KEY_ADDED = "ALMemory/KeyAdded"
CLOSE_LIMIT = 2.0
FOREVER = 1e6


class MemoryWatch:
    """Opens topics for keys, reads data with subscribers, and passes events on; also after a lost connection.

    Threads: that of this object asks the robot and opens topics; so do callers of `watch` and `unwatch`, one of all
    of them at a time (`_work`). Events come in threads of libqi, subscriptions in those of the topics: they change a
    key and wake the thread.
    """

    def __init__(self, robot: Any, clock: Any, make_topic: Callable[..., Any], largest: int) -> None:
        """Watch nothing yet; the robot need not be connected.

        Args:
            clock: Time base of rates.
            make_topic: Opens a topic, see `WatchedKey`.
            largest: Most keys that may be watched at once.
        """
        self._robot = robot
        self._memory = MemoryAccess(robot)
        self._clock = clock
        self._make_topic = make_topic
        self._largest = largest
        self._work = threading.Lock()
        self._rules = MemoryRules()
        self._keys: dict[str, WatchedKey] = {}
        self._meters: dict[float, RateMeter] = {}  # of each rate at which data is read, Hz: its keys are due together
        self._homeless: deque[tuple[WatchedKey, Any]] = deque()  # events that need another topic first
        self._relay = EventRelay(lambda: robot.proxy(MEMORY), self._on_event)
        self._stale = True
        self._generation: int | None = None
        self._problem = self._overflow = ""
        self._news = CancellationToken()
        self._closed = False
        self._rest = CancellationToken()
        robot.connection.add_listener(self._wake)
        self._thread = threading.Thread(target=self._run, name="memory", daemon=True)
        self._thread.start()

    # --- for the node ---------------------------------------------------------------------------------------------

    def watch(self, rules: Iterable[MemoryRule]) -> None:
        """Apply rules, when the robot is connected.

        Raises NaoError if there are more keys than may be watched at once; then nothing changes.
        """
        with self._work:
            former = self._rules.copy()
            for rule in rules:
                rule.check()
                self._rules.add(rule)
            try:
                if self._robot.connection.state == "connected":
                    self._resolve()
            except RobotUnreachable:
                self._stale = True  # the thread sees to it when the robot is back
            except NaoError:
                self._rules = former
                raise
        self._wake()

    def unwatch(self, pattern: str) -> list[str]:
        """Watch keys no longer, and return those that were watched; raises NaoError if the pattern is empty."""
        rule = MemoryRule(pattern, on=False)
        rule.check()
        with self._work:
            self._rules.add(rule)
            ended = matching(self._keys, pattern)
            for key in ended:
                self._drop(key)
        self._wake()
        return ended

    @property
    def rules(self) -> list[MemoryRule]:
        """The rules, the oldest first."""
        with self._work:
            return self._rules.all()

    def watched(self, pattern: str = "") -> dict[str, str]:
        """Key -> topic, empty as long as it has none, of the keys that match a pattern."""
        keys = dict(self._keys)
        return {key: keys[key].topic_name if keys[key].kind else "" for key in matching(keys, pattern)}

    def report(self) -> Report:
        keys = list(self._keys.values())
        values = {
            "keys": str(len(keys)),
            "topics": str(sum(1 for key in keys if key.kind)),
            "with listeners": str(sum(1 for key in keys if key.wanted)),
            "messages": str(sum(key.published for key in keys)),
        }
        if not self._rules:
            return Report(Level.OK, "nothing is watched", values)
        if self._problem or self._overflow:
            return Report(Level.ERROR, self._problem or self._overflow, values)
        problems = []
        for rate, meter in sorted(self._meters.copy().items()):
            facts = meter.values(rate)
            values[f"rate reached of {rate:g} (1/s)"] = facts["rate reached (1/s)"]
            problems += filter(None, [meter.problem(rate)])
        return Report(Level.WARN, "; ".join(problems), values) if problems else Report(Level.OK, "watched", values)

    def close(self) -> None:
        self._robot.connection.remove_listener(self._wake)
        self._closed = True
        self._news.stop()
        self._rest.stop()
        self._thread.join(CLOSE_LIMIT)
        self._relay.close()

    # --- under _work ----------------------------------------------------------------------------------------------

    def _resolve(self) -> None:
        """Watch the keys that the rules select, with their topics."""
        known = self._memory.known() if self._rules else {}
        wanted = self._rules.wanted_of(known)
        if len(wanted) > self._largest:
            problem = f"{len(wanted)} keys are to be watched"
            raise BadGoal("pattern", len(wanted), f"{self._largest} at most (~max_topics)", problem=problem)
        for name in [name for name in self._keys if name not in wanted]:
            self._drop(name)
        new = [name for name in wanted if name not in self._keys]
        topics = topics_of(new, [key.topic_name for key in self._keys.values()])
        for name in new:
            self._keys[name] = WatchedKey(name, topics[name], wanted[name], self._make_topic)
        for name, rule in wanted.items():
            key = self._keys[name]
            changed_kind = key.rule.kind != rule.kind
            key.rule, key.is_event = rule, known.get(name, False)
            if changed_kind:
                key.close()
        self._open_topics()
        if self._rules.has_patterns or any(not key.kind for key in self._keys.values()):
            self._relay.subscribe(KEY_ADDED)
        self._stale, self._overflow = False, ""

    def _open_topics(self) -> None:
        shut = [key for key in self._keys.values() if not key.kind]
        for key, value in zip(shut, self._memory.values([key.name for key in shut])):
            key.open(value, self._wake)

    def _drop(self, name: str) -> None:
        key = self._keys.pop(name)
        self._relay.unsubscribe(name)
        key.close()

    # --- the thread -----------------------------------------------------------------------------------------------

    def _wake(self, *_: Any) -> None:
        self._news.trigger()

    def _run(self) -> None:
        while not self._closed:
            self._news.clear()
            pause = self._look()
            if pause is None:
                self._news.wait(RETRY)  # of wall time: that of a simulator may have stopped with it
            else:
                self._clock.wait(pause, self._news)
                self._rest.wait(FASTEST)  # however fast simulated time runs, or events come

    def _look(self) -> float | None:
        """Do what is due; returns s until the next time, None if that does not work now."""
        try:
            if self._robot.connection.state == "connected":
                with self._work:
                    self._keep_up()
                    pause = self._serve()
                self._problem = ""
                return pause
            problem = "the robot is not connected"
        except RobotUnreachable as error:
            problem = str(error)  # the log has it already, from the connection
        except NaoError as error:
            problem = str(error)
            if problem != self._problem:
                log.warning("the memory cannot be watched: %s", error)
        except Exception as error:  # a mistake in here must not leave a node that lives and says nothing
            problem = f"unexpected error: {error!r}"
            log.exception("the memory cannot be watched")
        self._problem = problem
        return None

    def _keep_up(self) -> None:
        generation = self._robot.connection.generation
        if generation != self._generation:  # the robot behind a new connection knows nothing of what was
            self._relay.close()
            for key in self._keys.values():
                key.subscribed = False
            for meter in self._meters.values():
                meter.restart()  # nothing could be read while there was no robot
            self._stale = True
        if self._stale:
            try:
                self._resolve()
            except BadGoal as error:  # new keys of the robot are too many: what is watched continues
                log.error("%s", error)
                self._overflow, self._stale = str(error), False
        self._generation = generation
        while self._homeless:
            key, value = self._homeless.popleft()
            key.open(value, self._wake)
            key.deliver(value)

    def _serve(self) -> float:
        """Read what is due and publish what was held; returns s until something is due again."""
        self._mind_events()
        now = self._clock.now()
        waits = [FOREVER]
        due, held = [], []
        for key in self._keys.values():
            if key.is_event:
                wait, value = key.release(now)
                if wait == 0.0:
                    held.append((key, value))
                elif wait is not None:
                    waits.append(wait)
            elif key.wanted:
                wait = key.due_in(now)
                if wait > 0.0:
                    waits.append(wait)
                else:
                    due.append(key)
        # libqi brings events that follow each other closely in any order: what was held need not be the newest.
        for (key, value), newest in zip(held, self._memory.values([key.name for key, _ in held])):
            self._hand_over(key, value if newest is None else newest)
        self._measure(now, due)
        for key, value in zip(due, self._memory.values([key.name for key in due])):
            key.was_read(now)
            waits.append(key.due_in(now))
            if value is not None:
                self._hand_over(key, value)
        return min(waits)

    def _measure(self, now: float, due: list[WatchedKey]) -> None:
        """Note that data is read, for each rate; rates of which no key is wanted any more are forgotten."""
        wanted = {key.rate for key in self._keys.values() if key.wanted and not key.is_event}
        for rate in set(self._meters) - wanted:
            del self._meters[rate]
        for rate in {key.rate for key in due}:
            meter = self._meters.setdefault(rate, RateMeter(f"memory keys at {rate:g} Hz", "readings"))
            meter.note(now, rate)

    def _mind_events(self) -> None:
        """Subscribe the events that have subscribers here, or whose type is not known yet; those only."""
        begun = []
        for key in self._keys.values():
            needed = key.is_event and (key.wanted or not key.kind)
            if needed and not key.subscribed:
                self._relay.subscribe(key.name)
                key.to_be_told = True
            elif key.subscribed and not needed:
                self._relay.unsubscribe(key.name)
            key.subscribed = needed
            if needed and key.to_be_told:
                begun.append(key)
        for key, value in zip(begun, self._memory.values([key.name for key in begun])):
            key.to_be_told = False
            if value is not None and key.wanted:
                self._hand_over(key, value)  # a new subscriber gets the present value

    def _hand_over(self, key: WatchedKey, value: Any) -> None:
        if not key.deliver(value):
            key.open(value, self._wake)
            key.deliver(value)

    # --- in threads of libqi --------------------------------------------------------------------------------------

    def _on_event(self, name: str, value: Any) -> None:
        if name == KEY_ADDED and self._rules.rule_for(str(value)) is not None:
            self._stale = True
            self._wake()
        key = self._keys.get(name)
        if key is None:
            return
        if key.hold(value, self._clock.now()) > 0.0:
            self._wake()
        elif not key.deliver(value):
            self._homeless.append((key, value))
            self._wake()
