"""Reports of a module on /diagnostics, once a second."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Mapping

from diagnostic_updater import DiagnosticStatusWrapper, Updater

from .health import Level, Report

log = logging.getLogger(__name__)

PERIOD = 1.0


class DiagnosticsPublisher:
    """Publishes reports from a thread of its own, in wall-clock time.

    A thread, not a ROS timer: with simulated time that would stand still exactly when the simulator is gone.

    ROS API:
        Publishes `/diagnostics` (diagnostic_msgs/DiagnosticArray).
    """

    def __init__(self, hardware_id: str, reports: Mapping[str, Callable[[], Report]]) -> None:
        """Start publishing.

        Args:
            hardware_id: What the reports are about, `ip:port`.
            reports: Name -> function that gives the report of this moment.
        """
        self._updater = Updater()
        self._updater.setHardwareID(hardware_id)
        for name, report in reports.items():
            self._updater.add(name, _task(report))
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run, name="diagnostics", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Publish no more."""
        self._ended.set()

    def _run(self) -> None:
        failed = False
        while not self._ended.is_set():
            try:
                self._updater.force_update()
                failed = False
            except Exception:
                if not failed and not self._ended.is_set():  # of several in a row only the first
                    log.exception("nothing was published on /diagnostics")
                failed = True
            self._ended.wait(PERIOD)


def _task(report: Callable[[], Report]) -> Callable[[DiagnosticStatusWrapper], DiagnosticStatusWrapper]:
    def run(status: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
        try:
            facts = report()
        except Exception as error:  # the others are published all the same
            status.summary(int(Level.ERROR), f"there is no report: {error!r}")
            return status
        status.summary(int(facts.level), facts.message)
        for name, value in facts.values.items():
            status.add(name, value)
        return status

    return run
