"""Errors of the modules. They belong to the family of the proxy layer.

NaoError                 (naoqi.errors) root of everything that can go wrong with a robot or a goal
    BadGoal              a field of a function message is wrong: field, value, allowed
    UnknownFunction      no such function in the table: name, known
    FunctionFailed       function k of a chain failed: position, function, cause
    RobotLost            the robot went away while a goal was waiting
    RobotFell            the robot fell while a goal moved it
    MotionStopped        joints did not get where a goal sent them: joints
        WalkStopped      the robot did not get where a goal sent it: goal, reached
    NotReady             the robot cannot do something as it is now: problem
        CannotWalk       it cannot walk
        NotFit           a motor is too hot, or the battery empty
    PutToRest            the robot put a chain to rest while a goal moved it: chains

Preempted                no error but a signal: a new goal, a cancel or the end of the node interrupts the
function
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from naoqi.errors import NaoError

from .places import Place
from .suggestion import did_you_mean

LONGEST = 4000
"""Characters of an error's text: a goal may hold texts of megabytes, and what was wrong goes to logs and clients."""


def cut(text: str) -> str:
    """A text without its middle where it is too long: its beginning says what was wrong, its end what is allowed."""
    if len(text) <= LONGEST:
        return text
    return f"{text[: LONGEST // 2]} ... ({len(text)} characters) ... {text[-LONGEST // 3 :]}"


class BadGoal(NaoError):
    """A field of a function message has a value that the function cannot take.

    `allowed`: what it may hold, in words. `problem`: what is wrong, where "<value> is not allowed" says too little.
    """

    def __init__(self, field: str, value: object, allowed: str, problem: str = "") -> None:
        problem = problem or f"{value!r} is not allowed"
        super().__init__(f"field {field}: {problem}{';' if problem.endswith('?') else ':'} {allowed}")
        self.field = field
        self.value = value
        self.allowed = allowed


class UnknownFunction(NaoError):
    """A goal names a function that the module does not have.

    Tells the closest names, and where all are to be seen, or all of them where there is no `server`: the name of the
    action whose functions they are.
    """

    def __init__(self, name: str, known: Iterable[str], server: str = "") -> None:
        self.name = name
        self.known = sorted(known)
        hint = did_you_mean(name, self.known)
        rest = f"`nao list {server} --all` tells all" if server else f"known are {', '.join(self.known)}"
        super().__init__(f"unknown function {name!r}{hint}; {rest}")


class FunctionFailed(NaoError):
    """A function of a chain is wrong or failed; the text opens with its place, counted from 1, and its name."""

    def __init__(self, position: int, function: str, cause: Exception) -> None:
        problem = str(cause) if isinstance(cause, NaoError) else f"{type(cause).__name__}: {cause}"
        super().__init__(cut(f"function {position} ({function}): {problem}"))
        self.position = position
        self.function = function
        self.cause = cause


class RobotLost(NaoError):
    """The connection to the robot at `ip:port` broke while a goal was waiting."""

    def __init__(self, address: str, reason: str) -> None:
        super().__init__(f"the robot at {address} went away: {reason}")
        self.address = address
        self.reason = reason


class RobotFell(NaoError):
    """The robot fell while a goal moved it; its motors are off."""

    def __init__(self) -> None:
        super().__init__("the robot fell and its motors are off: goToPosture gets it up again")


class MotionStopped(NaoError):
    """A motion ended and joints are not where it should have brought them.

    `joints`: joint -> where it was to go and where it is told to be, rad.
    """

    def __init__(self, joints: Mapping[str, tuple[float, float]]) -> None:
        off = ", ".join(f"{joint} got to {now:.3f} instead of {goal:.3f}" for joint, (goal, now) in joints.items())
        super().__init__(
            f"the motion was stopped: {off}. Another client, a protection of the robot or a limit did that"
        )
        self.joints = dict(joints)


class WalkStopped(MotionStopped):
    """A walk ended, and the robot is not where it should have brought it.

    Attributes:
        goal: The way that it was to go, seen from where it began; None if it was not to go to a place.
        reached: The way that it went.
        cause: What stopped it, in the words of the robot; empty if it did not say.
    """

    def __init__(self, goal: Place | None, reached: Place, cause: str = "") -> None:
        instead = f" instead of {_way(goal)}" if goal is not None else ""
        stopped = cause or "another client, a protection of the robot or a limit did that"
        NaoError.__init__(self, f"the walk was stopped ({stopped}): the robot got to {_way(reached)}{instead}")
        self.joints = {}
        self.goal = goal
        self.reached = reached
        self.cause = cause


class NotReady(NaoError):
    """The robot cannot do something as it is now: why, and what to do about it."""

    def __init__(self, problem: str, remedy: str) -> None:
        super().__init__(f"{problem}: {remedy}")
        self.problem = problem


class CannotWalk(NotReady):
    """The robot is not ready to walk."""


class NotFit(NotReady):
    """The robot must not move: a motor is too hot, or the battery empty."""


class PutToRest(NaoError):
    """The robot put chains (Body: all of it) to rest to protect them while a goal moved them."""

    def __init__(self, chains: Iterable[str]) -> None:
        self.chains = list(chains)
        super().__init__(
            f"the robot put {', '.join(self.chains)} to rest: a motor is too hot or broken, or the battery is empty"
        )


def _way(way: Place) -> str:
    return f"x {way.x:.3f} m, y {way.y:.3f} m, theta {way.yaw:.3f} rad"


class Preempted(Exception):
    """A new goal, a cancel or the end of the node interrupts what is running."""
