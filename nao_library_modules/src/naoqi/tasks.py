"""Posted calls and their numbers."""

from __future__ import annotations

import logging
import threading
from collections import OrderedDict
from typing import Any, Dict, Optional

from .calls import Call
from .errors import CallCanceled, NaoError

logger = logging.getLogger("naoqi")

REMEMBERED_ERRORS = 256
"""Of so many failed calls the error is kept until somebody waits for them; all are logged anyway."""


class TaskTable:
    """The calls posted over one connection. A call that is finished leaves; only its error stays a while."""

    def __init__(self) -> None:
        self._lock = threading.Lock()  # guards all below; never held while a call is asked anything
        self._last_id = 0
        self._error_level = logging.ERROR
        self._running: Dict[int, Call] = {}
        self._errors: OrderedDict[int, NaoError] = OrderedDict()

    def add(self, call: Call) -> int:
        """Take a call in. Returns its number, unique on this connection."""
        with self._lock:
            self._last_id += 1
            task = self._last_id
            self._running[task] = call
        call.add_done_callback(lambda done: self._finished(task, done))
        return task

    def knows(self, task: Any) -> bool:
        """Whether this number was ever given out here."""
        return isinstance(task, int) and not isinstance(task, bool) and 0 < task <= self._last_id

    def is_running(self, task: int) -> bool:
        """Whether this call is under way."""
        call = self._call(task)
        return call is not None and not call.done()

    def wait(self, task: int, timeout: Optional[float]) -> bool:
        """Wait for the end of a call; one that was stopped has ended like any other.

        `task`: its number. `timeout`: limit in s, or None. Returns whether the limit was over first. Raises NaoError:
        the error of the call, if it failed.
        """
        call = self._call(task)
        if call is None:
            with self._lock:
                error = self._errors.get(task)
            if error is not None:
                raise error
            return False
        if not call.wait(timeout):
            return True
        try:
            call.result()
        except CallCanceled:
            pass
        return False

    def abandon(self) -> None:
        """The program ends the connection itself: that calls still run then is no news to it."""
        self._error_level = logging.DEBUG

    def stop(self, task: int) -> None:
        """Cancel a call; one that is finished already is no error."""
        call = self._call(task)
        if call is not None:
            call.cancel()

    def _call(self, task: int) -> Optional[Call]:
        with self._lock:
            return self._running.get(task)

    def _finished(self, task: int, call: Call) -> None:
        """Runs in a thread of libqi, as the call is finished."""
        error: Optional[NaoError] = None
        try:
            call.result()
        except CallCanceled:
            logger.debug("posted call %d (%s) was cancelled", task, call.method)
        except NaoError as failure:
            error = failure
            logger.log(self._error_level, "posted call %d: %s", task, failure)
        with self._lock:
            self._running.pop(task, None)
            if error is not None:
                self._errors[task] = error
                while len(self._errors) > REMEMBERED_ERRORS:
                    self._errors.popitem(last=False)
