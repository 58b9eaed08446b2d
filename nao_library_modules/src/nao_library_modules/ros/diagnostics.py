"""Reports of a node on /diagnostics, once a second."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Mapping

import rospy
from diagnostic_msgs.msg import DiagnosticArray
from diagnostic_updater import DiagnosticStatusWrapper, Updater

from ..core.health import Level, Report

log = logging.getLogger(__name__)

PERIOD = 1.0

Reports = Mapping[str, Callable[[], Report]]
"""Name -> function that gives the report of this moment."""


class _PartsUpdater(Updater):
    """diagnostic_updater's, for names that say which part of the node they are of: it puts nothing before them."""

    def publish(self, msg: DiagnosticStatusWrapper | list[DiagnosticStatusWrapper]) -> None:
        array = DiagnosticArray(status=msg if isinstance(msg, list) else [msg])
        array.header.stamp = rospy.Time.now()
        self.publisher.publish(array)


class DiagnosticsPublisher:
    """Publishes reports from a thread of its own, in wall-clock time.

    A thread, not a ROS timer: with simulated time that would stand still exactly when the simulator is gone.

    ROS API:
        Publishes `/diagnostics` (diagnostic_msgs/DiagnosticArray).
    """

    def __init__(self, hardware_id: str, reports: Reports | Callable[[], Reports]) -> None:
        """Start publishing.

        `hardware_id`: what the reports are about, `ip:port`. `reports`: the reports; the name of the node comes before
        theirs. Or a function that gives those of this moment, with whole names.
        """
        self._reports = reports if callable(reports) else lambda: reports
        self._updater = _PartsUpdater() if callable(reports) else Updater()
        self._updater.setHardwareID(hardware_id)
        self._names: set[str] = set()
        self._update()
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run, name="diagnostics", daemon=True)
        self._thread.start()

    def close(self) -> None:
        self._ended.set()

    def _update(self) -> None:
        reports = self._reports()
        for name in self._names - set(reports):
            self._updater.removeByName(name)
        for name in [name for name in reports if name not in self._names]:
            self._updater.add(name, _task(lambda name=name: self._reports()[name]()))
        self._names = set(reports)

    def _run(self) -> None:
        failed = False
        while not self._ended.is_set():
            try:
                self._update()
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
