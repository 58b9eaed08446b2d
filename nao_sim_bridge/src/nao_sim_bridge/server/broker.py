"""The simulator's side of libqi: listens as a robot does, registers services, calls modules of clients."""

from __future__ import annotations

import logging
import threading
import time
from collections import deque
from functools import cached_property
from typing import Any, Callable

import qi

from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.base.tasks import WorkThreads
from nao_sim_bridge.naoqi.binding.client_calls import NoAnswer, answer, worth_telling
from nao_sim_bridge.naoqi.binding.wire_types import has_bytes
from nao_sim_bridge.server.answers import Answers
from nao_sim_bridge.server.messages import packed_arguments
from nao_sim_bridge.server.own_sockets import StuckClients, free_port_on_exit, has_clients, is_listened_on, is_taken
from nao_sim_bridge.server.wire import Wires

log = logging.getLogger("nao_sim.broker")

# Connections may hold a port on which nobody listens: how long to keep trying, s. Those of a program that has ended are
# gone after 60 s (TIME_WAIT).
BIND_PATIENCE = 65.0
BIND_PAUSE = 0.5
LISTENS = "another program listens there"
HELD = "a connection of this computer, open or just closed, has that port"
# The thread that calls a client's module ends after this time without a call, s.
CALLER_IDLE = 20.0
# Calls that wait for a client's module; with more it loses the oldest.
WAITING = load_sizes().clients.calls
# Modules that are called at the same time; calls of further ones are lost.
MODULES = load_sizes().clients.called_modules
# How long a module may take to be found, s: one of a program that has stopped is never connected to.
FOUND = load_sizes().clients.found_s
# How often a module that is registered is asked for: a client's libqi now and then answers a new connection's login
# before it takes calls on it, and refuses the first one.
ASKED = 3
# libqi reports services and threads that it adds, and warns that it deduces paths it has no use for here.
QUIET_LIBQI = "qi.path.sdklayout=silent:qi.eventloop=warning:qimessaging.servicedirectory=warning"


class Broker:
    """A libqi session that listens on one address and serves modules, as `name`; its port is known after `listen`."""

    def __init__(self, name: str = "nao_sim") -> None:
        qi.logging.setFilters(QUIET_LIBQI)
        self.name = name
        self.port = 0
        self._session = qi.Session()
        self._services: dict[str, tuple[int, Any]] = {}
        self._callers: dict[str, _Caller] = {}
        self._wires = Wires()
        self._answers = Answers()
        self._gone: Callable[[str], None] = lambda module: None
        self._telling = WorkThreads("modules that have left")
        self._lost = 0
        self._watch: StuckClients | None = None
        self._closed = False
        self._lock = threading.Lock()

    def listen(self, address: str, port: int, still_wanted: Callable[[], bool] = lambda: True) -> None:
        """Listen on `address`:`port`; for port 0 the system gives one. Waits for a port that only connections hold.

        A RuntimeError when the address cannot be had: at once where another program listens.
        """
        cannot, warned = f"cannot listen on {address}:{port}", False
        give_up = time.monotonic() + BIND_PATIENCE
        while is_taken(address, port):
            listens = is_listened_on(port)
            patient = not listens and time.monotonic() <= give_up
            if patient and not warned:
                log.warning("port %d: nobody listens, but %s: waiting up to %g s", port, HELD, BIND_PATIENCE)
                warned = True
            if not patient or not still_wanted():
                raise RuntimeError(f"{cannot}: {LISTENS if listens else HELD}: choose another port, or 0")
            time.sleep(BIND_PAUSE)
        try:
            self._session.listenStandalone(f"tcp://{address}:{port}")
        except RuntimeError as error:
            raise RuntimeError(f"{cannot}: {str(error).strip()}") from error
        self.port = int(self._session.endpoints()[0].rsplit(":", 1)[1])
        free_port_on_exit(self.port)
        self._watch = StuckClients(self.port)

    def register(self, module: str, service: Any) -> None:
        with self._lock:
            self._services[module] = (self._session.registerService(module, service), service)

    def serves(self, module: str) -> bool:
        with self._lock:
            return module in self._services

    def drop_calls(self) -> None:
        """Make no call any more that waits for its turn; the one that is under way goes on."""
        with self._lock:
            for caller in self._callers.values():
                caller.drop()

    def unregister(self, module: str) -> None:
        """Serve it no more."""
        with self._lock:
            entry = self._services.pop(module, None)
        if entry is not None:
            self._session.unregisterService(entry[0])

    def when_gone(self, callback: Callable[[str], None]) -> None:
        """Have `callback(module)` called, in a thread of ours, when a client's module has left or is given up.

        Only after `listen`. Not when one of that name is there again, whose subscriptions may be new.
        """
        self._gone = callback
        self._session.serviceUnregistered.connect(lambda _, module: self._left(module))

    def has_clients(self) -> bool:
        """Whether somebody is connected; true where the system does not tell."""
        return has_clients(self.port)

    def service(self, module: str) -> Any:
        """The service of that name, of the simulator or of a client; bytes that it is called with stay bytes.

        A RuntimeError when there is none, or its program does not answer.
        """
        for _ in range(ASKED - 1):
            try:
                return self._asked_for(module)
            except NoAnswer:
                raise
            except RuntimeError:
                if module not in self.names():
                    raise
        return self._asked_for(module)

    def _asked_for(self, module: str) -> _Module:
        looked_for = self._session.service(module, _async=True)
        found = answer(looked_for, threading.Condition(), lambda: True, FOUND)
        return _Module(module, found, self._session, self._wires)

    def with_bytes(self, value: Any) -> Any:
        """A libqi future of an answer that holds bytes; a client gets them as bytes.

        Raises:
            RuntimeError: The broker has closed.
        """
        return self._answers.future(value)

    def names(self) -> list[str]:
        """All services that there are, of the simulator and of clients."""
        return [served["name"] for served in self._session.services()]

    def call(self, module: str, method: str, arguments: list) -> None:
        """Call a module of a client without waiting, in the order of the calls; failures are logged."""
        with self._lock:
            if self._closed:
                return
            caller = self._callers.get(module)
            if caller is None and len(self._callers) >= MODULES:
                self._lost += 1
                if worth_telling(self._lost):
                    log.warning(
                        "call of %s.%s is lost: %d modules are called already (%d calls so far)",
                        *(module, method, MODULES, self._lost),
                    )
                return
            if caller is None:
                caller = self._callers[module] = _Caller(module, self.service, self._end_if_idle, self._give_up)
            caller.add(method, arguments)

    def _end_if_idle(self, caller: _Caller) -> bool:
        """Forget a caller that has nothing to do; under the lock, so that no call is handed to a thread that ends."""
        with self._lock:
            if caller.waits:
                return False
            self._forget(caller)
            return True

    def _give_up(self, caller: _Caller) -> None:
        with self._lock:
            self._forget(caller)
        self._gone(caller.module)

    def _forget(self, caller: _Caller) -> None:
        if self._callers.get(caller.module) is caller:
            del self._callers[caller.module]

    def _left(self, module: str) -> None:
        with self._lock:
            ours = module in self._services
            caller = self._callers.pop(module, None)
        if caller is not None:
            caller.end()
        if not ours:  # in a thread of its own: libqi's must not wait for an answer of libqi
            self._telling.do(lambda: self._tell_of(module))

    def _tell_of(self, module: str) -> None:
        try:
            back = any(served["name"] == module for served in self._session.services())
        except RuntimeError:
            return  # the session has closed
        if not back:
            self._gone(module)

    def close(self) -> None:
        """Stop listening and drop all connections; calls that wait for their turn are not made any more."""
        with self._lock:
            self._closed = True
            callers = list(self._callers.values())
        for caller in callers:
            caller.end()
        if self._watch is not None:
            self._watch.close()
        self._wires.close()
        self._answers.close()
        self._session.close()


class _Module:
    """A service as libqi has it, but for bytes: its Python binding makes text of them where any value is taken."""

    def __init__(self, name: str, remote: Any, session: Any, wires: Wires) -> None:
        self._name, self._remote, self._session, self._wires = name, remote, session, wires

    def __getattr__(self, name: str) -> Any:
        return getattr(self._remote, name)

    def call(self, method: str, *arguments: Any, _async: bool = False) -> Any:
        """As libqi's `call`."""
        future = self._call_with_bytes(method, arguments) if has_bytes(arguments) else None
        if future is None:
            return self._remote.call(method, *arguments, _async=_async)
        return future if _async else future.value()

    def _call_with_bytes(self, method: str, arguments: tuple) -> Any:
        """The future of a call; None if libqi makes it as well as this, or says what is wrong with it."""
        for number, name, signature in self._methods:
            content = name == method and packed_arguments(signature, arguments)
            if content and self._served is not None:
                return self._wires.call(self._served["endpoints"], self._served["serviceId"], number, content)
        return None

    # Both stay as long as the service does: microphones call it six times a second.

    @cached_property
    def _served(self) -> Any:
        """What the service directory says of it; None if it has left."""
        return next((each for each in self._session.services() if each["name"] == self._name), None)

    @cached_property
    def _methods(self) -> list[tuple[int, str, str]]:
        """Number, name and signature of the parameters of each method."""
        methods = self._remote.metaObject()["methods"]
        return [(number, each["name"], each["parametersSignature"]) for number, each in methods.items()]


class _Caller:
    """Calls one module in a thread of its own: a client that hangs must not keep others from their events.

    Not in libqi's callbacks: a call made in one needs the very thread that runs it, now and then.
    """

    def __init__(
        self,
        module: str,
        service: Callable[[str], Any],
        ends: Callable[[_Caller], bool],
        gives_up: Callable[[_Caller], None],
    ) -> None:
        self.module = module
        self._service = service
        self._ends = ends
        self._gives_up = gives_up
        self._news = threading.Condition()
        self._calls: deque[tuple[str, list]] = deque()
        self._ended = False
        self._found = True  # the module, when it was looked for last
        self._lost = self._failed = 0
        threading.Thread(target=self._run, name=f"calls of {module}", daemon=True).start()

    @property
    def waits(self) -> bool:
        return bool(self._calls)

    def add(self, method: str, arguments: list) -> None:
        """Make a call when those before it are over; of too many the oldest is lost."""
        with self._news:
            if len(self._calls) >= WAITING:
                self._calls.popleft()
                self._lost += 1
                if worth_telling(self._lost):
                    log.warning("%s does not keep up: %d calls lost so far", self.module, self._lost)
            self._calls.append((method, arguments))
            self._news.notify_all()

    def end(self) -> None:
        """End the thread; a call that is under way is not waited for, those behind it are dropped."""
        with self._news:
            self._ended = True
            self._news.notify_all()
        self.drop()

    def drop(self) -> None:
        """Forget the calls that wait for their turn."""
        with self._news:
            self._calls.clear()

    def _run(self) -> None:
        while True:
            with self._news:
                self._news.wait_for(lambda: self._calls or self._ended, CALLER_IDLE if self._found else 0.0)
                if self._ended:
                    return
                call = self._calls.popleft() if self._calls else None
            if call is not None:
                if not self._make(*call):
                    return
            elif self._ends(self):
                return

    def _make(self, method: str, arguments: list) -> bool:
        """Make a call and wait for its end; whether to go on."""
        try:
            self._found = False
            service = self._service(self.module)
            self._found = True
        except RuntimeError as error:
            self._tell(method, f"lost: {error}")
            return True
        try:
            answer(service.call(method, *arguments, _async=True), self._news, lambda: not self._ended)
        except NoAnswer as error:
            if not self._ended:
                log.warning("%s.%s: %s; %s is called no more", self.module, method, error, self.module)
                self._gives_up(self)
            return False
        except (RuntimeError, AttributeError) as error:
            self._tell(method, f"failed: {error}")
        return True

    def _tell(self, method: str, what: str) -> None:
        self._failed += 1
        if worth_telling(self._failed):
            log.warning("callback %s.%s %s (%d so far)", self.module, method, what, self._failed)
