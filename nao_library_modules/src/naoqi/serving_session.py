"""The session over which a broker serves its modules."""

from __future__ import annotations

import logging
import socket
import threading
from typing import TYPE_CHECKING, Any, Callable, Dict, Optional

from .errors import BrokerError, NaoError, RobotUnreachable
from .limits import ANSWER_LIMIT
from .remote import ANSWERED_BY_ALL, RemoteModule
from .session import Live, connect_session

if TYPE_CHECKING:
    from .robot_connection import Connection

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
