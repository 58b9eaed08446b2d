"""What calls of modules of clients have in common: none waits for ever, what waits is bounded, failures are told."""

from __future__ import annotations

import threading
from typing import Any, Callable

from nao_sim_bridge.base.sizes import load_sizes

GIVEN_UP = load_sizes().clients.call_s
"""A module that has not answered a call for this time, s of wall time, is called no more: its program has stopped."""


class NoAnswer(RuntimeError):
    """A client has not answered."""


def answer(future: Any, news: threading.Condition, wanted: Callable[[], bool], limit: float | None = None) -> Any:
    """The value of a libqi future, once it has one.

    Args:
        future: Of the call.
        news: Notified when `wanted` may have changed.
        wanted: Whether anybody still waits; called with `news` held.
        limit: How long to wait, s of wall time; None for `GIVEN_UP`.

    Raises:
        NoAnswer: It has none within the limit, or nobody wants it any more.
        RuntimeError: What the call ended with.
    """
    limit = GIVEN_UP if limit is None else limit

    def tell(_: Any) -> None:
        with news:
            news.notify_all()

    future.addCallback(tell)
    with news:
        news.wait_for(lambda: future.isFinished() or not wanted(), limit)
    if not future.isFinished():
        future.cancel()
        raise NoAnswer(f"no answer within {limit:g} s")
    return future.value()


def worth_telling(count: int) -> bool:
    """Whether to log something that happens again and again: the first, the second, the fourth time..."""
    return count & (count - 1) == 0
