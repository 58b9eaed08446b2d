"""What can go wrong in a plan: CRAM's family of failures. All belong to the family of the proxy layer.

PlanFailure                          (a NaoError) root: what plans signal with `fail` and handle
    SimplePlanFailure                a text
    CompositeFailure                 all branches of try_all or try_in_order failed: failures
    TaskEvaporatedFailure            somebody else ended a task whose result was needed: task, reason
    PolicyFailure                    a policy ended its body: policy
        PolicyCheckConditionMet      its condition came true
            PlanTimedOut             the time was over
        PolicyInitFailed             it could not begin
        PolicyNotFound               no policy has that name
    DesignatorError                  a designator cannot be resolved: designator, problem
        AmbiguousPerception          several objects fit a description that means one
    ProcessModuleError               about the modules, not about what they do
        UnknownProcessModule, ProcessModuleRunning, ProcessModuleNotRunning, NoMatchingProcessModule
    LowLevelFailure                  a process module could not do what it was asked
        ActionlibActionTimedOut
        NavigationLowLevelFailure    NavigationPoseUnreachable, NavigationGoalNotReached
        ManipulationLowLevelFailure  ManipulationPoseUnreachable, ManipulationGoalNotReached
            GripperLowLevelFailure   GripperClosedCompletely, GripperGoalNotReached
        PtuLowLevelFailure           (the head) PtuGoalUnreachable, PtuGoalNotReached
        PerceptionLowLevelFailure    PerceptionObjectNotFound
        SpeechLowLevelFailure, LightsLowLevelFailure
    HighLevelFailure                 a plan has tried what it could
        NavigationHighLevelFailure   NavigationGoalInCollision
        LookingHighLevelFailure, ManipulationGoalInCollision
        ObjectUnreachable, ObjectNowhereToBeFound, GoalNotAchieved

PlanError                            (a NaoError) a plan is written wrongly; never handled as a failure
"""

from __future__ import annotations

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
