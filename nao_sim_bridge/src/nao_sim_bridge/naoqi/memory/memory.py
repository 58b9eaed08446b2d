"""ALMemory of the simulated robot; its keys and events are in `store`."""

from __future__ import annotations

import threading
from typing import Any

import qi

from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.naoqi.binding.background import Background
from nao_sim_bridge.naoqi.binding.client_calls import answer
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.memory.store import EVENT, MICRO_EVENT, MemoryStore

FOUND = load_sizes().clients.found_s
"""s of wall time that a client's service has to have its signal connected to."""


class EventSubscriber:
    """What `ALMemory.subscriber` returns: an object whose member `signal` fires with each value of the event."""

    def __init__(self) -> None:
        # No qi.Signal: qi 3.1.5 never lets go of what one was raised with; of a property it keeps the last value.
        self.signal = qi.Property("m")


class EventSignal:
    """Tells the clients that are connected to an event; called with each of its values.

    `ALMemory.subscriber` gives the same `answer` each time: of each Python object that qi hands over kilobytes stay.
    """

    def __init__(self) -> None:
        subscriber = EventSubscriber()
        self._signal = subscriber.signal
        self.answer = _done(_done(subscriber).value())

    def __call__(self, value: Any) -> None:
        """Fire, without waiting."""
        self._signal.setValue(value, _async=True)


class ALMemory:
    """ALMemory as the simulated robot offers it. Only NAOqi methods live here.

    The broker calls modules of clients without waiting, `call(module, method, arguments)`, and finds any
    `service(name)`.
    """

    def __init__(self, store: MemoryStore, broker: Any) -> None:
        self._store = store
        self._broker = broker
        self._lock = threading.Lock()  # of what is mapped
        self._signals: dict[str, EventSignal] = {}
        # What was mapped: service, signal and event; with the signal and the link to it, None until there is one.
        self._mappings: dict[tuple[str, str, str], tuple[Any, int] | None] = {}
        sizes = load_sizes().clients
        # Not in libqi's own thread: a client may not answer, and others want to call this module meanwhile.
        self._connecting = Background(most=sizes.mapping_calls, threads=sizes.threads)

    def getData(self, key: str, *_deprecated: Any) -> Any:
        return self._store.get(key)

    def getListData(self, keys: Any) -> list:
        return self._store.get_many(_strings(keys, "keyList"))

    def getDataList(self, text: str) -> list[str]:
        return self._store.names(containing=text)

    def getDataListName(self) -> list[str]:
        return self._store.names()

    def getDataOnChange(self, key: str, _deprecated: int) -> Task:
        return self._store.next_change(key)

    def getDataPtr(self, key: str) -> None:
        self._store.kind(key)
        raise NaoqiError("pointers are for modules inside the robot's own process; use getData")

    getFloatPtr = getIntPtr = getDataPtr

    def getDescriptionList(self, keys: list[str]) -> list:
        return self._store.describe(keys)

    def setDescription(self, key: str, description: str) -> None:
        self._store.set_description(key, description)

    def getType(self, key: str) -> str:
        return self._store.kind(key)

    def getTimestamp(self, key: str) -> list:
        value, seconds = self._store.timestamp(key)
        return [value, *_split_time(seconds)]

    def insertData(self, key: str, value: Any) -> None:
        self._store.insert(_name(key), value, by_client=True)

    def insertListData(self, pairs: Any) -> None:
        if not isinstance(pairs, (list, tuple)):
            raise NaoqiError(f"list is {pairs!r}, allowed is [[key, value], ...]")
        for pair in pairs:
            if not isinstance(pair, (list, tuple)) or len(pair) != 2 or not isinstance(pair[0], str):
                raise NaoqiError(f"list holds {pair!r}, allowed is [[key, value], ...]")
        for key, value in pairs:
            self._store.insert(_name(key), value, by_client=True)

    def removeData(self, key: str) -> None:
        self._remove(key)

    def declareEvent(self, name: str, extractor: str = "") -> None:
        self._store.declare_event(_name(name), extractor, by_client=True)

    def raiseEvent(self, name: str, value: Any) -> None:
        self._store.raise_event(_name(name), value, by_client=True)

    def raiseMicroEvent(self, name: str, value: Any) -> None:
        self._store.raise_micro_event(_name(name), value, by_client=True)

    def removeEvent(self, name: str) -> None:
        self._remove(name, EVENT)

    def removeMicroEvent(self, name: str) -> None:
        self._remove(name, MICRO_EVENT)

    def getEventList(self) -> list[str]:
        return self._store.names(EVENT)

    def getMicroEventList(self) -> list[str]:
        return self._store.names(MICRO_EVENT)

    def getExtractorEvent(self, extractor: str) -> list[str]:
        return self._store.events_of(extractor)

    def getEventHistory(self, name: str) -> list:
        return [[value, *_split_time(seconds)] for value, seconds in self._store.history(name)]

    def getSubscribers(self, name: str) -> list[str]:
        return self._store.subscribers(name)

    def subscriber(self, name: str) -> Any:
        if name not in self._signals:
            self._store.hold(name)
            self._signals[name] = EventSignal()
        self._store.listen(name, self._signals[name])
        return self._signals[name].answer

    def subscribeToEvent(self, name: str, module: str, *rest: str) -> None:
        message, method = rest if len(rest) == 2 else ("", rest[0])
        self._subscribe(name, module, message, method, EVENT)

    def unsubscribeToEvent(self, name: str, module: str) -> None:
        self._store.unsubscribe(name, module)

    def subscribeToMicroEvent(self, name: str, module: str, message: str, method: str) -> None:
        self._subscribe(name, module, message, method, MICRO_EVENT)

    unsubscribeToMicroEvent = unsubscribeToEvent

    def subscribeOnDataChange(self, name: str, module: str, message: str, method: str) -> None:
        self._subscribe(name, module, message, method, MICRO_EVENT, only_changes=True)

    def unregisterModuleReference(self, module: str) -> None:
        self._store.forget_module(module)

    def client_gone(self, module: str) -> None:
        """A module of a client has left: it is told nothing more, and its signals are no events any more."""
        self._store.forget_module(module)
        with self._lock:
            gone = [mapped for mapped, link in self._mappings.items() if link and mapped[0] == module]
            for mapped in gone:
                del self._mappings[mapped]
        for mapped in gone:
            self._store.release(mapped[2], mapped)

    def addMapping(self, service: str, *rest: Any) -> Task:
        pairs = rest[0] if len(rest) == 1 else {rest[0]: rest[1]}

        def connect(_: Any) -> None:
            for signal, event in pairs.items():
                self._connect_signal(service, signal, event)

        return self._connecting.in_turn(connect, "addMapping")

    def take_over(self, former: ALMemory) -> None:
        """Go on with the signals that clients are connected to; nobody is told of what the former one had."""
        self._signals = former._signals
        for name, signal in self._signals.items():
            self._store.hold(name)
            self._store.listen(name, signal, declare=False)
        for connected in filter(None, list(former._mappings.values())):
            signal, link = connected
            try:
                signal.disconnect(link)
            except RuntimeError:
                pass  # the client has gone

    def _remove(self, key: str, kind: str | None = None) -> None:
        self._store.remove(key, kind)
        if key in self._signals:  # it is there when the event comes again: qi never lets go of all that it was made of
            self._store.hold(key)

    def _subscribe(
        self, name: str, module: str, message: str, method: str, kind: str, only_changes: bool = False
    ) -> None:
        told: list[Any] = []

        def notify(event: str, value: Any, text: str) -> None:
            if only_changes and told == [value]:
                return
            told[:] = [value]
            self._broker.call(module, method, [event, value, text])

        self._store.subscribe(_name(name), module, notify, message, kind, by_client=True)

    def _connect_signal(self, service: str, signal: str, event: str) -> None:
        mapped = service, signal, event
        with self._lock:
            if mapped in self._mappings:
                return
            self._mappings[mapped] = None
        try:
            self._mappings[mapped] = self._connected(mapped)
        except Exception:
            with self._lock:
                del self._mappings[mapped]
            self._store.release(event, mapped)
            raise

    def _connected(self, mapped: tuple[str, str, str]) -> tuple[Any, int]:
        """The signal of a client's service, and the link to it; its module waits for it."""
        service, signal, event = mapped
        source = self._broker.service(service)
        if not hasattr(source, signal):
            raise NaoqiError(f"service {service!r} has no signal {signal!r}")
        self._store.declare_event(_name(event), by_client=True)
        self._store.hold(event, mapped)
        raising = getattr(source, signal)
        connecting = raising.connect(
            lambda *values: self._store.raise_event(event, _one(values), by_client=True), _async=True
        )
        return raising, answer(connecting, threading.Condition(), lambda: True, FOUND)


def _done(value: Any) -> Any:
    """A libqi future that has a value; an object in it is one of libqi."""
    promise = qi.Promise()
    promise.setValue(value)
    return promise.future()


def _one(values: tuple) -> Any:
    return values[0] if len(values) == 1 else list(values)


def _name(key: str) -> str:
    if not key:
        raise NaoqiError("the key is empty")
    return key


def _strings(values: Any, field: str) -> list[str]:
    if not isinstance(values, (list, tuple)) or not all(isinstance(v, str) for v in values):
        raise NaoqiError(f"{field} is {values!r}, allowed is a list of strings")
    return list(values)


def _split_time(seconds: float) -> tuple[int, int]:
    whole = int(seconds)
    return whole, int((seconds - whole) * 1e6)
