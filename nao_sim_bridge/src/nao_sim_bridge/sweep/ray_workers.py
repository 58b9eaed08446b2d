"""The runs of a sweep on workers of Ray: a run that loses its worker goes to another one."""

from __future__ import annotations

import socket
import time
from collections import deque
from dataclasses import dataclass
from typing import Any, Iterable, Iterator, Mapping, Sequence

from nao_sim_bridge.sweep.job import Job
from nao_sim_bridge.sweep.progress import Progress, counted
from nao_sim_bridge.sweep.ray_start import NoWorkers, import_ray, ray_running, reason_of
from nao_sim_bridge.sweep.table import ERROR, SECONDS

RETRIES = 3
"""How often a run is started again after it lost its worker, and how often a start fails while there is no worker."""
AHEAD = 16
"""How many workers are requested at least that have no place yet; as many as have one, if these are more."""
CLOSE_LIMIT = 60.0
"""s that workers may take to close what they have."""
LOOK_PERIOD = 1.0
"""s between two looks at the progress while no run ends."""
WAITING = 30.0
"""s without any worker after which the sweep reports that it waits."""
MIB = 2**20
ENVIRONMENT = {"RAY_kill_child_processes_on_worker_exit": "0"}
"""Of workers. Children of a dead worker end by themselves and stop their own; killed by Ray, they would leave these."""


@dataclass
class _Run:
    inputs: Mapping[str, Any]
    lost: int = 0


@dataclass
class _Worker:
    """An actor. `host`: of its computer; None until it has started."""

    actor: Any
    host: str | None = None


def run_on_ray(
    job: Job,
    runs: Sequence[Mapping[str, Any]],
    workers: int | None,
    address: str | None,
    memory: float,
    progress: Progress,
) -> Iterator[dict[str, Any]]:
    """The rows of runs as they end, in any order. Arguments as of `sweep`."""
    if not runs:
        return
    ray = import_ray()
    with ray_running(workers, address):
        crew = _Crew(ray, job, workers or len(runs), 0.0 if workers else memory, progress)
        try:
            yield from crew.run_all(runs)
            crew.close()
        finally:
            crew.kill()


class _Crew:
    """The workers of a sweep.

    As long as there are runs for them, more workers are requested than have a place: Ray starts them when a computer
    joins.
    """

    def __init__(self, ray: Any, job: Job, limit: int, memory: float, progress: Progress) -> None:
        class Worker:
            """A process with a copy of the function; one run at a time, so that a death takes no other run with it."""

            def host(self) -> str:
                return socket.gethostname()

            def run(self, inputs: Mapping[str, Any]) -> dict[str, Any]:
                return job.run(inputs)

            def close(self) -> None:
                job.close()

        largest = max((node["Resources"].get("memory", 0.0) for node in ray.nodes() if node["Alive"]), default=0.0)
        self._memory = min(memory * MIB, largest)  # a single worker on a small computer is better than none
        options = {"num_cpus": 1, "runtime_env": {"env_vars": ENVIRONMENT}}
        self._actor = ray.remote(**options, **({"memory": int(self._memory)} if self._memory else {}))(Worker)
        self._ray, self._limit, self._progress = ray, limit, progress
        self._workers: list[_Worker] = []
        self._idle: list[_Worker] = []
        self._busy: dict[Any, tuple[_Worker, _Run | None]] = {}  # by future; no run: asked for its host
        self._failed_starts = 0
        self._ask_at = 0.0  # time.monotonic()

    def run_all(self, runs: Iterable[Mapping[str, Any]]) -> Iterator[dict[str, Any]]:
        left = deque(map(_Run, runs))
        last_seen, reported = time.monotonic(), False
        while True:
            running = sum(run is not None for _, run in self._busy.values())
            if not left and not running:
                return
            self._ask_for_workers(len(left) + running)
            while left and self._idle:  # idle workers may be lost by now: their answer tells
                worker = self._idle.pop()
                self._busy[worker.actor.host.remote()] = worker, None
            ended = []
            if self._busy:
                ended, _ = self._ray.wait(list(self._busy), num_returns=1, timeout=LOOK_PERIOD)
            else:
                time.sleep(LOOK_PERIOD)  # until more workers may be asked for
            self._progress.workers = len(self._there())
            self._progress.refresh()
            if self._progress.workers:
                last_seen, reported = time.monotonic(), False
            elif not reported and time.monotonic() > last_seen + WAITING:
                reported = True
                self._report_waiting(len(left) + running)
            for future in ended:
                worker, run = self._busy.pop(future)
                try:
                    answer = self._ray.get(future)
                except self._ray.exceptions.RayError as error:
                    row = self._lose(worker, run, error, left)
                    if row is not None:
                        yield row
                    continue
                if run is None:
                    worker.host, self._failed_starts = answer, 0
                if left:
                    following = left.popleft()
                    self._busy[worker.actor.run.remote(following.inputs)] = worker, following
                else:
                    self._idle.append(worker)
                if run is not None:
                    yield answer

    def close(self) -> None:
        """Let the workers close what they have, for a limited time."""
        there = self._there()
        futures = {worker.actor.close.remote(): worker for worker in there}
        if futures:
            closed, _ = self._ray.wait(list(futures), num_returns=len(futures), timeout=CLOSE_LIMIT)
            for future in closed:
                self._workers.remove(futures[future])  # Ray ends those that nobody refers to, in order

    def kill(self) -> None:
        """Kill those that have not closed: of an interrupted sweep, or not started yet."""
        for worker in self._workers:
            self._ray.kill(worker.actor)

    def _there(self) -> list[_Worker]:
        return [worker for worker in self._workers if worker.host is not None]

    def _ask_for_workers(self, open_runs: int) -> None:
        """Request more than have started, which wait for a place; one by one and slowly where they fail to start."""
        if time.monotonic() < self._ask_at:
            return
        there = len(self._there())
        most = there + (1 if self._failed_starts else max(AHEAD, there))
        for _ in range(len(self._workers), min(most, self._limit, open_runs)):
            worker = _Worker(self._actor.remote())
            self._workers.append(worker)
            self._busy[worker.actor.host.remote()] = worker, None

    def _lose(self, worker: _Worker, run: _Run | None, error: Exception, left: deque[_Run]) -> dict[str, Any] | None:
        """Put the run of a lost worker back into `left`; its row instead if it has lost too many.

        Raises:
            NoWorkers: There is none, and none starts.
        """
        self._ray.kill(worker.actor)  # one that only cannot be reached must not continue
        self._workers.remove(worker)
        reason = reason_of(error)
        if worker.host is None:
            self._failed_starts += 1
            self._ask_at = time.monotonic() + min(2.0 ** (self._failed_starts - 1), WAITING)
            if self._failed_starts > RETRIES and not self._there():
                raise NoWorkers(f"no worker starts ({self._failed_starts} attempts): {reason}")
            return None
        remaining = f"{counted(len(self._there()), 'worker')} left"
        if run is None:
            self._progress.report(f"lost an idle worker on {worker.host}, {remaining}: {reason}")
            return None
        run.lost += 1
        again = run.lost <= RETRIES
        named = ", ".join(f"{name} {value}" for name, value in run.inputs.items())
        becomes = f"starts again ({run.lost} of {RETRIES})" if again else "is a failed row"
        self._progress.report(f"lost a worker on {worker.host}, {remaining}; its run ({named}) {becomes}: {reason}")
        if again:
            left.appendleft(run)
            return None
        return {**run.inputs, SECONDS: 0.0, ERROR: f"lost {run.lost} workers, the last one with {reason}"}

    def _report_waiting(self, count: int) -> None:
        needed = f"1 processor{f' and {self._memory / MIB:.0f} MiB' if self._memory else ''}"
        computers = sum(node["Alive"] for node in self._ray.nodes())
        where = f"on {counted(computers, 'computer')} of the cluster or on one that joins it"
        self._progress.report(f"{counted(count, 'run')} left and no worker yet: each waits for {needed}, {where}")
