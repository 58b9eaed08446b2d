"""The robot for a module: its proxies by name, its connection, calls that can be interrupted."""

from __future__ import annotations

import threading
from collections.abc import Iterable, Sequence
from typing import Any

import naoqi
from naoqi.errors import NaoError
from naoqi.limits import STOPPED_LIMIT

from ..base.cancellation import CancellationToken
from ..owners.line import OwnerLine

# Most calls are answered within this time (s). Waiting for the answer alone is quicker than waiting for
# answer or interrupt, which then comes that much later at most.
QUICK_ANSWER = 0.005


class Robot:
    """Proxies of one robot; it connects in the background. Calls fail with a clear error until it is reached.

    Attributes:
        connection: The connection that all proxies share.
        address: `ip:port`, for texts.
        owners: Notes what this process starts on the robot.
    """

    def __init__(self, ip: str, port: int) -> None:
        self.address = f"{ip}:{port}"
        self.connection = naoqi.connection(ip, port, wait=False)
        self.owners = OwnerLine(self.address)
        self.connection.witness = self.owners.sending
        self._ip = ip
        self._port = port
        self._proxies: dict[str, Any] = {}
        self._lock = threading.Lock()

    def proxy(self, name: str) -> Any:
        """Proxy of a NAOqi module, the same object every time."""
        proxy = self._proxies.get(name)
        if proxy is None:
            with self._lock:
                proxy = self._proxies.setdefault(name, naoqi.ALProxy(name, self._ip, self._port, lazy=True))
        return proxy


class _Countdown:
    """Wakes a waiter when all calls are done, one failed, or the interrupt came."""

    def __init__(self, count: int) -> None:
        self._lock = threading.Lock()
        self._left = count
        self.event = threading.Event()

    def call_done(self, call: Any) -> None:
        """Count a call; runs in a thread of libqi."""
        with self._lock:
            self._left -= 1
            last = self._left == 0
        # Asking a finished call for its result does not block.
        if last or _error_of(call) is not None:
            self.event.set()


def _error_of(call: Any) -> NaoError | None:
    try:
        call.result(timeout=0)
    except NaoError as error:
        return error
    return None


def wait_for_calls(calls: Sequence[Any], interrupt: CancellationToken) -> list[Any]:
    """Wait until all calls are done, one fails, or an interrupt comes; then cancel those still running.

    Returns the results, in order. Raises NaoError of the first call that failed; Preempted, or whatever reason the
    interrupt has.
    """
    if not calls:
        return []
    if len(calls) == 1 and calls[0].wait(QUICK_ANSWER):
        return [calls[0].result(timeout=0)]
    countdown = _Countdown(len(calls))
    for call in calls:
        call.add_done_callback(countdown.call_done)
    with interrupt.waking(countdown.event.set):
        countdown.event.wait()  # no limit: the proxy layer fails calls to a lost robot
    running = [call for call in calls if not call.done()]
    if running:
        _cancel(running)
        interrupt.check()
        raise next(error for call in calls if call not in running for error in [_error_of(call)] if error)
    return [call.result(timeout=0) for call in calls]


def _cancel(calls: Iterable[Any]) -> None:
    """Cancel calls and see them end, so that they change nothing any more when clean-up begins."""
    calls = list(calls)
    ended = [threading.Event() for _ in calls]
    for call, event in zip(calls, ended):
        call.add_done_callback(lambda _, event=event: event.set())
        call.cancel()
    for event in ended:
        event.wait(STOPPED_LIMIT)
