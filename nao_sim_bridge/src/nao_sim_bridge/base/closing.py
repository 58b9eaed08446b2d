"""The end of the simulator: every step is made, whatever the others do, and it is over in time. No ROS."""

from __future__ import annotations

import logging
import signal
import threading
import time
from typing import Any, Callable

from nao_sim_bridge.base.guard import Guard, name_of

log = logging.getLogger("nao_sim.closing")

REFUSED, FAILED = 1, 3
"""Exit status of a simulator that cannot start, and of one whose simulation has failed."""
LOOK_PERIOD = 0.5
CLOSE_LIMIT = 8.0
"""s that all steps together may take. On an idle computer they take 0.1 s, on a busy one each has to wait its turn."""
EXIT_LIMIT = 9
"""s after which the process ends in any case: containers kill after 10 s, roslaunch after 15."""

Step = Callable[[], object]


def wait_for_end(server: Any) -> int:
    """Exit status of a started `SimulatorServer` or `RobotsServer` at its end: 0, or `FAILED` when it failed."""
    while not server.ended.wait(LOOK_PERIOD):
        if not server.runner.running:
            return FAILED
    return FAILED if server.runner.failed else 0


def close_all(*steps: Step, limit: float = CLOSE_LIMIT) -> None:
    """Make steps one after the other; one that raises is logged, one that hangs is left to itself.

    Args:
        steps: Each may take half of the time that is left; then the next begins.
        limit: s for all of them.
    """
    deadline = time.monotonic() + limit
    guard = Guard()
    begun = []
    for step in steps:
        thread = threading.Thread(target=guard.call, args=(step,), name=name_of(step), daemon=True)
        thread.start()
        thread.join(max(0.0, deadline - time.monotonic()) / 2.0)
        begun.append(thread)
    for thread in begun:
        thread.join(max(0.0, deadline - time.monotonic()))
        if thread.is_alive():
            log.error("%s has not ended within %g s and is left", thread.name, limit)


def exit_in_time() -> None:
    """See that the process is over after `EXIT_LIMIT` s, also when C code keeps Python's interpreter then."""
    signal.alarm(EXIT_LIMIT)
