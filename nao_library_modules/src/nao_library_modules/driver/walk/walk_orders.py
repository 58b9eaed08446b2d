"""Orders to walk, and the box in which they wait for the thread that passes them on."""

from __future__ import annotations

import threading
from concurrent.futures import Future, InvalidStateError
from dataclasses import dataclass, field
from typing import Union

from naoqi.errors import NaoError

from ...base.limits import limit
from .walk_commands import Step, Target, Velocity

MOST = int(limit("footsteps").highest)


class Stop:
    """Stand, with both feet on the ground."""

    def __str__(self) -> str:
        return "stopping"


Command = Union[Velocity, Target, Step, Stop]


class WalkEnded(NaoError):
    """A command to walk did not come to its end: the robot did not get there.

    Attributes:
        command: What was asked for.
        reason: Why.
    """

    def __init__(self, command: Command, reason: str) -> None:
        """Compose the text."""
        super().__init__(f"{command} ended before time: {reason}")
        self.command = command
        self.reason = reason


class Superseded(WalkEnded):
    """Something newer came in the way of a command."""


@dataclass(eq=False)
class Order:
    """A command, on its way to the robot and until it is carried out.

    Attributes:
        command: What to do.
        source: Where it came from, for texts: "cmd_vel from /teleop".
        watched: Whether the robot has to stop when no further command of this kind comes.
        to_the_end: Whether steps count as carried out when they are made, and not when the robot has taken them.
        arrived: Time in s when it came.
        replaces: Whether the robot walked by an older order when this one's turn came.
        stopped_by: What stops it on its way, once something does.
        answer: Done when it was carried out, failed, or was overtaken by another one.
    """

    command: Command
    source: str
    watched: bool = False
    to_the_end: bool = False
    arrived: float = 0.0
    replaces: bool = False
    stopped_by: str = ""
    answer: Future = field(default_factory=Future)

    @property
    def halts(self) -> bool:
        """Whether the robot is to stand."""
        return isinstance(self.command, Stop) or (isinstance(self.command, Velocity) and self.command.is_zero)

    def succeed(self) -> None:
        """It was carried out; later ends do not count."""
        try:
            self.answer.set_result(None)
        except InvalidStateError:
            pass  # it has ended already

    def fail(self, error: Exception) -> None:
        """It was not carried out; later ends do not count."""
        try:
            self.answer.set_exception(error)
        except InvalidStateError:
            pass  # it has ended already

    def overtaken(self, reason: str) -> None:
        """Something newer came in its way."""
        self.fail(Superseded(self.command, reason))


class Mailbox:
    """Orders that wait. The newest replaces those before it; only steps queue up, and a stop is never left out.

    Any thread may put orders in.
    """

    def __init__(self) -> None:
        """Begin empty."""
        self._lock = threading.Lock()
        self._orders: list[Order] = []

    def put(self, order: Order) -> None:
        """Add an order; those that it replaces end. A step that is one too many fails, a stop never does."""
        replaced: list[Order] = []
        with self._lock:
            if len(self._orders) >= MOST:
                if isinstance(order.command, Step):
                    order.fail(WalkEnded(order.command, f"{len(self._orders)} orders wait already, {MOST} at most"))
                    return
                replaced.append(self._orders.pop(0))
            if not isinstance(order.command, Step):
                replaced += [waiting for waiting in self._orders if not isinstance(waiting.command, Stop)]
                self._orders = [waiting for waiting in self._orders if isinstance(waiting.command, Stop)]
            self._orders.append(order)
        for old in replaced:
            old.overtaken(f"{order.source} came after it")

    @property
    def first(self) -> Order | None:
        """The order whose turn it is; it stays in the box."""
        with self._lock:
            return self._orders[0] if self._orders else None

    def take(self) -> Order | None:
        """The order whose turn it is, out of the box."""
        with self._lock:
            return self._orders.pop(0) if self._orders else None

    @property
    def halts(self) -> bool:
        """Whether an order waits after which the robot stands."""
        with self._lock:
            return any(order.halts for order in self._orders)
