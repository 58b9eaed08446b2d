"""ALBroker: serves modules of this process to the robot."""

from __future__ import annotations

import logging
import socket
import threading
from typing import Any, Callable, Dict, List, Optional

from .calls import ANSWERED_BY_ALL, RemoteModule
from .errors import BrokerError, NaoError, RobotUnreachable
from .limits import ANSWER_LIMIT
from .robot_connection import Connection, connection
from .session import Live, connect_session
from .state import State, Worker

logger = logging.getLogger("naoqi")

ANY_ADDRESS = "0.0.0.0"
NAME_IN_USE = "already registered"


class ServingSession:
    """A listening session and the modules registered on it; can be opened again. Its owner guards it by a lock.

    `host`: address on which it listens, or has listened last.
    """

    def __init__(
        self,
        broker: str,
        connection: Connection,
        listen_ip: str,
        down: threading.Event,
        on_break: Callable[[], None],
    ) -> None:
        """Prepare a session; nothing is opened yet.

        Args:
            broker: Name of the broker, for texts.
            listen_ip: Address on which to listen, see `listening_address`.
            down: Set when the broker is shut down; ends all waiting.
            on_break: Called in a thread of libqi when the session breaks.
        """
        self._broker = broker
        self._connection = connection
        self._down = down
        self._on_break = on_break
        self._live: Optional[Live] = None
        self._generation = 0
        self._service_ids: Dict[str, int] = {}
        self._listen_ip = self.host = listen_ip

    @property
    def is_open(self) -> bool:
        """Whether there is a session, healthy or not."""
        return self._live is not None

    @property
    def raw(self) -> Any:
        """Libqi's own session; a BrokerError while there is none."""
        if self._live is None:
            raise BrokerError(self._broker, "its session is closed")
        return self._live.session

    @property
    def is_healthy(self) -> bool:
        """Whether the session stands, and is not left over from before a loss: then it may only seem to."""
        if self._live is None or self._generation != self._connection.generation:
            return False
        return self._live.session.isConnected()

    @property
    def port(self) -> int:
        """TCP port on which it listens; 0 while it does not."""
        endpoints = self._live.session.endpoints() if self._live is not None else []
        return int(endpoints[0].rsplit(":", 1)[1]) if endpoints else 0

    def open(self, port: int) -> None:
        """Listen, and connect to the robot.

        Raises BrokerError if the port is not free, RobotUnreachable if the robot is not there.
        """
        self.host = listening_address(self._listen_ip, self._connection.host, self._connection.port)
        live = Live(self._on_break)
        robot, generation = self._connection, self._connection.generation
        try:
            live.session.listen(f"tcp://{self.host}:{port}")
            connect_session(live.session, robot.host, robot.port, robot.timing.patience)
        except RobotUnreachable:
            live.close()
            raise
        except RuntimeError as error:
            live.close()
            reason = f"cannot listen on {self.host}:{port} ({str(error).strip()})"
            raise BrokerError(self._broker, reason) from error
        self._live, self._generation = live, generation

    def close(self) -> None:
        """Free the port and the names of the modules."""
        live, self._live = self._live, None
        self._service_ids.clear()
        if live is not None:
            live.close()

    def register(self, name: str, served: Any, patience: float) -> None:
        """Register one module; a name in use is tried again until the patience (s) is over.

        A robot that was silent for a while may learn late that our former session is gone. Raises BrokerError if the
        name is taken, or the module cannot be called; RobotUnreachable if the robot does not answer.
        """
        clock, delay = self._connection.answering_time, 0.05
        end = clock() + patience
        while True:
            future = self._live.session.registerService(name, served, _async=True)
            if not self._connection.answered(future, ANSWER_LIMIT):
                reason = f"no answer to the registration of {name}"
                raise RobotUnreachable(self._connection.host, self._connection.port, reason)
            if not future.hasError():
                self._service_ids[name] = future.value()
                self._wait_until_served(name)
                return
            text = future.error().strip()
            if NAME_IN_USE not in text:
                raise BrokerError(self._broker, f"module {name!r} cannot be registered: {text}")
            if clock() >= end or self._down.wait(delay):
                raise BrokerError(self._broker, f"the robot has a module {name!r} already; choose another name")
            logger.info("broker %s: the name %s is still taken; trying again", self._broker, name)
            delay = min(2.0 * delay, 0.5)

    def unregister(self, name: str) -> None:
        """Take a module back; one that is not registered is no error."""
        service_id = self._service_ids.pop(name, None)
        if service_id is not None and self._live is not None:
            self._connection.answered(self._live.session.unregisterService(service_id, _async=True), ANSWER_LIMIT)

    def _wait_until_served(self, name: str) -> None:
        """Wait until the module answers; for some ms after its registration libqi may still refuse calls."""
        module = RemoteModule(name, self._connection, ANSWER_LIMIT)
        clock, delay = self._connection.answering_time, 0.005
        end = clock() + ANSWER_LIMIT
        while True:
            try:
                self._connection.forget_service(name)  # of a module that had the name before
                module.method(ANSWERED_BY_ALL)()
                return
            except NaoError as error:
                if clock() >= end or self._down.wait(delay):
                    raise BrokerError(self._broker, f"module {name!r} does not answer: {error}") from error
                delay = min(2.0 * delay, 0.5)


def listening_address(wanted: str, host: str, port: int) -> str:
    """Address on which to listen for a robot.

    Raises RobotUnreachable if no network leads to it.

    Args:
        wanted: An own address. Empty: the one that the robot sees, which may be another after a change of networks.
            `0.0.0.0`: all; but for a robot on this computer the loopback address alone.
        port: TCP port of NAOqi.
    """
    if wanted not in ("", ANY_ADDRESS):
        return wanted
    try:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as towards:
            towards.connect((host, port))  # which sends nothing
            seen = towards.getsockname()[0]
    except OSError as error:
        raise RobotUnreachable(host, port, f"no way leads there: {error}") from error
    return wanted if wanted and not seen.startswith("127.") else seen


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
        self.connection = connection(robot_ip, robot_port, connect_timeout=connect_timeout)
        self._worker = Worker(f"naoqi broker {name}", self.connection.presence)
        self._session = ServingSession(
            name, self.connection, listen_ip, self._down, lambda: self._worker.submit(self._follow)
        )
        self._session.open(listen_port)
        self.connection.add_listener(self._on_state)
        self.connection.closers.append(self.shutdown)
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
                self.connection.closers.remove(self.shutdown)
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

    def _on_state(self, _state: State) -> None:
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
            # Former connections may keep a fixed port busy for a minute; registration gives the robot the new one.
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
