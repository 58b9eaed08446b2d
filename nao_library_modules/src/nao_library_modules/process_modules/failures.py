"""Failures of plans, with CRAM's names; values as short text; the warning of what was made and never used."""

from __future__ import annotations

import re
import sys
import warnings
from collections.abc import Iterable
from typing import Any, NoReturn

from naoqi.errors import NaoError


class PlanError(NaoError):
    """A mistake of the programmer, which no failure handling catches."""


class PlanFailure(NaoError):  # CRAM's names, here and below
    """A failure that a plan can expect and handle. Its details, for handlers, are attributes as well."""

    def __init__(self, text: str = "", /, **details: Any) -> None:
        super().__init__(text or _in_words(type(self).__name__))
        self.details = details
        for name, value in details.items():
            setattr(self, name, value)


class SimplePlanFailure(PlanFailure):
    """A failure with only a text."""


class CompositeFailure(PlanFailure):
    """Every branch of `try_all` or `try_in_order` failed; `failures` has the order of the branches."""

    def __init__(self, failures: Iterable[PlanFailure]) -> None:
        self.failures = tuple(failures)
        super().__init__(f"all {len(self.failures)} failed: {'; '.join(map(str, self.failures))}")


class TaskEvaporatedFailure(PlanFailure):
    """A task (its path) was ended from outside although its result was needed."""

    def __init__(self, task: str, reason: str) -> None:
        super().__init__(f"the task {task} was evaporated: {reason}", task=task, reason=reason)


# --- policies ---------------------------------------------------------------------------------------------------------


class PolicyFailure(PlanFailure):
    """A policy (its name) ended its body."""


class PolicyCheckConditionMet(PolicyFailure):
    """The condition that a policy watches for came true."""


class PlanTimedOut(PolicyCheckConditionMet):
    """The body took longer than it may."""


class PolicyInitFailed(PolicyFailure):
    """A policy could not begin, so its body did not either."""


class PolicyNotFound(PolicyFailure):
    """No policy has that name."""


# --- designators and process modules ----------------------------------------------------------------------------------


class DesignatorError(PlanFailure):
    """A designator cannot be resolved."""

    def __init__(self, designator: Any, problem: str) -> None:
        super().__init__(f"{designator}: {problem}", designator=designator, problem=problem)


class AmbiguousPerception(DesignatorError):
    """Several objects fit a description that means one."""


class ProcessModuleError(PlanFailure):
    """Something is wrong with the modules themselves, not with what they do."""


class UnknownProcessModule(ProcessModuleError):
    """There is no module of that name."""


class ProcessModuleRunning(ProcessModuleError):
    """The module runs already."""


class ProcessModuleNotRunning(ProcessModuleError):
    """The module does not run."""


class NoMatchingProcessModule(ProcessModuleError):
    """No module that runs can do what a designator describes."""


# --- low level --------------------------------------------------------------------------------------------------------


class LowLevelFailure(PlanFailure):
    """A process module could not do what it was asked."""


class ActionlibActionTimedOut(LowLevelFailure):
    """An action server did not come up, or did not end in time."""


class NavigationLowLevelFailure(LowLevelFailure):
    """Walking failed."""


class NavigationPoseUnreachable(NavigationLowLevelFailure):
    """There is no way to where the robot shall go."""


class NavigationGoalNotReached(NavigationLowLevelFailure):
    """The robot did not get where it was to go."""


class ManipulationLowLevelFailure(LowLevelFailure):
    """Moving an arm or a hand failed."""


class ManipulationPoseUnreachable(ManipulationLowLevelFailure):
    """The hand cannot get there.

    `nearest`: the closest point in reach, (x, y, z) in m, in the frame of the target. `distance`: from there to the
    target, m.
    """


class ManipulationGoalNotReached(ManipulationLowLevelFailure):
    """The hand did not get there."""


class GripperLowLevelFailure(ManipulationLowLevelFailure):
    """Opening or closing a hand failed."""


class GripperClosedCompletely(GripperLowLevelFailure):
    """The hand closed and there was nothing in it."""


class GripperGoalNotReached(GripperLowLevelFailure):
    """The hand is not as far open as it was to be."""


class PtuLowLevelFailure(LowLevelFailure):
    """Turning the head (CRAM's pan-tilt unit) failed."""


class PtuGoalUnreachable(PtuLowLevelFailure):
    """The head cannot look there."""


class PtuGoalNotReached(PtuLowLevelFailure):
    """The head did not get there."""


class PerceptionLowLevelFailure(LowLevelFailure):
    """Looking for something failed."""


class PerceptionObjectNotFound(PerceptionLowLevelFailure):
    """What was looked for is not in view."""


class SpeechLowLevelFailure(LowLevelFailure):
    """Saying something failed."""


class LightsLowLevelFailure(LowLevelFailure):
    """Changing lights failed."""


# --- high level -------------------------------------------------------------------------------------------------------


class HighLevelFailure(PlanFailure):
    """A plan has tried what it could."""


class NavigationHighLevelFailure(HighLevelFailure):
    """No way of getting there is left."""


class NavigationGoalInCollision(NavigationHighLevelFailure):
    """Something stands where the robot shall go."""


class LookingHighLevelFailure(HighLevelFailure):
    """No way of looking there is left."""


class ManipulationGoalInCollision(HighLevelFailure):
    """Something is where the hand shall go."""


class ObjectUnreachable(HighLevelFailure):
    """No way of reaching the object is left."""


class ObjectNowhereToBeFound(HighLevelFailure):
    """The object is nowhere where it was looked for."""


class GoalNotAchieved(HighLevelFailure):
    """The plan of a goal succeeded, and the goal still does not hold."""


def fail(failure: PlanFailure | type[PlanFailure] | str, text: str = "", /, **details: Any) -> NoReturn:
    """Signal a failure: `fail("no ball")`, `fail(ObjectUnreachable, "too high", height=0.8)`.

    Raises:
        PlanFailure: The given one, or one of the given class; SimplePlanFailure for a text.
        PlanError: It is none of these.
    """
    if isinstance(failure, str):
        raise SimplePlanFailure(failure, **details)
    if isinstance(failure, PlanFailure):
        raise failure
    if not (isinstance(failure, type) and issubclass(failure, PlanFailure)):
        raise PlanError(f"fail: {failure!r} is no PlanFailure: give a failure, a class of failures or a text")
    raise failure(text, **details)


def _in_words(name: str) -> str:
    """ManipulationPoseUnreachable -> manipulation pose unreachable."""
    return "".join(f" {letter.lower()}" if letter.isupper() else letter for letter in name).strip()


# --- values that were never used --------------------------------------------------------------------------------------


class MadeToBeUsed:
    """Warns when it is dropped unused, as Python does of a coroutine that was never awaited."""

    _used = False

    def use(self) -> None:
        """Note that something has been done with it."""
        object.__setattr__(self, "_used", True)  # of frozen ones as well

    def unused(self) -> str:
        """What to say of it; empty for one that may be dropped."""
        return ""

    def __del__(self) -> None:
        if not self._used and not sys.is_finalizing():
            text = self.unused()
            if text:
                warnings.warn(text, RuntimeWarning, stacklevel=2)


def use_all(values: object) -> None:
    """Note that what is among values, or in lists of them, has been given to something."""
    for value in values if isinstance(values, (list, tuple)) else (values,):
        if isinstance(value, MadeToBeUsed):
            value.use()
        elif isinstance(value, (list, tuple)):
            use_all(value)


# --- short text -------------------------------------------------------------------------------------------------------

DIGITS = 3
SHORTENED = 8
"""How much longer a number is, at most, before its digits are left out: the rest of a long text is not looked at."""
LONG_NUMBER = re.compile(r"-?\d+\.\d{4,}(?:e-?\d+)?")


def short_repr(value: Any, longest: int = 160) -> str:
    """The repr of a value in one line, with short numbers, cut to a length."""
    in_one_line = " ".join(line.strip() for line in repr(value)[: SHORTENED * longest].splitlines())
    return cut(short_numbers(in_one_line), longest)


def short_numbers(text: str) -> str:
    """A text with its numbers rounded to three decimals."""
    return LONG_NUMBER.sub(lambda found: f"{float(found.group()):.{DIGITS}f}".rstrip("0").rstrip("."), text)


def cut(text: str, longest: int) -> str:
    return text if len(text) <= longest else f"{text[: longest - 1]}…"
