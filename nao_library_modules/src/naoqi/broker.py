"""ALBroker: serves modules of this process to the robot."""

from __future__ import annotations

import logging
import threading
from typing import Any, Dict, List, Optional

from .errors import BrokerError, NaoError
from .registry import connection
from .serving_session import ServingSession
from .state import State
from .worker import Worker

logger = logging.getLogger("naoqi")

_open_brokers: List[ALBroker] = []
_open_brokers_lock = threading.Lock()


class ALBroker:
    """Listens for the robot, so that it can call the modules (`ALModule`) of this process.

    The newest broker that is not shut down is the one that `ALProxy(name)` and `ALModule(name)` use. Its session
    is its own: `shutdown` frees its port and the names of its modules. After that session or the connection is lost,
    it registers its modules again.
    """

    def __init__(
        self,
        name: str,
        listen_ip: str,
        listen_port: int,
        robot_ip: str,
        robot_port: int,
        *,
        connect_timeout: Optional[float] = None,
    ) -> None:
        """Connect to the robot and listen.

        Raises RobotUnreachable if the robot is not there, BrokerError if the own port is not free.

        Args:
            listen_ip: Own address on which the robot can call back; `""` is the one towards the robot, `0.0.0.0`
                means all. A robot that runs on this computer is served on the loopback address only.
            listen_port: Own TCP port; 0 takes a free one.
            connect_timeout: Limit of the wait for the robot, in s; None: the patience of the connection.
        """
        self._name = name
        self._listen_port = listen_port
        self._lock = threading.RLock()  # guards session and modules, and serialises restorations
        self._modules: Dict[str, Any] = {}
        self._workers: Dict[str, Worker] = {}
        self._down = threading.Event()
        self._worker = Worker(f"naoqi broker {name}")
        self.connection = connection(robot_ip, robot_port, connect_timeout=connect_timeout)
        self._session = ServingSession(
            name, self.connection, listen_ip, self._down, lambda: self._worker.submit(self._follow)
        )
        self._session.open(listen_port)
        self.connection.add_listener(self._on_state)
        with _open_brokers_lock:
            _open_brokers.append(self)

    def __repr__(self) -> str:
        return f"<ALBroker {self._name} of {self.connection.address}>"

    def getName(self) -> str:
        return self._name

    def getIP(self) -> str:
        return self._session.host

    def getPort(self) -> int:
        """0 while it does not listen."""
        with self._lock:
            return self._session.port

    def session(self) -> Any:
        """The session of libqi over which it serves; a BrokerError while there is none."""
        with self._lock:
            return self._session.raw

    def isModulePresent(self, name: str) -> bool:
        """Whether the robot, or this broker, has a module of that name."""
        return name in self._modules or name in self.connection.module_names()

    def shutdown(self) -> None:
        """Close the session and withdraw all modules; a second call has no effect."""
        self._down.set()  # first, because a running restoration holds the lock
        with _open_brokers_lock:
            if self in _open_brokers:
                _open_brokers.remove(self)
        self.connection.remove_listener(self._on_state)
        self._worker.close()
        with self._lock:
            self._session.close()
            workers = dict(self._workers)
            self._modules.clear()
            self._workers.clear()
        for name, worker in workers.items():
            worker.close()
            self.connection.subscriptions.forget_module(name)

    def serve(self, name: str, served: Any, worker: Worker) -> None:
        """Register a module with the robot.

        `served`: the object whose methods libqi serves. `worker`: runs the calls; closed when the broker is shut down.
        Raises BrokerError if the name is taken, or the broker is shut down; RobotUnreachable if there is no connection.
        """
        with self._lock:
            if self._down.is_set():
                raise BrokerError(self._name, "it has been shut down")
            if name in self._modules:
                raise BrokerError(self._name, f"it serves a module {name!r} already")
            if not self._session.is_open:
                raise self.connection.unreachable()
            self.connection.presence.serve(served)
            try:
                self._session.register(name, served, patience=0.0)
            except NaoError:
                self._session.unregister(name)
                raise
            self._modules[name] = served
            self._workers[name] = worker
            self.connection.subscriptions.own(name)

    def exchange(self, name: str, served: Any) -> None:
        """Replace the object behind a served module; event subscriptions of the module stay.

        Raises NaoError as `serve` does; the module is then no longer served.
        """
        with self._lock:
            worker = self._remove(name)
            if worker is None:
                raise BrokerError(self._name, f"it serves no module {name!r}")
            self.serve(name, served, worker)
        self.connection.subscriptions.renew([name])

    def withdraw(self, name: str) -> None:
        """Unregister a module; one that is not served is no error."""
        with self._lock:
            worker = self._remove(name)
        if worker is not None:
            worker.close()
        self.connection.subscriptions.forget_module(name)

    def _remove(self, name: str) -> Optional[Worker]:
        self._modules.pop(name, None)
        self._session.unregister(name)
        return self._workers.pop(name, None)

    # Called by the connection and by libqi; the work is done in the thread of the broker.

    def _on_state(self, state: State) -> None:
        if state is State.CLOSED:
            self.shutdown()
        else:
            self._worker.submit(self._follow)

    def _follow(self) -> None:
        """Bring the own session in line with the state of the connection."""
        if self.connection.state is not State.CONNECTED:
            with self._lock:
                self._session.close()
        elif self._restored():
            self._register_again()

    def _restored(self) -> bool:
        """Reopen a lost session, with retries; True only if it was lost and is open again."""
        timing = self.connection.timing
        delay = timing.first_delay
        level = logging.INFO  # at first: the connection is probably breaking too, which logs its own warning
        while not self._down.is_set() and self.connection.state is State.CONNECTED:
            with self._lock:
                if self._session.is_healthy:
                    return False
                self._session.close()
                try:
                    self._reopen()
                    return True
                except NaoError as error:
                    logger.log(level, "broker %s cannot serve again yet: %s", self._name, error)
                    level = logging.ERROR
            self._down.wait(delay)
            delay = min(2.0 * delay, timing.longest_delay)
        return False

    def _reopen(self) -> None:
        try:
            self._session.open(self._listen_port)
        except BrokerError as error:
            # Former connections may keep a fixed port busy for a minute; registration tells the robot the new one.
            logger.warning("%s; taking another port", error)
            self._session.open(0)

    def _register_again(self) -> None:
        done = []
        with self._lock:
            for name, served in self._modules.items():
                try:
                    self._session.register(name, served, patience=self.connection.timing.patience)
                    done.append(name)
                except NaoError as error:
                    logger.error("%s", error)
        if done:
            logger.warning("broker %s: modules registered again: %s", self._name, ", ".join(done))
            self.connection.subscriptions.renew(done)


def current_broker() -> ALBroker:
    """The newest broker that is not shut down. Raises BrokerError if there is none."""
    with _open_brokers_lock:
        if _open_brokers:
            return _open_brokers[-1]
    raise BrokerError(
        "",
        "there is no broker: create ALBroker(name, listen_ip, listen_port, robot_ip, robot_port) first, "
        "or give the address of the robot as in ALProxy(module, ip, port)",
    )
