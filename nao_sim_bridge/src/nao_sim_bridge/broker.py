"""The simulator's side of libqi: listens as a robot does, registers services, calls modules of clients."""

from __future__ import annotations

import logging
import os
import queue
import socket
import struct
import threading
import time
from pathlib import Path
from typing import Any, Callable

import qi

log = logging.getLogger("nao_sim.broker")

# A port may still be held by connections of a simulator that has just ended: how long to keep trying, s.
BIND_PATIENCE = 65.0
BIND_PAUSE = 0.5
# The thread that calls a client's module ends after this time without a call, s.
CALLER_IDLE = 20.0
# State of a listening socket in the tables of /proc.
LISTENS = "0A"
# libqi reports each service it registers, and warns that it deduces paths it has no use for here.
QUIET_LIBQI = "qi.path.sdklayout=silent:qimessaging.servicedirectory=warning"


class Broker:
    """A libqi session that listens on one address and serves modules.

    Attributes:
        name: Name that modules report as their broker.
        port: Port it listens on, known after `listen`.

    Args:
        name: See above.
    """

    def __init__(self, name: str = "nao_sim") -> None:
        qi.logging.setFilters(QUIET_LIBQI)
        self.name = name
        self.port = 0
        self._session = qi.Session()
        self._services: dict[str, tuple[int, Any]] = {}
        self._callers: dict[str, _Caller] = {}
        self._closed = False
        self._lock = threading.Lock()

    def listen(self, address: str, port: int, still_wanted: Callable[[], bool] = lambda: True) -> None:
        """Listen on `address`:`port`; port 0 takes a free one. Waits for a port that is just being freed.

        Raises:
            RuntimeError: The address cannot be had.
        """
        give_up = time.monotonic() + BIND_PATIENCE
        warned = False
        while True:
            try:
                self._session.listenStandalone(f"tcp://{address}:{port}")
                break
            except RuntimeError as error:
                in_use = "Address already in use" in str(error)
                if not in_use or _somebody_listens(address, port) or time.monotonic() > give_up:
                    hint = "another program listens there" if in_use else str(error).strip()
                    raise RuntimeError(f"cannot listen on {address}:{port}: {hint}") from error
                if not warned:
                    log.warning("port %d is still held by closed connections, waiting for it", port)
                    warned = True
                if not still_wanted():
                    raise
                time.sleep(BIND_PAUSE)
                self._session = qi.Session()
        self.port = int(self._session.endpoints()[0].rsplit(":", 1)[1])
        _free_port_on_exit(self.port)

    def register(self, module: str, service: Any) -> None:
        """Serve an object under a name."""
        with self._lock:
            self._services[module] = (self._session.registerService(module, service), service)

    def serves(self, module: str) -> bool:
        """Whether an object is served under a name."""
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
        """Have `callback(module)` called, in a thread of libqi, when a module has left; only after `listen`."""
        self._session.serviceUnregistered.connect(lambda _, module: callback(module))

    def service(self, module: str) -> Any:
        """The service of that name, of the simulator or of a client."""
        return self._session.service(module)

    def call(self, module: str, method: str, arguments: list) -> None:
        """Call a module of a client without waiting, in the order of the calls; failures are logged."""
        with self._lock:
            if self._closed:
                return
            caller = self._callers.get(module)
            if caller is None:
                caller = self._callers[module] = _Caller(module, self._session, self._end_if_idle)
            caller.calls.put((method, arguments))

    def _end_if_idle(self, caller: _Caller) -> bool:
        """Forget a caller that has nothing to do; under the lock, so that no call is handed to a thread that ends."""
        with self._lock:
            if not caller.calls.empty():
                return False
            if self._callers.get(caller.module) is caller:
                del self._callers[caller.module]
            return True

    def close(self) -> None:
        """Stop listening and drop all connections; calls that wait for their turn are not made any more."""
        with self._lock:
            self._closed = True
            callers = list(self._callers.values())
        for caller in callers:
            caller.end()
        self._session.close()


class _Caller:
    """Calls one module in a thread of its own: a client that hangs must not keep others from their events.

    Not in libqi's callbacks: a call made in one needs the very thread that runs it, now and then.
    """

    def __init__(self, module: str, session: Any, ends: Callable[[_Caller], bool]) -> None:
        self.module = module
        self.calls: queue.Queue[tuple[str, list] | None] = queue.Queue()
        self._session = session
        self._ends = ends
        threading.Thread(target=self._run, name=f"calls of {module}", daemon=True).start()

    def end(self) -> None:
        """End the thread once the call it makes, if any, is over; drop the calls behind it."""
        self.drop()
        self.calls.put(None)

    def drop(self) -> None:
        """Forget the calls that wait for their turn."""
        while True:
            try:
                self.calls.get_nowait()
            except queue.Empty:
                return

    def _run(self) -> None:
        while True:
            try:
                call = self.calls.get(timeout=CALLER_IDLE)
            except queue.Empty:
                if self._ends(self):
                    return
                continue
            if call is None:
                return
            self._make(*call)

    def _make(self, method: str, arguments: list) -> None:
        try:
            service = self._session.service(self.module)
        except RuntimeError as error:
            log.warning("callback %s.%s lost: no such module: %s", self.module, method, error)
            return
        try:
            service.call(method, *arguments)
        except (RuntimeError, AttributeError) as error:
            log.warning("callback %s.%s failed: %s", self.module, method, error)


def _somebody_listens(address: str, port: int) -> bool:
    with socket.socket() as probe:
        probe.settimeout(0.5)
        return probe.connect_ex((address if address != "0.0.0.0" else "127.0.0.1", port)) == 0


def _free_port_on_exit(port: int) -> None:
    """Let the port be taken again at once after this process ends, however it ends.

    libqi binds without SO_REUSEADDR, so connections in TIME_WAIT would keep a killed simulator's port for a minute.
    With a linger time of 0, which accepted sockets inherit from the listening one, they are reset instead.
    """
    folder = "/proc/self/fd"
    if not os.path.isdir(folder):
        return
    listening = _listening_sockets(port)
    for descriptor in os.listdir(folder):
        try:
            if os.readlink(f"{folder}/{descriptor}") not in listening:
                continue
            blocking = os.get_blocking(int(descriptor))
            with socket.socket(fileno=os.dup(int(descriptor))) as candidate:
                # A copy shares its mode with the original, and where Python has a default timeout (rospy sets one) it
                # makes every socket non-blocking that it gets to see.
                os.set_blocking(int(descriptor), blocking)
                candidate.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        except OSError:
            continue  # a descriptor that closed meanwhile


def _listening_sockets(port: int) -> set[str]:
    """What the descriptors of sockets that listen on a TCP port lead to, as /proc spells it."""
    found = set()
    for table in ("/proc/self/net/tcp", "/proc/self/net/tcp6"):
        try:
            lines = Path(table).read_text(encoding="ascii").splitlines()[1:]
        except OSError:
            continue  # a kernel without this family
        for _, local, _, state, *_, inode in (line.split()[:10] for line in lines):
            if state == LISTENS and int(local.rsplit(":", 1)[1], 16) == port:
                found.add(f"socket:[{inode}]")
    return found
