"""What ALMemory keeps: data, events and micro events, their descriptions, history and subscribers. No libqi here.

Keys of sensors and motors are *live*: nothing is written for them, a reader computes the value when it is asked for.
Any thread may call anything; subscribers are called outside the lock, in the thread that raised the event.
"""

from __future__ import annotations

import threading
from collections import deque
from dataclasses import dataclass, field
from typing import Any, Callable, Hashable, Iterable, Mapping, Sequence

from nao_sim_bridge.base.errors import UnknownName
from nao_sim_bridge.base.guard import Guard
from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.naoqi.binding.arguments import known
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.memory.room import History, MemoryRoom, size_of

DATA, EVENT, MICRO_EVENT = "Data", "Event", "MicroEvent"
HISTORY_LENGTH = 32
# Calls that wait for a change; with one more the oldest is given up, as libqi does not tell when who waits has gone.
MOST_WAITING = load_sizes().clients.changes
# What clients make beside values and subscriptions.
KEY, DESCRIPTION, SIGNAL = object(), object(), object()
NOTHING: History = deque(maxlen=HISTORY_LENGTH)
KEY_ADDED, KEY_REMOVED = "ALMemory/KeyAdded", "ALMemory/KeyRemoved"

Subscriber = Callable[[str, Any, str], None]
Reader = Callable[[], Any]


@dataclass
class _Entry:
    kind: str
    value: Any = None
    time: float = 0.0
    exists: bool = False
    description: str = ""
    extractor: str = ""
    history: History = field(default_factory=lambda: deque(maxlen=HISTORY_LENGTH))


class MemoryStore:
    """Keys and what they hold; the `clock` gives time stamps, s since 1970 (or since the start of the simulation).

    What is written `by_client` counts (see `MemoryRoom`), and is refused with a NaoqiError where there is no room. The
    `guard` calls subscribers, listeners and watchers. An event is raised under its `older` names, too.
    """

    def __init__(
        self, clock: Callable[[], float], guard: Guard | None = None, older: Mapping[str, Sequence[str]] = {}
    ) -> None:
        self._clock = clock
        self._older = older
        self._guard = guard or Guard()
        self._lock = threading.RLock()
        self._entries: dict[str, _Entry] = {}
        self._room = MemoryRoom()
        self._live: dict[str, tuple[Reader, Callable[[Any], None] | None]] = {}
        self._subscribers: dict[str, dict[str, tuple[Subscriber, str]]] = {}
        self._listeners: dict[str, list[Callable[[Any], None]]] = {}
        self._changes: dict[Task, str] = {}  # what waits for a change of which key, first come first
        self._watchers: dict[str, Callable[[str, list[str]], None]] = {}

    # --- data -----------------------------------------------------------------------------------------------------

    def add_live(self, readers: Mapping[str, Reader], writers: Mapping[str, Callable[[Any], None]] = {}) -> None:
        """Keys whose value is computed when read; `writers` take values for those that may be written."""
        with self._lock:
            for key, reader in readers.items():
                self._live[key] = (reader, writers.get(key))
                self._entries.setdefault(key, _Entry(DATA, exists=True))

    def get(self, key: str) -> Any:
        """Value of a key; an UnknownName when it holds nothing."""
        live = self._live.get(key)
        if live is not None:
            return live[0]()
        with self._lock:
            return self._entry(key).value

    def get_many(self, keys: Iterable[str]) -> list[Any]:
        """Values of several keys; None for a key that holds nothing."""
        with self._lock:
            return [self.get(k) if self._holds(k) else None for k in keys]

    def insert(self, key: str, value: Any, by_client: bool = False) -> None:
        """Write one key, creating it when needed.

        A NaoqiError when the key belongs to a sensor, or a client has no room for it.
        """
        if key in self._live:
            writer = self._live[key][1]
            if writer is None:
                raise NaoqiError(f"{key} is a sensor of the robot and cannot be written")
            writer(value)
            return
        self._write(key, value, DATA, by_client)

    def remove(self, key: str, kind: str | None = None) -> None:
        """Delete a key, its description and its subscribers.

        An UnknownName when there is no such key (of that kind).
        """
        with self._lock:
            if key in self._live:
                raise NaoqiError(f"{key} belongs to the robot and cannot be removed")
            entry = self._entries.get(key)
            if entry is None or (kind is not None and entry.kind != kind):
                raise UnknownName(kind or "key", key, self._names(kind))
            del self._entries[key]
            self._room.forget(entry.history)
            for holder in (KEY, DESCRIPTION, SIGNAL):
                self._room.release((holder, key))
            for module in self._subscribers.pop(key, ()):
                self._room.release((key, module))
            self._listeners.pop(key, None)
        self._announce(KEY_REMOVED, key)

    def kind(self, key: str) -> str:
        """Data, Event or MicroEvent."""
        with self._lock:
            return self._known(key).kind

    def timestamp(self, key: str) -> tuple[Any, float]:
        """Value of a key and the time it was written, s; a live key was written just now."""
        if key in self._live:
            return self.get(key), self._clock()
        with self._lock:
            entry = self._entry(key)
            return entry.value, entry.time

    def names(self, kind: str | None = None, containing: str = "") -> list[str]:
        """Sorted names of the keys of one kind, or of all."""
        with self._lock:
            return sorted(n for n in self._names(kind) if containing in n)

    def set_description(self, key: str, text: str) -> None:
        """Attach a text to a key, for a client."""
        with self._lock:
            entry = self._known(key)
            self._room.hold((DESCRIPTION, key), text)
            entry.description = text

    def describe(self, keys: Iterable[str]) -> list[list[str]]:
        """[key, kind, description] of the keys, of all when there are none."""
        with self._lock:
            chosen = list(keys) or sorted(self._entries)
            return [[k, self.kind(k), self._entries[k].description] for k in chosen]

    def next_change(self, key: str) -> Task:
        """A task that ends with the value that is written next; nothing is left of one that is killed.

        An UnknownName when there is no such key, a NaoqiError when the key is never written.
        """
        change = Task("getDataOnChange", 0, ask=lambda task: task.kill())
        with self._lock:
            self.kind(key)
            self._check_written(key)
            given_up = next(iter(self._changes)) if len(self._changes) >= MOST_WAITING else None
            self._changes[change] = key
        change.add_done_callback(self._forget_change)
        if given_up is not None:
            given_up.finish(error=NaoqiError(f"given up: more than {MOST_WAITING} calls wait for changes"))
        return change

    # --- events ---------------------------------------------------------------------------------------------------

    def declare_event(self, name: str, extractor: str = "", by_client: bool = False) -> None:
        """Make an event known, which becomes a key without a value yet."""
        with self._lock:
            entry = self._made(name, EVENT, by_client, extractor)
            entry.kind = EVENT
            entry.extractor = extractor or entry.extractor

    def raise_event(self, name: str, value: Any, by_client: bool = False) -> None:
        """Write an event and tell its subscribers."""
        self._write(name, value, EVENT, by_client)
        for older in self._older.get(name, ()):
            self._write(older, value, EVENT, by_client)

    def raise_micro_event(self, name: str, value: Any, by_client: bool = False) -> None:
        """Write a micro event and tell its subscribers."""
        self._write(name, value, MICRO_EVENT, by_client)

    def events_of(self, extractor: str) -> list[str]:
        with self._lock:
            return sorted(n for n, e in self._entries.items() if e.kind == EVENT and e.extractor == extractor)

    def put_quietly(self, name: str, value: Any) -> None:
        """Write an event's value for whoever asks, and tell nobody: at the beginning, or when what it said is over."""
        with self._lock:
            entry = self._entries.setdefault(name, _Entry(EVENT))
            entry.value, entry.time, entry.exists = value, self._clock(), True

    def history(self, name: str) -> list[tuple[Any, float]]:
        """The last values of an event or key with their times, oldest first."""
        with self._lock:
            if name not in self._entries:
                raise UnknownName("event", name, self._names(EVENT))
            return [(value, time) for value, time, _ in self._entries[name].history]

    def subscribe(
        self,
        name: str,
        module: str,
        callback: Subscriber,
        message: str = "",
        kind: str = EVENT,
        by_client: bool = False,
    ) -> None:
        """Call `callback(name, value, message)` at each event; one subscription for each module and event."""
        with self._lock:
            entry = self._made(name, kind, by_client)
            if by_client:
                self._room.hold((name, module), name, module, message)
            if entry.kind == DATA:
                entry.kind = kind
            self._subscribers.setdefault(name, {})[module] = (callback, message)
        self._tell_watcher(name)

    def unsubscribe(self, name: str, module: str) -> None:
        """End a subscription; a NaoqiError when the module is not subscribed."""
        with self._lock:
            if module not in self._subscribers.get(name, {}):
                known = ", ".join(self.subscribers(name)) or "nobody"
                raise NaoqiError(f"module {module!r} is not subscribed to {name!r}; subscribed is {known}")
            del self._subscribers[name][module]
            self._room.release((name, module))
        self._tell_watcher(name)

    def forget_module(self, module: str) -> None:
        """End every subscription of a module that is gone."""
        with self._lock:
            left = [name for name, modules in self._subscribers.items() if modules.pop(module, None)]
            for name in left:
                self._room.release((name, module))
        for name in left:
            self._tell_watcher(name)

    def watch_subscribers(self, name: str, watcher: Callable[[str, list[str]], None]) -> None:
        """Call `watcher(name, modules)` outside the lock when somebody has subscribed to an event or left it."""
        with self._lock:
            self._watchers[name] = watcher

    def subscribers(self, name: str) -> list[str]:
        with self._lock:
            return sorted(self._subscribers.get(name, {}))

    def hold(self, name: str, what: Hashable = SIGNAL, *values: Any) -> None:
        """Count what a client has made beside keys: the signal of an event, or something else with its values.

        A NaoqiError when there is no room for it, or the key is never written.
        """
        with self._lock:
            self._check_written(name)
            self._room.hold((what, name), name, *values)

    def release(self, name: str, what: Hashable) -> None:
        """Count it no more."""
        with self._lock:
            self._room.release((what, name))

    def listen(self, name: str, listener: Callable[[Any], None], declare: bool = True) -> None:
        """Call `listener(value)` once at each event; for the signals of qi-style subscribers, which clients make.

        One that listens already goes on; `declare` says whether the event becomes known by it.
        """
        with self._lock:
            if declare:
                self._made(name, EVENT, by_client=True)
            listeners = self._listeners.setdefault(name, [])
            if not any(known is listener for known in listeners):
                listeners.append(listener)

    def close(self) -> None:
        """Tell nobody anything any more."""
        with self._lock:
            for table in (self._subscribers, self._listeners, self._changes, self._watchers):
                table.clear()

    def _forget_change(self, change: Task) -> None:
        with self._lock:
            self._changes.pop(change, None)

    def _tell_watcher(self, name: str) -> None:
        watcher = self._watchers.get(name)
        if watcher is not None:
            self._guard.call(watcher, name, self.subscribers(name))

    def _made(self, key: str, kind: str, by_client: bool, extractor: str = "") -> _Entry:
        """The entry of a key, made when there is none; a NaoqiError for one that is never written."""
        self._check_written(key)
        entry = self._entries.get(key)
        if entry is None:
            if by_client:
                self._room.hold((KEY, key), key, extractor)
            entry = self._entries[key] = _Entry(kind)
        return entry

    def _check_written(self, key: str) -> None:
        if key in self._live:
            raise NaoqiError(f"{key} is measured when it is read and never written; read it with getData")

    def _write(self, key: str, value: Any, kind: str, by_client: bool = False) -> None:
        now, size = self._clock(), size_of(value) if by_client else 0
        with self._lock:
            if by_client:  # before the key is made: it stays away when there is no room
                self._room.make(self._entries[key].history if key in self._entries else NOTHING, size)
            entry = self._made(key, kind, by_client)
            if kind != DATA:
                entry.kind = kind
            is_new = not entry.exists
            entry.value, entry.time, entry.exists = value, now, True
            self._room.add(entry.history, value, now, size)
            changes = [change for change, awaited in self._changes.items() if awaited == key]
            listeners = list(self._listeners.get(key, ())) if entry.kind != DATA else []
            subscribers = list(self._subscribers.get(key, {}).values()) if entry.kind != DATA else []
        for change in changes:
            change.finish(value)
        for listener in listeners:
            self._guard.call(listener, value)
        for subscriber, message in subscribers:
            self._guard.call(subscriber, key, value, message)
        if is_new and key not in (KEY_ADDED, KEY_REMOVED):
            self._announce(KEY_ADDED, key)

    def _announce(self, event: str, key: str) -> None:
        """Tell who wants to know that keys come and go; nothing is kept when nobody does."""
        if self._subscribers.get(event) or self._listeners.get(event):
            self._write(event, key, EVENT)

    def _holds(self, key: str) -> bool:
        return key in self._live or (key in self._entries and self._entries[key].exists)

    def _entry(self, key: str) -> _Entry:
        entry = self._known(key)
        if not entry.exists:  # an event that is declared, and was never raised
            raise UnknownName("value of key", key, ())
        return entry

    def _known(self, key: str) -> _Entry:
        return self._entries[known(key, "key", self._entries)]

    def _names(self, kind: str | None) -> list[str]:
        return [n for n, e in self._entries.items() if kind is None or e.kind == kind]
