"""Errors of the modules, in the family of the proxy layer; their codes; the closest known name to a mistyped one."""

from __future__ import annotations

import difflib
import os
from collections.abc import Iterable, Mapping
from enum import Enum
from typing import ClassVar

from naoqi.errors import NaoError

from .geometry import Place

LIKENESS = 0.6
"""Names less alike than this (0..1) are no suggestion."""
TEXT, TEXT_WORDS = "str_param", ("text", "color", "colour", "posture", "pose", "param", "string", "value")
"""The field that most functions take their text, name or colour from, and what it is taken for."""


def closest(name: str, known: Iterable[str], count: int = 3) -> list[str]:
    """Known names that look like `name`, the closest first.

    Of equally close ones those come first that end in a number if the name does, and in none if it does not: `FaceLed`
    rather means `FaceLeds` than `FaceLed0`. Then the longer common beginning counts, then the length, then the order in
    `known`. Upper and lower case do not matter: `setcolor` is as close to `setColor` as can be. `name`: the name as
    typed. `known`: names to choose from. `count`: how many to return at most.
    """
    matcher = difflib.SequenceMatcher(b=name.lower())
    scored = []
    for candidate in known:
        matcher.set_seq1(candidate.lower())
        # The quick one is an upper bound and spares most of the work.
        if matcher.quick_ratio() >= LIKENESS and matcher.ratio() >= LIKENESS:
            other_kind = candidate[-1:].isdigit() != name[-1:].isdigit()
            beginning = len(os.path.commonprefix([candidate.lower(), name.lower()]))
            score = (-matcher.ratio(), other_kind, -beginning, abs(len(candidate) - len(name)))
            scored.append((score, candidate))
    scored.sort(key=lambda pair: pair[0])
    return [candidate for _, candidate in scored[:count]]


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """Text to append to "unknown ...": `: did you mean 'a', 'b'?`, or nothing when no name is close."""
    matches = closest(name, known)
    if not matches:
        return ""
    return f": did you mean {', '.join(repr(match) for match in matches)}?"


def of_those(name: str, known: Iterable[str]) -> str:
    """Text to append to "there is no ...": the closest names where there are some, and all that there are."""
    names = list(known)
    hint = did_you_mean(name, names)
    return f"{hint}{';' if hint else ':'} there are {', '.join(names) or 'none'}"


def field_hint(name: str, known: Iterable[str]) -> str:
    """Text to append to "there is no field ...": the fields that look like it, or the one for the argument in text."""
    names = list(known)
    if TEXT in names and name.lower() in TEXT_WORDS:
        return f": did you mean {TEXT!r}?"
    return did_you_mean(name, names)


class ErrorCode(Enum):
    """What a client of the driver can act on."""

    WALK_ENDED = "walk_ended"  # a walk was stopped, or replaced by another command, before the robot got there
    POSTURE_MISSED = "posture_missed"  # the robot ended its motion elsewhere


class CodedError(NaoError):
    """An error whose code reaches clients in other nodes; each subclass has one."""

    code: ClassVar[ErrorCode]


def with_code(error: Exception) -> str:
    """Text of an error for a client in another node."""
    return f"{error} [{error.code.value}]" if isinstance(error, CodedError) else str(error)


def code_in(text: str) -> ErrorCode | None:
    """The code of an error's text, as `with_code` gives it, also inside of what ROS writes around it."""
    return next((code for code in ErrorCode if f"[{code.value}]" in text), None)


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
