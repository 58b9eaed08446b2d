"""Orders to walk, and the box in which they wait for the thread that passes them on."""

from __future__ import annotations

import threading
from concurrent.futures import Future, InvalidStateError
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Union

from naoqi.errors import NaoError

from ...base.limits import limit
from .walk_commands import FootStep, Target, Velocity

MOST = int(limit("footsteps").highest)


class Stop:
    """Stand, with both feet on the ground."""

    def __str__(self) -> str:
        return "stopping"


Command = Union[Velocity, Target, FootStep, Stop]


class WalkEnded(NaoError):
    """A command to walk did not come to its end: the robot did not get there."""

    def __init__(self, command: Command, reason: str) -> None:
        super().__init__(f"{command} ended before time: {reason}")


class Superseded(WalkEnded):
    """A newer command ended it."""


@dataclass(eq=False)
class Order:
    """A command, on its way to the robot and until it is carried out.

    `answer` is done when it was carried out, failed, or was superseded.
    """

    command: Command
    source: str  # for texts: "cmd_vel from /teleop"
    watched: bool = False  # the robot has to stop when no further command of this kind comes
    to_the_end: bool = False  # a step counts as carried out when it is made, not when the robot has taken it
    arrived: float = 0.0  # s
    replaces: bool = False  # the robot walked by an older order when this one's turn came
    stopped_by: str = ""
    answer: Future = field(default_factory=Future)

    @property
    def halts(self) -> bool:
        return isinstance(self.command, Stop) or (isinstance(self.command, Velocity) and self.command.is_zero)

    def succeed(self) -> None:
        """It was carried out; later ends do not count."""
        with suppress(InvalidStateError):
            self.answer.set_result(None)

    def fail(self, error: Exception) -> None:
        """It was not carried out; later ends do not count."""
        with suppress(InvalidStateError):
            self.answer.set_exception(error)

    def superseded(self, reason: str) -> None:
        self.fail(Superseded(self.command, reason))


class Mailbox:
    """Orders that wait. The newest replaces those before it; only steps queue up, and a stop is never left out.

    Any thread may put orders in.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._orders: list[Order] = []

    def put(self, order: Order) -> None:
        """Add an order; those that it replaces end. A step that is one too many fails, a stop never does."""
        replaced: list[Order] = []
        with self._lock:
            if len(self._orders) >= MOST:
                if isinstance(order.command, FootStep):
                    order.fail(WalkEnded(order.command, f"{len(self._orders)} orders wait already, {MOST} at most"))
                    return
                replaced.append(self._orders.pop(0))
            if not isinstance(order.command, FootStep):
                replaced += [waiting for waiting in self._orders if not isinstance(waiting.command, Stop)]
                self._orders = [waiting for waiting in self._orders if isinstance(waiting.command, Stop)]
            self._orders.append(order)
        for old in replaced:
            old.superseded(f"{order.source} came after it")

    @property
    def first(self) -> Order | None:
        """The order whose turn it is; it stays in the box."""
        with self._lock:
            return self._orders[0] if self._orders else None

    def take(self) -> Order | None:
        with self._lock:
            return self._orders.pop(0) if self._orders else None

    @property
    def halts(self) -> bool:
        """Whether an order waits after which the robot stands."""
        with self._lock:
            return any(order.halts for order in self._orders)
