"""A remote call in progress."""

from __future__ import annotations

import functools
import logging
import threading
import time
from threading import get_ident
from typing import TYPE_CHECKING, Any, Callable, Optional, Tuple

from . import wire
from .errors import CallTimeout
from .limits import wait_while_answering
from .session import RUNNING

if TYPE_CHECKING:
    from .remote import RemoteMethod

logger = logging.getLogger("naoqi")

NOT_YET = "Future timeout."
FIRST_SLICE_MS = 100
INTERRUPTIBLE_MS = 200
"""A wait inside libqi blocks Ctrl-C, so the main thread waits in slices of this length, in ms."""
LONGEST_WAIT_MS = 2**31 - 2  # libqi takes a 32-bit integer, and its largest value as "for ever"


class Call:
    """One call of a remote method. All methods may be used from any thread.

    Nothing polls: libqi wakes the waiting thread when the answer arrives, when the call is cancelled, and when the
    connection breaks.
    """

    __slots__ = ("_future", "arguments", "method")

    def __init__(self, future: Any, method: RemoteMethod, arguments: Tuple[Any, ...]) -> None:
        self._future = future
        self.method = method
        self.arguments = arguments

    def result(self, timeout: Optional[float] = None) -> Any:
        """Wait for the end of the call.

        Returns what the method returned; raw data is `bytes`.

        Args:
            timeout: Limit of the wait in s, without the time in which the robot answers nothing at all, see `limits`;
                None waits as long as the connection lives.

        Raises:
            CallTimeout: If the call still runs after the limit. It goes on; `cancel` ends it.
            NaoError: Any other failure, see `naoqi.errors`.
        """
        # Most answers arrive within the first slice, so this is the fast path.
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
        """Wait up to `timeout` s for the end of the call, whatever its outcome; whether it is finished."""
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
        return self._future.isFinished() and self._future.isCanceled()

    def cancel(self) -> None:
        """Ask the robot to cancel the call; a method that cannot be interrupted runs to its end."""
        self._future.cancel()

    def add_done_callback(self, callback: Callable[[Call], None]) -> None:
        """Call a function with this call when it is finished; at once if it already is.

        `callback`: runs in a thread of libqi and must not wait: it may set an event, no more. Its exceptions are
        logged.
        """
        # No closure: the traceback frames of a stored error would keep it alive.
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

    def _ends_within(self, limit: float) -> bool:
        return wait_while_answering(self._wait, self.method.module.connection.answering_time, limit)

    def _late_value(self, error: RuntimeError, timeout: Optional[float], waited_ms: int) -> Any:
        """The value after the first wait raised: either the call failed, or it takes longer."""
        if str(error) == NOT_YET:
            if timeout is None:
                self._wait(None)
            elif not self._ends_within(max(0.0, timeout - 0.001 * waited_ms)):
                raise CallTimeout(self.method.module.name, self.method.name, timeout) from None
            try:
                return self._future.value()
            except RuntimeError as late_error:
                # Raised here: a frame that holds an error raised through it makes a reference cycle.
                raise self.method.translate(late_error, self) from late_error
        raise self.method.translate(error, self) from error
