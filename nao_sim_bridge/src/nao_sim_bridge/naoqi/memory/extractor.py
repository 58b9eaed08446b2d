"""The methods of NAOqi's extractors: modules that work while somebody is subscribed, and raise events.

An extractor's service is made of two parts: an object with the methods of its own, and an `Extractor`. It works from
the first subscriber to the last; periods and precisions are kept and answered, what they mean is up to the module.
"""

from __future__ import annotations

import logging
import threading
from dataclasses import dataclass, replace
from typing import Any, Callable, Mapping, Sequence

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.naoqi.binding.arguments import number
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.memory.store import MemoryStore

DEFAULT_PERIOD_MS = 30
DEFAULT_PRECISION = 0.0
# Names that are subscribed at the same time. Who has gone without a word is not known by a name alone, so of too many
# the one that came first is taken off.
MOST = load_sizes().clients.subscribers
log = logging.getLogger("nao_sim.services")


@dataclass(frozen=True)
class Subscription:
    """What a subscriber asks for: a period in ms, and a precision in 0..1."""

    period: int = DEFAULT_PERIOD_MS
    precision: float = DEFAULT_PRECISION


class Extractor:
    """Subscribers of an extractor, and the methods that NAOqi has for them. Only NAOqi methods are public.

    Args:
        start: Called when the first subscriber comes; when it raises, nobody is subscribed and the caller gets the
            error. A task that it returns is what everybody waits for who subscribes before it has ended. Should it end
            with an error, who waits gets it but is subscribed, until `unsubscribe`.
        stop: Called when the last subscriber has gone.
        keys: Names of the keys that it writes and that are no events.
        default: What a subscriber gets that asks for nothing.
        changed: Called with the subscriptions by name whenever they have changed, before `stop` when nobody is left.
        by_events: Who subscribes to one of its events in ALMemory is a subscriber, too, as long as that lasts.

    `start`, `stop` and `changed` are called in the caller's thread, one at a time and in turn. None may call back here.
    """

    def __init__(
        self,
        module: str,
        memory: MemoryStore,
        start: Callable[[], Any],
        stop: Callable[[], Any],
        events: Sequence[str] = (),
        keys: Sequence[str] = (),
        default: Subscription = Subscription(),
        changed: Callable[[Mapping[str, Subscription]], Any] = lambda _: None,
        by_events: bool = False,
    ) -> None:
        self._start = start
        self._stop = stop
        self._module = module
        self._events = tuple(events)
        self._keys = tuple(keys)
        self._default = default
        self._changed = changed
        self._subscriptions: dict[str, Subscription] = {}
        self._started: Any = None
        self._lock = threading.Lock()
        self._listening: dict[str, frozenset[str]] = {}
        self._followed: set[str] = set()
        self._following = threading.Lock()
        for event in events:
            memory.declare_event(event, module)
            if by_events:
                memory.watch_subscribers(event, self._follow)
                if memory.subscribers(event):  # before there was an extractor
                    self._follow(event, memory.subscribers(event))

    def subscribe(self, name: str, *asked: Any) -> Task | None:
        """Work for `name` from now on; who is subscribed already changes what it asks for."""
        subscription = self._default
        if not name:
            raise BadValue("name", name, "a name, not empty")
        if asked:
            subscription = Subscription(_period(asked[0]), _precision(asked[1]))
        with self._lock:
            if not self._subscriptions:
                self._started = self._start()
            started = self._started
            if name not in self._subscriptions and len(self._subscriptions) >= MOST:
                oldest = next(iter(self._subscriptions))
                log.warning("%s: more than %d are subscribed, %r is taken off", self._module, MOST, oldest)
                del self._subscriptions[oldest]
            self._set(name, subscription)
        return started if isinstance(started, Task) and not started.finished else None

    def unsubscribe(self, name: str) -> None:
        with self._lock:
            self._of(name)
            del self._subscriptions[name]
            self._changed(dict(self._subscriptions))
            if not self._subscriptions:
                self._stop()

    def client_gone(self, module: str) -> None:
        """A module of a client has left: it is subscribed no longer."""
        if module in self._all():
            self.unsubscribe(module)

    def updatePeriod(self, name: str, period: int) -> None:
        checked = _period(period)
        with self._lock:
            self._set(name, replace(self._of(name), period=checked))

    def updatePrecision(self, name: str, precision: float) -> None:
        checked = _precision(precision)
        with self._lock:
            self._set(name, replace(self._of(name), precision=checked))

    def getCurrentPeriod(self) -> int:
        """The smallest period that somebody asks for, ms; that of the module when nobody does."""
        return min((s.period for s in self._all().values()), default=self._default.period)

    def getCurrentPrecision(self) -> float:
        return max((s.precision for s in self._all().values()), default=self._default.precision)

    def getMyPeriod(self, name: str) -> int:
        with self._lock:
            return self._of(name).period

    def getMyPrecision(self, name: str) -> float:
        with self._lock:
            return self._of(name).precision

    def getSubscribersInfo(self) -> list:
        """[[name, period, precision], ...], first come first."""
        return [[name, s.period, s.precision] for name, s in self._all().items()]

    def getEventList(self) -> list[str]:
        return list(self._events)

    def getMemoryKeyList(self) -> list[str]:
        return list(self._keys)

    def getOutputNames(self) -> list[str]:
        return [*self._events, *self._keys]

    def _follow(self, event: str, modules: Sequence[str]) -> None:
        """Subscribe the modules that listen to events, and unsubscribe those that do no more."""
        with self._following:
            self._listening[event] = frozenset(modules)
            wanted = frozenset().union(*self._listening.values())
            for name in sorted(wanted - self._followed - set(self._all())):
                self._followed.add(name)
                self.subscribe(name)
            for name in sorted(self._followed - wanted):
                self._followed.discard(name)
                if name in self._all():  # it may have unsubscribed itself
                    self.unsubscribe(name)

    def _set(self, name: str, subscription: Subscription) -> None:
        self._subscriptions[name] = subscription
        self._changed(dict(self._subscriptions))

    def _all(self) -> Mapping[str, Subscription]:
        with self._lock:
            return dict(self._subscriptions)

    def _of(self, name: str) -> Subscription:
        if name not in self._subscriptions:
            known = ", ".join(map(repr, self._subscriptions)) or "nobody"
            raise NaoqiError(f"{name!r} is not subscribed; subscribed is {known}")
        return self._subscriptions[name]


def _period(value: Any) -> int:
    return int(number(value, "period", 0.0))


def _precision(value: Any) -> float:
    return number(value, "precision", 0.0, 1.0)
