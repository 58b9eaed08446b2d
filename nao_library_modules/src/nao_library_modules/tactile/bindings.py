"""Behaviours that run when the robot is touched: which touch starts which. No ROS."""

from __future__ import annotations

import contextlib
import logging
import threading
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, Protocol

from naoqi.errors import NaoError

from ..base.cancellation import CancellationToken
from ..nao.touch_names import BY_EVENT, Sensor, names_of
from ..robot.event_relay import EventRelay
from ..robot.event_times import Event, EventTimes
from .touch import Contact, TouchWatch, WantedTouch

log = logging.getLogger(__name__)

IDLE_LOOK = 3600.0
"""s; the thread that follows touches is woken by them, and looks by itself no more often."""


@dataclass(frozen=True)
class Binding:
    """A touch and what it starts."""

    name: str  # what the link is called
    sensors: tuple[Sensor, ...]  # any of them starts it
    wanted: WantedTouch  # what kind of touch
    behavior: str  # name of the behaviour
    parameters: tuple[str, ...] = ()  # its parameters, each as name=value
    cooldown: float = 0.0  # s after its end in which touches do not count


@dataclass(frozen=True)
class BindingState:
    """What became of a binding so far."""

    running: bool = False  # whether its behaviour runs
    runs: int = 0  # how often it was started
    last: str = ""  # how it ended last; empty if it never has
    text: str = ""  # what was said about that
    touched: float = 0.0  # ROS time, s, of the first contact of the touch that started it last; 0 if none has


class BehaviorRunner(Protocol):
    """Runs behaviours; see `runner.py`."""

    def run(self, behavior: str, parameters: Sequence[str], done: Callable[[str, str], None]) -> None:
        """Start a behaviour and go on; `done` gets how it ended and a text, in any thread, exactly once."""

    def close(self) -> None:
        """End what runs."""


@dataclass
class _Entry:
    """A binding at work."""

    binding: Binding
    watch: TouchWatch
    state: BindingState = BindingState()
    ready_at: float = 0.0  # ROS time, s, from which touches count


class TouchBindings:
    """Follows touches and starts behaviours.

    Threads: libqi tells of touches, actionlib of ends; a thread of its own, which lives as long as there is a binding,
    decides what they mean. The lock guards the entries; it is not held during calls to the robot or to the runner.

    Args:
        memory: Gives the proxy of ALMemory.
        runner: Runs behaviours.
        clock: ROS time.
        times: Knows when events were raised.
    """

    def __init__(self, memory: Callable[[], Any], runner: BehaviorRunner, clock: Any, times: EventTimes) -> None:
        self._relay = EventRelay(memory, self._told)
        self._runner = runner
        self._clock = clock
        self._times = times
        self._lock = threading.Lock()
        self._entries: dict[str, _Entry] = {}
        self._touches: deque[Event] = deque()
        self._news = CancellationToken()
        self._thread: threading.Thread | None = None
        self._closed = False

    @property
    def names(self) -> list[str]:
        """Names of the bindings, in the order in which they were made."""
        with self._lock:
            return list(self._entries)

    def states(self) -> list[tuple[Binding, BindingState]]:
        with self._lock:
            return [(each.binding, each.state) for each in self._entries.values()]

    def bind(self, binding: Binding, pressed: Sequence[Contact]) -> None:
        """Start a behaviour at touches from now on; one of the same name is replaced.

        `binding`: the link. `pressed`: sensors that are pressed already. Raises NaoError if the robot cannot be asked
        for the events.
        """
        new = [sensor.event for sensor in binding.sensors if sensor.event not in self._relay.names]
        for event in new:
            self._relay.subscribe(event)
        if new:
            self._times.begin(*new)
        names = names_of(binding.sensors)
        held = {contact.name: contact.begin for contact in pressed if contact.name in names}
        watch = TouchWatch(binding.wanted, held, self._clock.now())
        with self._lock:
            self._entries.pop(binding.name, None)
            self._entries[binding.name] = _Entry(binding, watch)
            if self._thread is None and not self._closed:
                self._thread = threading.Thread(target=self._follow, name="touch bindings", daemon=True)
                self._thread.start()
        self._news.trigger()

    def remove(self, name: str) -> None:
        """Start nothing any more for a binding; empty: for any. What runs goes on."""
        with self._lock:
            removed = [self._entries.pop(each) for each in ([name] if name else list(self._entries))]
            kept = {sensor.event for entry in self._entries.values() for sensor in entry.binding.sensors}
        for event in {sensor.event for entry in removed for sensor in entry.binding.sensors} - kept:
            self._relay.unsubscribe(event)

    def renew(self) -> None:
        """Ask a robot that has come back for the events."""
        self._relay.renew()
        with contextlib.suppress(NaoError):  # it is lost again
            self._times.begin(*self._relay.names)

    def close(self) -> None:
        with self._lock:
            self._closed = True
            self._entries.clear()
            thread = self._thread
        self._news.stop()
        self._relay.close()
        self._runner.close()
        if thread is not None:
            thread.join(1.0)

    def _told(self, event: str, value: Any) -> None:
        """Called from a thread of libqi."""
        self._touches.append(self._times.arrived(event, value, self._clock.now()))
        self._news.trigger()

    def _follow(self) -> None:
        while not self._closed:
            self._news.clear()
            due = self._take_touches(self._clock.now())
            if not self._touches and not self._closed:
                self._clock.wait(max(0.001, due - self._clock.now()), self._news)

    def _take_touches(self, now: float) -> float:
        """Start what the touches until now start; returns when to look again."""
        while self._touches:
            event = self._touches.popleft()
            name, pressed, when = BY_EVENT[event.name].name, bool(event.value), self._time_of(event)
            self._look(lambda entry, n=name, p=pressed, w=when: self._tell(entry, n, p, w))
        return self._look(lambda entry: entry.watch.look(now))

    def _time_of(self, event: Event) -> float:
        try:
            return self._times.time_of(event)
        except NaoError as error:
            log.debug("when %s happened is not known: %s", event.name, error)
            return event.arrived

    @staticmethod
    def _tell(entry: _Entry, name: str, pressed: bool, when: float) -> list[Contact]:
        return entry.watch.tell(name, pressed, when) if name in names_of(entry.binding.sensors) else []

    def _look(self, look: Callable[[_Entry], list[Contact]]) -> float:
        """Start what is touched as wanted, by what `look` says; returns when to look again."""
        now, due, to_start = self._clock.now(), [], []
        with self._lock:
            for entry in self._entries.values():
                touched = look(entry)
                if touched and not entry.state.running and now >= entry.ready_at:
                    began = min(contact.begin for contact in touched)
                    entry.state = replace(entry.state, running=True, runs=entry.state.runs + 1, touched=began)
                    to_start.append(entry)
                if entry.watch.due is not None:
                    due.append(entry.watch.due)
        for entry in to_start:
            self._start(entry)
        return min(due, default=now + IDLE_LOOK)

    def _start(self, entry: _Entry) -> None:
        binding = entry.binding
        log.info("touched: the behaviour %s begins (%s)", binding.behavior, binding.name)

        def done(end: str, text: str) -> None:
            with self._lock:
                entry.state = replace(entry.state, running=False, last=end, text=text)
                entry.ready_at = self._clock.now() + binding.cooldown
            if end not in ("succeeded", "preempted"):
                log.warning("the behaviour %s of %s: %s %s", binding.behavior, binding.name, end, text)

        try:
            self._runner.run(binding.behavior, binding.parameters, done)
        except NaoError as error:
            done("rejected", str(error))
