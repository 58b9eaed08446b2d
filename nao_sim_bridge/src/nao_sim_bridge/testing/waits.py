"""Waiting for what a test needs: with a limit, and with an error that names it."""

from __future__ import annotations

import time
from typing import Callable

import rospy

LIMIT = 60.0
"""s of wall time after which what a test waits for hangs; also a busy computer does not come near it."""
PAUSE = 0.002
"""s of wall time between two looks: who only looks must not take a processor from what it waits for."""


class StackNotReady(RuntimeError):
    """Something that a test needs is not there; the text names it."""


def wait_until(condition: Callable[[], bool], limit: float, what: str | Callable[[], str]) -> None:
    """Ask again and again until `condition()` holds.

    Raises:
        StackNotReady: It does not hold within `limit` s of wall time, or before this node has been shut down.
    """
    give_up = time.monotonic() + limit
    while not condition():
        over = rospy.is_shutdown()
        if time.monotonic() > give_up or over:
            text = what if isinstance(what, str) else what()
            when = "before rospy was shut down, as the end of rostest.rosrun does" if over else f"within {limit:g} s"
            raise StackNotReady(f"not there {when}: {text}")
        time.sleep(PAUSE)


def wait_for_service(name: str, kind: type, limit: float) -> rospy.ServiceProxy:
    """A service that is there.

    Raises:
        StackNotReady: It is not, within `limit` s of wall time.
    """
    wait_until(lambda: _service_there(name), limit, f"service {name}; is the simulator in the launch file?")
    return rospy.ServiceProxy(name, kind)


def _service_there(name: str) -> bool:
    try:
        rospy.wait_for_service(name, timeout=0.2)
    except rospy.ROSException:
        return False
    return True
