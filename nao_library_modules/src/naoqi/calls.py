"""A remote call under way."""

from __future__ import annotations

import functools
import logging
import threading
import time
from threading import get_ident
from typing import TYPE_CHECKING, Any, Callable, Optional, Tuple

import qi

from . import wire
from .errors import CallTimeout

if TYPE_CHECKING:
    from .remote import RemoteMethod

logger = logging.getLogger("naoqi")

RUNNING = qi.FutureState.Running
NOT_YET = "Future timeout."
FIRST_SLICE_MS = 100
INTERRUPTIBLE_MS = 200
"""A wait inside libqi hides Ctrl-C from Python, so the main thread comes up for air this often, in ms."""
LONGEST_WAIT_MS = 2**31 - 2  # libqi takes a 32-bit integer, and its largest value as "for ever"


class Call:
    """One call of a remote method. All methods may be used from any thread.

    Nothing polls: libqi wakes whoever waits when the answer comes, when the call is cancelled, and when the
    connection breaks.
    """

    __slots__ = ("_future", "arguments", "method")

    def __init__(self, future: Any, method: RemoteMethod, arguments: Tuple[Any, ...]) -> None:
        """Wrap libqi's future.

        Args:
            future: The `qi.Future` of the call.
            method: What was called; it knows how to name what goes wrong.
            arguments: As they were sent.
        """
        self._future = future
        self.method = method
        self.arguments = arguments

    def result(self, timeout: Optional[float] = None) -> Any:
        """Wait for the end of the call.

        Args:
            timeout: Limit of the wait in s; None waits as long as the connection lives.

        Returns:
            What the method returned; raw data as `bytes`.

        Raises:
            CallTimeout: If the call still runs when the limit is over. It goes on; `cancel` ends it.
            NaoError: Whatever else went wrong, see `naoqi.errors`.
        """
        # Most answers come within the first slice, and then this is all that is done.
        first_ms = FIRST_SLICE_MS if timeout is None else max(0, min(FIRST_SLICE_MS, int(1000.0 * timeout)))
        presence, thread = self.method.module.connection.presence, get_ident()
        presence.enter(thread)
        try:
            value = self._future.value(first_ms)
        except RuntimeError as error:
            value = self._late_value(error, timeout, first_ms)
        finally:
            presence.leave(thread)
        return wire.from_wire(value)

    def wait(self, timeout: Optional[float] = None) -> bool:
        """Wait for the end of the call, whatever it is.

        Args:
            timeout: Limit of the wait in s, or None.

        Returns:
            Whether the call is finished.
        """
        presence, thread = self.method.module.connection.presence, get_ident()
        presence.enter(thread)
        try:
            return self._wait(timeout)
        finally:
            presence.leave(thread)

    def done(self) -> bool:
        """Whether the call is finished: with a value, an error, or cancelled."""
        return self._future.isFinished()

    def cancelled(self) -> bool:
        """Whether the call ended by being cancelled."""
        return self._future.isFinished() and self._future.isCanceled()

    def cancel(self) -> None:
        """Ask the robot to give the call up.

        The request travels to the robot; a method that cannot be interrupted runs on to its end.
        """
        self._future.cancel()

    def add_done_callback(self, callback: Callable[[Call], None]) -> None:
        """Have a function called with this call when it is finished, at once if it already is.

        Args:
            callback: Runs in a thread of libqi and must not wait for anything: set an event there, no more.
                What it raises is logged.
        """
        # No closure, because the frames of an error that somebody keeps would keep it too.
        held = functools.partial(self._run, callback)
        self.method.module.connection.presence.lend(held)
        self._future.addCallback(held)

    def _run(self, callback: Callable[[Call], None], _future: Any) -> None:
        try:
            callback(self)
        except Exception:
            logger.exception("the done-callback %r of a call failed", callback)

    def _wait(self, timeout: Optional[float]) -> bool:
        wait = self._future.wait
        in_main_thread = threading.current_thread() is threading.main_thread()
        slice_ms = INTERRUPTIBLE_MS if in_main_thread else LONGEST_WAIT_MS
        if timeout is None:
            while wait(slice_ms) == RUNNING:
                pass
            return True
        deadline = time.monotonic() + timeout
        while True:
            left_ms = int(1000.0 * (deadline - time.monotonic())) + 1
            if wait(max(0, min(left_ms, slice_ms))) != RUNNING:
                return True
            if time.monotonic() >= deadline:
                return False

    def _late_value(self, error: RuntimeError, timeout: Optional[float], waited_ms: int) -> Any:
        """The value, after the first look at the future has raised: the call failed, or only takes longer."""
        if str(error) == NOT_YET:
            if not self._wait(None if timeout is None else max(0.0, timeout - 0.001 * waited_ms)):
                raise CallTimeout(self.method.module.name, self.method.name, timeout or 0.0) from None
            try:
                return self._future.value()
            except RuntimeError as late_error:
                # From here: a frame that keeps an error which has passed through it is kept by that error.
                raise self.method.translate(late_error, self) from late_error
        raise self.method.translate(error, self) from error
