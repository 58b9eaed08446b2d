"""Ends what nobody waits for any more: libqi tells a service neither whose call it is, nor that a client is gone."""

from __future__ import annotations

import threading
import time
from typing import Callable

from nao_sim_bridge.base.tasks import Task

PERIOD = 1.0
"""Between two looks, s of wall time."""


class ClientWatch:
    """Kills tasks when no client is connected any more. Any thread.

    Args:
        connected: Whether there is a client.
    """

    def __init__(self, connected: Callable[[], bool]) -> None:
        self._connected = connected
        self._lock = threading.Lock()
        self._tasks: list[Task] = []
        self._runs = False

    def add(self, task: Task) -> Task:
        """Look after a task until it has ended; returns it."""
        with self._lock:
            self._tasks.append(task)
            if not self._runs:
                self._runs = True
                threading.Thread(target=self._run, name="watch of clients", daemon=True).start()
        return task

    def _run(self) -> None:
        while True:
            time.sleep(PERIOD)
            with self._lock:
                self._tasks = tasks = [task for task in self._tasks if not task.finished]
                self._runs = bool(tasks)
            if not tasks:
                return
            if not self._connected():
                for task in tasks:
                    task.request_kill()
