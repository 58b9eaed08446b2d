"""Plans as functions, and goals: conditions of the world with plans that make them true, for CRAM's `achieve`.

Every call of a function decorated with `def_plan` is a task.

    @declare_goal
    def gripper_open(side):                      # whether it holds already
        return grippers[side].angle > 0.9

    @def_goal(gripper_open)                      # any side
    def open_it(side):
        perform(an(action, type="opening", gripper=side))

    @def_goal(gripper_open, "left")              # the left one: more specific, tried first
    def open_left():
        ...

    achieve(gripper_open("left"))                # or, as in older plans: achieve(gripper_open, "left")
"""

from __future__ import annotations

import functools
import inspect
import logging
import threading
from concurrent import futures
from concurrent.futures import Future
from dataclasses import dataclass, field
from typing import Any, Callable

from naoqi.errors import NaoError

from .control import Step, do, name_of, subtask, top_level
from .failures import GoalNotAchieved, MadeToBeUsed, PlanError, PlanFailure
from .fluents import here
from .tasks import Task

log = logging.getLogger(__name__)


def def_plan(function: Callable[..., Any]) -> Callable[..., Any]:
    """A function whose calls are tasks in the tree, with their arguments. Callable in plans only."""

    @functools.wraps(function)
    def plan(*arguments: Any, **keywords: Any) -> Any:
        return subtask(do(plan, *arguments, **keywords))

    plan.plan_body = function  # type: ignore[attr-defined]
    return plan


class StartedPlan:
    """A plan in a thread of its own; `run` receives an observer of its tree."""

    def __init__(self, name: str, run: Callable[[Callable[[Task], None]], Any]) -> None:
        self.name = name
        self._answer: Future = Future()
        self._lock = threading.Lock()
        self._root: Task | None = None
        self._cancelled = False
        threading.Thread(target=self._run, args=(run,), name=f"plan {name}", daemon=True).start()

    def done(self) -> bool:
        return self._answer.done()

    def wait(self, timeout: float | None = None) -> bool:
        """Wait for its end, at most so many s of this computer; whether it has ended."""
        return bool(futures.wait([self._answer], timeout).done)

    def result(self, timeout: float | None = None) -> Any:
        """Wait for its end, at most so many s of this computer; its answer.

        Raises:
            PlanFailure: What it failed with.
            NaoError: It has not ended in time; it goes on.
        """
        if not self.wait(timeout):
            raise NaoError(f"the plan {self.name} is not over after {timeout:g} s; it goes on")
        return self._answer.result()

    def cancel(self) -> None:
        """End it; `wait` waits for that."""
        with self._lock:
            self._cancelled = True
            root = self._root
        if root is not None:
            root.evaporate("cancelled")

    def _see(self, task: Task) -> None:
        with self._lock:
            first, self._root = self._root is None, self._root or task
            cancelled = first and self._cancelled
        if cancelled:
            task.evaporate("cancelled")

    def _run(self, run: Callable[[Callable[[Task], None]], Any]) -> None:
        try:
            value = run(self._see)
        except BaseException as error:
            if not isinstance(error, PlanFailure):  # a mistake in the plan: nobody may ever ask for the result
                log.exception("the plan %s ended by an unexpected error", self.name)
            self._answer.set_exception(error)
        else:
            self._answer.set_result(value)


def def_top_level_plan(function: Callable[..., Any]) -> Callable[..., Any]:
    """A plan that may be called anywhere: outside of plans it begins a tree of its own.

    `plan.start(...)` does not wait for its end: it returns a `StartedPlan`.
    """
    plan = def_plan(function)

    @functools.wraps(function)
    def begun(*arguments: Any, **keywords: Any) -> Any:
        if here() is not None:
            return plan(*arguments, **keywords)
        return top_level(do(plan, *arguments, **keywords), name=name_of(function))

    def start(*arguments: Any, **keywords: Any) -> StartedPlan:
        name, body = name_of(function), do(plan, *arguments, **keywords)
        return StartedPlan(name, lambda see: top_level(body, name=name, observers=[see]))

    begun.plan_body = function  # type: ignore[attr-defined]
    begun.start = start  # type: ignore[attr-defined]
    return begun


# --- goals ------------------------------------------------------------------------------------------------------------

Plan = Callable[..., Any]


class _Anything:
    """Matches every argument in the pattern of `def_goal`."""

    def __repr__(self) -> str:
        return "ANY"


ANY = _Anything()


@dataclass(frozen=True)
class Occasion(MadeToBeUsed):
    """A goal with its arguments: a condition that can be true of the world."""

    goal: Goal
    arguments: tuple[Any, ...]

    def unused(self) -> str:
        return f"the goal {self} was made, and nothing was done about it: achieve({self}) does it"

    def __str__(self) -> str:
        return f"{self.goal.name}({', '.join(map(repr, self.arguments))})"

    __repr__ = __str__


@dataclass(eq=False, repr=False)
class Goal:
    """A kind of occasion; a call with arguments returns one.

    `check`: whether an occasion holds; None for unknown. `plans`: patterns and their plans, the most specific first.
    """

    name: str
    check: Callable[..., Any]
    parameters: tuple[str, ...]
    defaults: dict[str, Any] = field(default_factory=dict)
    plans: list[tuple[tuple[Any, ...], Plan]] = field(default_factory=list)

    def __repr__(self) -> str:
        return self.name

    def __call__(self, *arguments: Any, **keywords: Any) -> Occasion:
        values = dict(zip(self.parameters, arguments))
        unknown = [name for name in keywords if name not in self.parameters or name in values]
        values = {**self.defaults, **values, **keywords}
        missing = [name for name in self.parameters if name not in values]
        if unknown or missing or len(arguments) > len(self.parameters):
            raise PlanError(
                f"the goal {self.name} takes ({', '.join(self.parameters)}), not {arguments} {keywords or ''}"
            )
        return Occasion(self, tuple(values[name] for name in self.parameters))


def declare_goal(check: Callable[..., Any]) -> Goal:
    """Declare a goal by the function that checks whether it holds.

    A function that has only a docstring returns None, unknown: its plans always run.
    """
    parameters = inspect.signature(check).parameters.values()
    odd = [each.name for each in parameters if each.kind not in (each.POSITIONAL_OR_KEYWORD, each.POSITIONAL_ONLY)]
    if odd:
        raise PlanError(f"declare_goal {check.__name__}: {', '.join(odd)}: arguments of goals have names and no stars")
    names = tuple(each.name for each in parameters)
    defaults = {each.name: each.default for each in parameters if each.default is not each.empty}
    return Goal(name_of(check), check, names, defaults)


def def_goal(goal: Goal | Plan, *pattern: Any) -> Callable[[Plan], Plan]:
    """Decorator: a plan for a goal, for arguments that match a pattern.

    Args:
        *pattern: For each argument a value to be equal to, ANY, or a predicate; missing ones at the end are ANY. The
            plan receives the arguments without a value in the pattern.
    """
    goal = _goal_of(goal)
    if not isinstance(goal, Goal):
        raise PlanError(f"def_goal: {goal!r} is no goal: declare it with declare_goal")
    if len(pattern) > len(goal.parameters):
        raise PlanError(f"def_goal: {goal.name} has {len(goal.parameters)} arguments, the pattern {len(pattern)}")
    full = (*pattern, *[ANY] * (len(goal.parameters) - len(pattern)))

    def add(plan: Plan) -> Plan:
        goal.plans.append((full, plan))
        # A stable sort: of two that are alike the older one is tried first.
        goal.plans.sort(key=lambda entry: sum(1 if callable(each) else 2 for each in entry[0] if each is not ANY) * -1)
        return plan

    return add


_achieved_by: dict[Plan, Goal] = {}


def achieved_by(function: Plan, goal: Goal) -> None:
    """Let a function, which acts when it is called, mean a goal in `achieve`, `holds`, `perceive_state`, `def_goal`."""
    _achieved_by[function] = goal


def holds(goal: Occasion | Goal | Plan, *arguments: Any) -> bool:
    """Whether an occasion is true now; False if unknown."""
    occasion = _occasion(goal, arguments)
    return bool(occasion.goal.check(*occasion.arguments))


def perceive_state(goal: Occasion | Goal | Plan, *arguments: Any) -> dict[str, Any] | None:
    """The arguments of an occasion by name, if it is true now; None if it is not, or unknown."""
    occasion = _occasion(goal, arguments)

    def body() -> dict[str, Any] | None:
        return dict(zip(occasion.goal.parameters, occasion.arguments)) if holds(occasion) else None

    return subtask(Step(f"perceive {occasion}", body))


def achieve(goal: Occasion | Goal | Plan, *arguments: Any) -> Any:
    """Make an occasion true: nothing is done when it holds already. The answer of its plan, or None.

    Raises GoalNotAchieved if the plan succeeded, and the occasion does not hold; PlanError if there is no plan for
    these arguments.
    """
    occasion = _occasion(goal, arguments)

    def body() -> Any:
        if holds(occasion):
            return None
        answer = _plan_for(occasion)()
        if occasion.goal.check(*occasion.arguments) is False:
            text = f"{occasion} does not hold, although what achieves it went through"
            raise GoalNotAchieved(text, goal=occasion)
        return answer

    return subtask(Step(f"achieve {occasion}", body))


def _occasion(goal: Occasion | Goal | Plan, arguments: tuple[Any, ...]) -> Occasion:
    goal = _goal_of(goal)
    occasion = goal(*arguments) if isinstance(goal, Goal) else goal
    if not isinstance(occasion, Occasion) or (arguments and occasion is goal):
        allowed = "achieve(goal(arguments...)), or achieve(goal_or_function, arguments...)"
        raise PlanError(f"{goal!r}{arguments or ''} is no goal with its arguments: {allowed}")
    occasion.use()
    return occasion


def _goal_of(thing: Any) -> Any:
    """The goal that a function means, or the thing itself."""
    return _achieved_by.get(thing, thing) if callable(thing) and not isinstance(thing, Goal) else thing


def _plan_for(occasion: Occasion) -> Callable[[], Any]:
    for pattern, plan in occasion.goal.plans:
        if all(_fits(want, have) for want, have in zip(pattern, occasion.arguments)):
            given = [have for want, have in zip(pattern, occasion.arguments) if want is ANY or callable(want)]
            return lambda: plan(*given)
    patterns = "; ".join(f"({', '.join(map(repr, pattern))})" for pattern, _ in occasion.goal.plans)
    raise PlanError(f"no plan achieves {occasion}: there are plans for {patterns or 'nothing'}; see def_goal")


def _fits(want: Any, have: Any) -> bool:
    if want is ANY:
        return True
    return bool(want(have)) if callable(want) else bool(want == have)
