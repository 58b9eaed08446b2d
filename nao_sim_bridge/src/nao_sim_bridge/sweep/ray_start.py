"""A Ray on this computer, or a connection to a cluster, with the patience that a busy computer needs."""

from __future__ import annotations

import io
import os
import sys
import threading
import time
from contextlib import contextmanager, redirect_stdout
from typing import Any, Iterator, Mapping

from nao_sim_bridge.base.errors import SimulationError

START_LIMIT = 300.0
"""s that Ray's processes may take to start; by itself Ray gives up after 30 s."""
PAUSE = 0.5
"""s between two looks whether they have started."""
PATIENCE = {
    "RAY_worker_niceness": "0",
    "RAY_worker_register_timeout_seconds": "600",
    "RAY_agent_register_timeout_ms": "300000",
}
"""For Ray's processes, where the environment does not say otherwise. With Ray's own niceness of 15 a worker hardly gets
a processor where others want it, and Ray ends one that has not started after 60 s. These workers are as nice as the
program that asks for them."""
RAYS_REPORTER = "ray_listen_error_messages"
"""Ray's thread that prints errors of its processes on stdout, dozens of lines each."""
REASON_LENGTH = 300
NO_RAY = "workers need Ray: pip install 'ray>=2.10' tqdm matplotlib 'numpy<2'; workers=0 runs all in this process"


class NoWorkers(SimulationError):
    """No worker of a sweep starts."""


@contextmanager
def ray_running(workers: int | None = None, address: str | None = None) -> Iterator[None]:
    """Have Ray for all sweeps within this context; without, each sweep starts it anew, which takes seconds.

    Where there is a Ray already, it is taken, and goes on afterwards.

    Args:
        workers: Processes; None: as many as there are processors.
        address: Of a Ray cluster; None for this computer.

    Raises:
        ImportError: There is no Ray.
        NoWorkers: Ray does not start on this computer.
    """
    ray = import_ray()
    if ray.is_initialized():
        yield
        return
    with redirect_stdout(_WithoutRay(sys.stdout)):
        quiet = {"log_to_driver": False, "configure_logging": False}
        if address is not None:
            ray.init(address=address, **quiet)
        else:
            _start(ray, num_cpus=workers, include_dashboard=False, **quiet)
        try:
            yield
        finally:
            with redirect_stdout(io.StringIO()):  # what Ray has not printed yet
                ray.shutdown()


def import_ray() -> Any:
    """The module `ray`, which only sweeps on workers need. Raises ImportError with how to get it."""
    try:
        import ray
    except ModuleNotFoundError as error:
        raise ImportError(NO_RAY) from error
    return ray


def reason_of(error: Exception) -> str:
    """The error in one line: its last one says most."""
    lines = [line for line in str(error).splitlines() if line.strip()]
    text = f"{type(error).__name__}: {lines[-1].strip() if lines else ''}"
    return text if len(text) <= REASON_LENGTH else f"{text[:REASON_LENGTH]}..."


def _start(ray: Any, **options: Any) -> None:
    with _environment(PATIENCE), _patience():
        try:
            ray.init(**options)
        except (ValueError, TypeError):
            raise
        except Exception as error:  # Ray raises no narrower one
            raise NoWorkers(f"Ray does not start on this computer: {reason_of(error)}") from error


@contextmanager
def _environment(variables: Mapping[str, str]) -> Iterator[None]:
    """Variables of the environment, where they are not set, for processes that are started meanwhile."""
    added = {name: value for name, value in variables.items() if name not in os.environ}
    os.environ.update(added)
    try:
        yield
    finally:
        for name in added:
            del os.environ[name]


@contextmanager
def _patience() -> Iterator[None]:
    """Let Ray ask for its node until that has started: it has no option for how long it asks, and no other way in."""
    services = sys.modules.get("ray._private.services")
    ask = getattr(services, "get_node", None)
    if ask is None:  # a Ray that starts otherwise: its own limit holds
        yield
        return
    until = time.monotonic() + START_LIMIT

    def ask_again(*arguments: Any, **options: Any) -> Any:
        while True:
            try:
                return ask(*arguments, **options)
            except RuntimeError:
                if time.monotonic() > until:
                    raise
            time.sleep(PAUSE)

    services.get_node = ask_again
    try:
        yield
    finally:
        services.get_node = ask


class _WithoutRay:
    """Standard output of this process without Ray's reports: the sweep has its own, on stderr."""

    def __init__(self, output: Any) -> None:
        self._output = output

    def write(self, text: str) -> int:
        return len(text) if threading.current_thread().name == RAYS_REPORTER else self._output.write(text)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._output, name)
