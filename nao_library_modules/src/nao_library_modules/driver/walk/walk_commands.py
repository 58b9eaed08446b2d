"""Commands to walk: read from messages, queued as orders, and paced. No ROS."""

from __future__ import annotations

import math
import threading
from collections.abc import Mapping
from concurrent.futures import Future, InvalidStateError
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any, List, Union

from naoqi.errors import NaoError

from ...core.errors import BadGoal, CodedError, ErrorCode
from ...core.fields import limit, number_parameter, require_within
from ...core.geometry import Place

WAY, ANGLE = limit("way"), limit("angle")
NO_VELOCITY = 1e-3
"""A velocity below this (fraction of the top speed) in all directions is none."""
LEFT, RIGHT = "LLeg", "RLeg"
LEGS = {0: RIGHT, 1: LEFT}
"""Legs of nao_library_msgs/StepTarget, as ALMotion names them."""
GaitConfig = List[List[Union[str, float]]]
"""What ALMotion takes: [["MaxStepX", 0.04], ...]."""
FORM = "a list like [[MaxStepX, 0.03], [StepHeight, 0.02]], or a dictionary"


@dataclass(frozen=True)
class Velocity:
    """A walking velocity forward, to the left and turning to the left: fractions -1..1 of the top speed."""

    x: float
    y: float
    theta: float

    @property
    def is_zero(self) -> bool:
        return max(abs(self.x), abs(self.y), abs(self.theta)) < NO_VELOCITY

    def __str__(self) -> str:
        return f"walking at ({self.x:.2f}, {self.y:.2f}, {self.theta:.2f}) of the top speed"


STANDSTILL = Velocity(0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Target:
    """A place to walk to, in the robot's frame: x and y in m, theta in rad."""

    x: float
    y: float
    theta: float

    def __str__(self) -> str:
        return f"walking to ({self.x:.2f} m, {self.y:.2f} m, {self.theta:.2f} rad)"


@dataclass(frozen=True)
class FootStep:
    """The leg that moves, and where its foot goes in the frame of the other foot: x and y in m, theta in rad."""

    leg: str
    x: float
    y: float
    theta: float

    @property
    def place(self) -> Place:
        return Place(self.x, self.y, self.theta)

    def __str__(self) -> str:
        return f"the step of {self.leg} by ({self.x:.3f} m, {self.y:.3f} m, {self.theta:.2f} rad)"


def read_velocity(twist: Any) -> tuple[Velocity, str]:
    """The velocity of a geometry_msgs/Twist, and in words which of its parts were clamped to -1..1 (empty: none).

    Raises BadGoal if a part is not a finite number.
    """
    clamped = []
    values = []
    for name, value in (("linear.x", twist.linear.x), ("linear.y", twist.linear.y), ("angular.z", twist.angular.z)):
        if not math.isfinite(value):
            raise BadGoal(name, value, "-1 to 1")
        if abs(value) > 1.0:
            clamped.append(f"{name} is {value:g}, taken as {math.copysign(1.0, value):g}")
        values.append(max(-1.0, min(1.0, value)))
    return Velocity(*values), ", ".join(clamped)


def read_target(pose: Any) -> Target:
    """The target of a geometry_msgs/Pose2D. Raises BadGoal if a part is out of its bounds."""
    return Target(*_pose(pose))


def read_step(step: Any, field: str = "") -> FootStep:
    """The step of a nao_library_msgs/StepTarget; `field` is where it stands in a goal, for texts.

    Raises BadGoal if it names no leg, or a part is out of its bounds.
    """
    if step.leg not in LEGS:
        raise BadGoal(f"{field}leg", step.leg, "0 (right) or 1 (left)")
    return FootStep(LEGS[step.leg], *_pose(step.pose, field))


def require_way(field: str, way: Place) -> Place:
    """The way to a target, seen from the robot. Raises BadGoal if it is too far."""
    if not way.distance <= WAY.highest:
        raise BadGoal(field, f"{way.distance:g} m away", f"up to {WAY.highest:g} m from the robot")
    return way


def read_gait_config(name: str, value: Any) -> GaitConfig:
    """Gait parameters from pairs of name and value, or a dictionary. Names and ranges are the robot's to judge.

    Raises NaoError if it is something else; `name` is the parameter's, for its text.
    """
    pairs = list(value.items()) if isinstance(value, Mapping) else value
    if not isinstance(pairs, (list, tuple)):
        raise NaoError(f"{name} is {value!r}: {FORM}")
    config: GaitConfig = []
    for pair in pairs:
        if not isinstance(pair, (list, tuple)) or len(pair) != 2 or not isinstance(pair[0], str):
            raise NaoError(f"{name} has the entry {pair!r}: {FORM}")
        key, number = pair
        config.append([key, number_parameter(f"{name}: {key}", number, limit("setting"))])
    return config


def _pose(pose: Any, field: str = "") -> tuple[float, float, float]:
    for name, limit_ in (("x", WAY), ("y", WAY), ("theta", ANGLE)):
        require_within(f"{field}pose.{name}", getattr(pose, name), limit_)
    return float(pose.x), float(pose.y), float(pose.theta)


MOST = int(limit("footsteps").highest)


class Stop:
    """Stand, with both feet on the ground."""

    def __str__(self) -> str:
        return "stopping"


Command = Union[Velocity, Target, FootStep, Stop]


class WalkEnded(CodedError):
    """A command to walk was not carried out to its end: the robot did not get there."""

    code = ErrorCode.WALK_ENDED

    def __init__(self, command: Command, reason: str) -> None:
        super().__init__(f"{command} ended early: {reason}")


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


PACE = 0.05
"""s from one velocity or target to the next, at least."""
REFRESH = 1.0
"""s after which a velocity that is commanded on and on is sent again. The robot may have ended the walk by itself:
legs that were limp, feet in the air."""


class WalkPace:
    """What was sent last, and when."""

    def __init__(self) -> None:
        self._velocity: Velocity | None = None
        self._sent: float | None = None
        self._heard: float | None = None

    def pause(self, now: float) -> float:
        """Time until the next velocity or target may be sent; at once if not above 0."""
        return 0.0 if self._sent is None else self._sent + PACE - now

    def sent(self, velocity: Velocity | None, now: float) -> None:
        """Note that a command was sent; `velocity` is what the robot has now, None after another kind of command."""
        self._velocity, self._sent = velocity, now

    def is_news(self, velocity: Velocity, now: float) -> bool:
        """Note that a velocity is commanded; whether it has to be sent.

        A velocity that the robot has already is sent again now and then. A standstill is sent again only after a break
        in the commands: then it is no longer an idle stick, and may be meant for a walk that others began.
        """
        before, self._heard = self._heard, now
        if velocity != self._velocity or before is None or self._sent is None or now - before > REFRESH:
            return True
        return not velocity.is_zero and now - self._sent >= REFRESH


class WalkWatchdog:
    """Time since the last command of a steered walk, which stops after `limit` s without one; 0: never."""

    def __init__(self, limit: float) -> None:
        self.limit = limit
        self._last: float | None = None

    def feed(self, now: float) -> None:
        """A command came: watch the walk from now on."""
        self._last = now if self.limit > 0.0 else None

    def rest(self) -> None:
        """Nothing is steered any more: watch nothing."""
        self._last = None

    def left(self, now: float) -> float | None:
        """Time until the walk has to stop, 0 or less when it is due; None while nothing is watched.

        If `now` lies before the last command, the clock was set back (a simulation was reset), and the command
        counts as just come.
        """
        if self._last is None:
            return None
        self._last = min(self._last, now)
        return self._last + self.limit - now
