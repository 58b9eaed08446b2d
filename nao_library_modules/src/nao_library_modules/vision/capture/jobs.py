"""The streams and recordings of a server, by the names that users gave them."""

from __future__ import annotations

import logging
import threading
import time

from ...base.errors import BadGoal
from ...base.suggestion import did_you_mean
from .job import CaptureJob, taken

log = logging.getLogger(__name__)

MOST_JOBS = 100
CLOSING = 2.0
"""s of wall-clock time that the end of the server waits for frames that have come and are not written yet."""


class CaptureJobs:
    """A table of capture jobs. Goals use it from one thread, the end of the node from another."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._jobs: dict[str, CaptureJob] = {}
        self._closed = False

    @property
    def known(self) -> dict[str, CaptureJob]:
        """Name -> job, in the order of the names; a copy."""
        with self._lock:
            return dict(sorted(self._jobs.items()))

    def recorded(self) -> list[str]:
        """Names of the recordings that run and still get pictures, or wait for the first."""
        reports = [job.report() for job in self.known.values()]
        return [each.id for each in reports if each.kind == "recording" and each.state in ("waiting", "running")]

    def get(self, ident: str) -> CaptureJob:
        """The job of a name. Raises BadGoal if there is none."""
        known = self.known
        if ident not in known:
            raise unknown(ident, known)
        return known[ident]

    def add(self, job: CaptureJob) -> None:
        """Add a job; it replaces one of the same name that does not run.

        Raises BadGoal if one of that name runs, or there are too many.
        """
        with self._lock:
            old = self._jobs.get(job.ident)
            if old is not None and old.runs:
                raise taken(job.ident)
            if old is None and len(self._jobs) >= MOST_JOBS:
                raise too_many(job.ident)
            if self._closed:
                raise BadGoal("id", job.ident, "none any more", problem="the server ends")
            self._jobs[job.ident] = job
        if old is not None:
            old.stop()  # it has failed, or was never started

    def remove(self, ident: str) -> None:
        """Forget a job; it must have been stopped."""
        with self._lock:
            self._jobs.pop(ident, None)

    def close(self) -> None:
        """Stop all jobs together and soon: the files of a node that is killed meanwhile would be incomplete."""
        with self._lock:
            self._closed = True
        jobs = list(self.known.values())
        running = [job for job in jobs if job.runs]
        for job in jobs:
            job.let_go()
        for job in running:
            log.info("%s %r ends with the server", job.kind, job.ident)
        deadline = time.monotonic() + CLOSING
        for job in jobs:
            job.wait_until(deadline)
        for job in jobs:
            job.stop(at_once=True)


def unknown(ident: str, known: object) -> BadGoal:
    """The error for a name that no job has."""
    names = list(known)
    problem = f"there is no stream or recording {ident!r}{did_you_mean(ident, names)}"
    return BadGoal("id", ident, f"one of {', '.join(names)}" if names else "there are none", problem=problem)


def too_many(ident: str) -> BadGoal:
    problem = "there are too many streams and recordings"
    return BadGoal("id", ident, f"up to {MOST_JOBS}: deleteThread makes room", problem=problem)
