"""Calls to the robot: a short one with a limit, and a long one that ends on preemption and when the robot is lost."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from typing import Any

from naoqi.errors import NaoError
from naoqi.limits import ANSWER_LIMIT, CANCELLED_LIMIT, STOPPED_LIMIT

from ..base.cancellation import CancellationToken
from .robot import QUICK_ANSWER

log = logging.getLogger(__name__)


def ask(robot: Any, module: str, method: str, *arguments: Any, limit: float = ANSWER_LIMIT) -> Any:
    """Call a method of a NAOqi module and return its answer.

    `robot`: its proxies. `limit`: s that it may take. Raises NaoError if the robot refuses, cannot be
    asked, or takes longer.
    """
    return robot.proxy(module).call_async(method, *arguments).result(timeout=limit)


def run_task(call: Any, interrupt: CancellationToken, stop: Callable[[], None]) -> Any:
    """Wait for a call; an interrupt cancels it, and stops what it started if that is not enough.

    `stop` stops by other means what the call started, for robots whose calls cannot be cancelled; it may raise
    NaoError. The result of a call that has ended by the time of the interrupt counts. Raises NaoError if the call
    failed; Preempted, or whatever reason the interrupt has.
    """
    if not call.wait(QUICK_ANSWER):  # quicker than to set up the wait for both
        wait_for_call(call, interrupt)
    if not call.done():
        end_call(call, stop)
        interrupt.check()
    return call.result(timeout=0)


def end_call(call: Any, stop: Callable[[], None]) -> None:
    """Cancel a call and see it end, so that it changes nothing any more."""
    call.cancel()
    if call.wait(CANCELLED_LIMIT):
        return
    try:
        stop()
    except NaoError as error:
        log.warning("what was interrupted may go on: %s", error)
        return
    if not call.wait(STOPPED_LIMIT):
        log.warning("what was interrupted goes on: the robot did not end it within %g s", STOPPED_LIMIT)


def wait_for_call(call: Any, interrupt: CancellationToken, limit: float | None = None) -> bool:
    """Wait until a call is over, which it returns, or an interrupt comes; the call goes on in any case.

    `limit` is in s; without one it waits as long as it takes: the proxy layer fails calls to a lost robot.
    """
    news = threading.Event()
    call.add_done_callback(lambda _: news.set())
    with interrupt.waking(news.set):
        news.wait(limit)
    return call.done()
