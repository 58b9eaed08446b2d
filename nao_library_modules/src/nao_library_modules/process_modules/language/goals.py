"""Goals: what shall be true of the world, and the plans that make it true. CRAM's `achieve`.

@declare_goal
def gripper_open(side):                      # answers whether it holds already
    return grippers[side].angle > 0.9

@def_goal(gripper_open)                      # any side
def open_it(side):
    perform(an(action, type="opening", gripper=side))

@def_goal(gripper_open, "left")              # the left one: more specific, tried first
def open_left():
    ...

achieve(gripper_open("left"))                # or, as plans of old were written: achieve(gripper_open, "left")
"""

from __future__ import annotations

import inspect
from dataclasses import dataclass, field
from typing import Any, Callable

from .control import Step, name_of, subtask
from .failures import GoalNotAchieved, PlanError

Plan = Callable[..., Any]


class _Anything:
    """Fits every argument in the pattern of `def_goal`; there is one: ANY."""

    def __repr__(self) -> str:
        return "ANY"


ANY = _Anything()


@dataclass(frozen=True)
class Occasion:
    """Something that can be true of the world: a goal with its arguments."""

    goal: Goal
    arguments: tuple[Any, ...]

    def __str__(self) -> str:
        return f"{self.goal.name}({', '.join(map(repr, self.arguments))})"

    __repr__ = __str__


@dataclass(eq=False, repr=False)
class Goal:
    """A kind of occasion: call it with arguments to get one.

    Attributes:
        name: Of the function that it was declared with.
        check: Answers whether it holds; None if nobody can tell.
        parameters: Names of its arguments.
        plans: Patterns and the plans for them, the most specific first.
    """

    name: str
    check: Callable[..., Any] | None
    parameters: tuple[str, ...]
    defaults: dict[str, Any] = field(default_factory=dict)
    plans: list[tuple[tuple[Any, ...], Plan]] = field(default_factory=list)

    def __repr__(self) -> str:
        return self.name

    def __call__(self, *arguments: Any, **keywords: Any) -> Occasion:
        """The occasion with these arguments.

        Raises:
            PlanError: It takes other arguments.
        """
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
    """Declare a goal by the function that tells whether it holds.

    A function with nothing but a docstring in it answers None: nobody can tell, and the plans always run.
    """
    parameters = inspect.signature(check).parameters.values()
    odd = [each.name for each in parameters if each.kind not in (each.POSITIONAL_OR_KEYWORD, each.POSITIONAL_ONLY)]
    if odd:
        raise PlanError(f"declare_goal {check.__name__}: {', '.join(odd)}: arguments of goals have names and no stars")
    names = tuple(each.name for each in parameters)
    defaults = {each.name: each.default for each in parameters if each.default is not each.empty}
    return Goal(name_of(check), check, names, defaults)


def def_goal(goal: Goal, *pattern: Any) -> Callable[[Plan], Plan]:
    """Say how a goal is achieved, for arguments that fit a pattern.

    Args:
        goal: What `declare_goal` gave.
        *pattern: A value for each argument that has to be just that, ANY for one that may be anything, a function that
            answers whether it fits. What is left out at the end may be anything. The plan gets the arguments for
            which the pattern has no value.

    Returns:
        What makes a plan of a function.

    Raises:
        PlanError: It is no goal, or the pattern has too many places.
    """
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
    """Have `achieve(function, ...)` mean the goal of what a function does."""
    _achieved_by[function] = goal


def holds(goal: Occasion | Goal, *arguments: Any) -> bool:
    """Whether an occasion is true of the world now, as far as its goal can tell."""
    occasion = _occasion(goal, arguments)
    check = occasion.goal.check
    return bool(check(*occasion.arguments)) if check is not None else False


def perceive_state(goal: Occasion | Goal, *arguments: Any) -> dict[str, Any] | None:
    """Look whether an occasion is true of the world now.

    Returns:
        Name of each argument -> its value, if it is; None if it is not, or nobody can tell.
    """
    occasion = _occasion(goal, arguments)

    def body() -> dict[str, Any] | None:
        return dict(zip(occasion.goal.parameters, occasion.arguments)) if holds(occasion) else None

    return subtask(Step(f"perceive {occasion}", body))


def achieve(goal: Occasion | Goal, *arguments: Any) -> Any:
    """Make an occasion true: nothing is done when it holds already.

    Args:
        goal: An occasion, or a goal with its arguments.
        *arguments: See above.

    Returns:
        What the plan answered; None if there was nothing to do.

    Raises:
        PlanFailure: The plan failed.
        GoalNotAchieved: It went through, and the occasion still does not hold.
        PlanError: There is no plan for these arguments.
    """
    occasion = _occasion(goal, arguments)

    def body() -> Any:
        check = occasion.goal.check
        if check is not None and check(*occasion.arguments):
            return None
        answer = _plan_for(occasion)()
        if check is not None and check(*occasion.arguments) is False:
            text = f"{occasion} does not hold, although what achieves it went through"
            raise GoalNotAchieved(text, goal=occasion)
        return answer

    return subtask(Step(f"achieve {occasion}", body))


def _occasion(goal: Occasion | Goal, arguments: tuple[Any, ...]) -> Occasion:
    if callable(goal) and not isinstance(goal, (Goal, Occasion)):
        goal = _achieved_by.get(goal, goal)
    if isinstance(goal, Goal):
        return goal(*arguments)
    if not isinstance(goal, Occasion) or arguments:
        raise PlanError(f"{goal!r}{arguments or ''} is no occasion: call a goal with its arguments")
    return goal


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
