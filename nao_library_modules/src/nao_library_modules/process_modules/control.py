"""CRAM's control constructs: sequential, parallel, first to end, first to succeed; failure handling; policies.

Every construct takes branches and returns an answer. A branch is a function without arguments, or one with its
arguments bound by `do`:

    top_level(lambda: par(do(open_gripper, "left"), do(open_gripper, "right"), do(move_head, 2.0, 3.0)))

Branches of par, pursue, try_all and partial_order have threads of their own. A branch that is not needed any more is
evaporated, and the construct waits until it has ended: nothing of a construct outlives it.

Failure handling says what a plan does about a failure, and how often it tries again. A handler may try again (`retry`,
`do_retry`), answer for the body (`give`), fail with something else, or return: then the failure is passed up.

    def again(failure):
        go_elsewhere()
        do_retry("navigation")                     # returns after the third time
        fail(NavigationHighLevelFailure, str(failure))

    with with_retry_counters(navigation=3):
        with_failure_handling(do(walk_to, table), {NavigationLowLevelFailure: again})

A policy watches a condition while a plan runs. One with a name can be used without its function:

    with_policy(timeout_policy(10.0), do(walk_to, table))

    @define_policy("near")
    def near(place, distance):
        return Policy(f"within {distance} m", check=lambda: place_of_robot().distance_to(place) > distance)

    with_named_policy("near", (table, 2.0), do(look_around))
"""

from __future__ import annotations

import logging
from collections import ChainMap
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any, Callable, NoReturn, Tuple, Type, Union

from ..core.errors import of_those
from ..core.waiting import WallClock
from .failures import (
    CompositeFailure,
    PlanError,
    PlanFailure,
    PlanTimedOut,
    PolicyCheckConditionMet,
    PolicyInitFailed,
    PolicyNotFound,
    short_repr,
    use_all,
)
from .fluents import AnyFluent, Flow, Pulsed, checkpoint, here, set_here, sleep, uninterrupted, wait_until
from .tasks import Task, TaskState, TaskTree, current_task, failed, failure_of

log = logging.getLogger(__name__)

LONGEST = 80
"""Characters of an argument in the tree."""
PATIENCE = 5.0
"""s until a warning that a branch does not end."""


@dataclass(frozen=True)
class Step:
    """A function with its arguments, and the name of the task that runs it."""

    name: str
    call: Callable[[], Any]
    facts: Mapping[str, Any] = field(default_factory=dict)


Branch = Union[Step, Callable[[], Any]]


def do(function: Callable[..., Any], *arguments: Any, name: str = "", **keywords: Any) -> Step:
    """A branch: a function or a plan with its arguments, called when its turn comes. `name` is that of the task."""
    use_all([*arguments, *keywords.values()])
    given = [short_repr(value, LONGEST) for value in arguments]
    given += [f"{key}={short_repr(value, LONGEST)}" for key, value in keywords.items()]
    # A plan makes a task of its own when it is called; the branch is that task already.
    body = getattr(function, "plan_body", function)
    facts = {"arguments": ", ".join(given)} if given else {}
    return Step(name or name_of(function), lambda: body(*arguments, **keywords), facts)


def name_of(function: Callable[..., Any]) -> str:
    """The name of a function in the task tree."""
    name = getattr(function, "__name__", type(function).__name__)
    return "step" if name == "<lambda>" else name


# --- the whole plan ---------------------------------------------------------------------------------------------------


def top_level(
    body: Branch, *, name: str = "", clock: Any = None, observers: Iterable[Callable[[Task], None]] = ()
) -> Any:
    """Run a plan, in this thread; its answer.

    `clock`: see `nao_library_modules.core.waiting`; default: the computer's. `observers`: called with each task of the
    tree at every change. Raises PlanFailure if the plan failed, or its root was evaporated; PlanError if this thread
    runs a plan already.
    """
    if here() is not None:
        raise PlanError("top_level inside of a plan: call the plan, or give it to seq or par")
    step = _as_step(body)
    tree = TaskTree(name or step.name, step.call, clock or WallClock())
    tree.root.facts.update(step.facts)
    for observer in observers:
        tree.observers.append(observer)
        observer(tree.root)
    set_here(Flow(tree.clock))
    try:
        return tree.root.run()
    finally:
        set_here(None)


def subtask(body: Branch, name: str = "") -> Any:
    """Run a branch as a task of its own, in this thread; its answer."""
    return _task(body, name).run()


# --- in order ---------------------------------------------------------------------------------------------------------


def seq(*branches: Branch) -> Any:
    """One after the other; the answer of the last. Fails with the first failure."""

    def body() -> Any:
        answer = None
        for branch in branches:
            answer = subtask(branch)
        return answer

    return subtask(Step("seq", body))


def try_in_order(*branches: Branch) -> Any:
    """One after the other until one succeeds; its answer. CompositeFailure if all fail."""

    def body() -> Any:
        failures = []
        for branch in branches:
            try:
                return subtask(branch)
            except PlanFailure as failure:
                failures.append(failure)
        raise CompositeFailure(failures)

    return subtask(Step("try_in_order", body))


def try_each_in_order(function: Callable[[Any], Any], items: Iterable[Any]) -> Any:
    """A function on one item after the other until it succeeds; its answer. CompositeFailure if it never does."""
    return try_in_order(*(do(function, item) for item in items))


# --- in parallel ------------------------------------------------------------------------------------------------------


def par(*branches: Branch) -> list[Any]:
    """All at once; the answers in order. Fails with the first failure, and ends the others then."""

    def body() -> list[Any]:
        return _all_of(map(_task, branches))

    return subtask(Step("par", body))


def par_loop(function: Callable[[Any], Any], items: Iterable[Any]) -> list[Any]:
    """A function on all items at once; see `par`."""
    return par(*(do(function, item) for item in items))


def pursue(*branches: Branch) -> Any:
    """All at once until the first one ends: its answer, or its failure. The others are ended."""

    def body() -> Any:
        with _started(map(_task, branches)) as tasks:
            wait_until(lambda: any(task.state.over for task in tasks), [task.status for task in tasks])
            return _first(task for task in tasks if task.state.over).value()

    if not branches:
        raise PlanError("pursue needs a branch: without one nothing would ever end it")
    return subtask(Step("pursue", body))


def try_all(*branches: Branch) -> Any:
    """All at once until one succeeds: its answer. The others are ended. CompositeFailure if all fail."""

    def body() -> Any:
        with _started(map(_task, branches)) as tasks:
            wait_until(lambda: _succeeded(tasks) or _bug(tasks) or _over(tasks), [task.status for task in tasks])
            bug = _bug(tasks)
            if bug:
                return bug[0].value()
            winners = _succeeded(tasks)
            if winners:
                return _first(winners).value()
            raise CompositeFailure([failure_of(task) for task in tasks])  # type: ignore[misc]

    return subtask(Step("try_all", body))


def partial_order(branches: Mapping[str, Branch], order: Iterable[Sequence[str]]) -> dict[str, Any]:
    """All at once, but some before others; the answers by name. Fails as `par`.

    `order`: pairs (or longer chains) of names: each begins when the one before it has succeeded. Raises PlanError if a
    name is unknown, or the order has a cycle.
    """
    before = _predecessors(branches, order)

    def body() -> dict[str, Any]:
        tasks: dict[str, Task] = {}

        def when_ready(name: str, step: Step) -> Any:
            waited = [tasks[each] for each in before[name]]
            wait_until(lambda: len(_succeeded(waited)) == len(waited), [task.status for task in waited])
            return step.call()

        for name, branch in branches.items():
            step = _as_step(branch)
            tasks[name] = _task(Step(name, lambda name=name, step=step: when_ready(name, step), step.facts))
        return dict(zip(tasks, _all_of(tasks.values())))

    return subtask(Step("partial_order", body))


# --- waiting for fluents ----------------------------------------------------------------------------------------------


def wait_for(fluent: AnyFluent, timeout: float | None = None) -> Any:
    """Wait until a fluent is true; its value, or False after the timeout.

    `timeout`: s of the plan's clock; None for no limit.
    """
    seen: list[Any] = []

    def look() -> bool:
        seen[:] = [fluent.take() if isinstance(fluent, Pulsed) else fluent.value]
        return bool(seen[0])

    return seen[0] if wait_until(look, [fluent], timeout) else False


def whenever(fluent: AnyFluent, body: Callable[[], Any], missed: str = "once") -> NoReturn:
    """Run a body at every pulse at which a fluent is true, and now if it is; never ends by itself.

    Put it beside something else: `pursue(do(whenever, ...), plan)`. Of a `pulsed` fluent see `Pulsed` for `missed`: of
    the pulses that come while the body runs, "never" forgets all, "once" runs it once more, "always" once for each.
    """

    def watch() -> NoReturn:
        pulses = Pulsed(fluent, missed)
        if fluent.value:
            body()
            pulses.forget_missed()
        while True:
            wait_for(pulses)
            if fluent.value:
                body()
            pulses.forget_missed()
            checkpoint()

    return subtask(Step(f"whenever {fluent.name}", watch))


# --- inside -----------------------------------------------------------------------------------------------------------


@contextmanager
def _started(tasks: Iterable[Task]) -> Iterator[list[Task]]:
    """Tasks that run at the same time while a block lasts; at its end the remaining ones are ended."""
    tasks = list(tasks)
    try:
        for task in tasks:
            task.start()
        yield tasks
    finally:
        running = [task for task in tasks if not task.state.over]
        for task in running:
            task.evaporate("not needed any more")
        with uninterrupted():
            for task in tasks:
                while not task.join(PATIENCE):
                    log.warning("the task %s was evaporated %g s ago and does not end", task.path, PATIENCE)


def _all_of(tasks: Iterable[Task]) -> list[Any]:
    with _started(tasks) as started:
        statuses = [task.status for task in started]
        wait_until(lambda: any(failed(task) for task in started) or _over(started), statuses)
        losers = [task for task in started if failed(task)]
        if losers:
            _first(losers).value()
        return [task.value() for task in started]


def _task(branch: Branch, name: str = "") -> Task:
    step = _as_step(branch)
    task = Task(name or step.name, step.call, current_task())
    task.facts.update(step.facts)
    return task


def _as_step(branch: Branch) -> Step:
    if isinstance(branch, Step):
        return branch
    if not callable(branch):
        raise PlanError(f"{branch!r} is no branch: give a function, or do(function, arguments...)")
    return do(branch)


def _first(tasks: Iterable[Task]) -> Task:
    return min(tasks, key=lambda task: task.ending)  # type: ignore[arg-type, return-value]


def _succeeded(tasks: Iterable[Task]) -> list[Task]:
    return [task for task in tasks if task.state is TaskState.SUCCEEDED]


def _bug(tasks: Iterable[Task]) -> list[Task]:
    """Tasks that ended with an error that is no failure of a plan: nothing may catch it."""
    return [task for task in tasks if task.failure is not None and not isinstance(task.failure, PlanFailure)]


def _over(tasks: Iterable[Task]) -> bool:
    return all(task.state.over for task in tasks)


def _predecessors(branches: Mapping[str, Branch], order: Iterable[Sequence[str]]) -> dict[str, set[str]]:
    before: dict[str, set[str]] = {name: set() for name in branches}
    for chain in order:
        for name in chain:
            if name not in before:
                raise PlanError(f"partial_order: no branch {name!r}{of_those(name, branches)}")
        for first, second in zip(chain, chain[1:]):
            before[second].add(first)
    open_names = dict(before)
    while open_names:
        ready = [name for name, earlier in open_names.items() if not earlier & open_names.keys()]
        if not ready:
            raise PlanError(f"partial_order: {', '.join(open_names)} wait for each other")
        for name in ready:
            del open_names[name]
    return before


# --- failure handling -------------------------------------------------------------------------------------------------

Kinds = Union[Type[PlanFailure], Tuple[Type[PlanFailure], ...]]
COUNTERS = "retry counters"
HANDLING = "handling"


class _Retry(BaseException):
    """A handler has the body run again."""


class _Give(BaseException):
    def __init__(self, value: Any) -> None:
        super().__init__()
        self.value = value


def with_failure_handling(body: Branch, handlers: Mapping[Kinds, Callable[[PlanFailure], Any]]) -> Any:
    """Run a body; on a failure, run the first handler that matches. The answer is the body's, or that of `give`.

    `handlers`: by class of failures, or by a tuple of classes. Raises PlanFailure if no handler matches or it passes
    the failure up, or it fails itself.
    """
    for kinds in handlers:
        for kind in kinds if isinstance(kinds, tuple) else (kinds,):
            if not (isinstance(kind, type) and issubclass(kind, PlanFailure)):
                raise PlanError(f"with_failure_handling: {kind!r} is no class of PlanFailure")

    def handled() -> Any:
        while True:
            try:
                return subtask(body)
            except PlanFailure as failure:
                handler = next((each for kinds, each in handlers.items() if isinstance(failure, kinds)), None)
                if handler is None:
                    raise
                current_task().scope[HANDLING] = True
                try:
                    handler(failure)
                except _Retry:
                    continue
                except _Give as given:
                    return given.value
                finally:
                    del current_task().scope[HANDLING]
                raise

    return subtask(Step("with_failure_handling", handled))


def retry() -> NoReturn:
    """In a handler: run the body again."""
    _check_handling("retry")
    raise _Retry


def give(value: Any = None) -> NoReturn:
    """In a handler: answer for the body."""
    _check_handling("give")
    raise _Give(value)


@contextmanager
def with_retry_counters(**counters: int) -> Iterator[None]:
    """Counters that `do_retry` counts down in this block, by name."""
    scope = current_task().scope
    kept = scope.get(COUNTERS, {})
    scope[COUNTERS] = {**kept, **{name: [left, left] for name, left in counters.items()}}
    try:
        yield
    finally:
        scope[COUNTERS] = kept


def do_retry(counter: str, before: Callable[[], Any] | None = None) -> None:
    """In a handler: run the body again, after `before`, if the counter allows it, and count it down; else return."""
    entry = _counter(counter)
    _check_handling("do_retry")
    with current_task().tree.lock:  # branches beside each other may share it
        if entry[0] <= 0:
            return
        entry[0] -= 1
    if before is not None:
        before()
    retry()


def get_counter(counter: str) -> int:
    """How many tries `do_retry` has left."""
    return _counter(counter)[0]


def reset_counter(counter: str) -> None:
    """Set a counter back to its start."""
    entry = _counter(counter)
    entry[0] = entry[1]


def _check_handling(what: str) -> None:
    """PlanError outside of a handler: the signal would leave the plan."""
    if not any(HANDLING in scope for scope in _scopes()):
        raise PlanError(f"{what} outside of a handler: see with_failure_handling")


def _counter(name: str) -> list[int]:
    counters = ChainMap(*(scope.get(COUNTERS, {}) for scope in _scopes()))
    if name not in counters:
        raise PlanError(f"no retry counter {name!r}{of_those(name, counters)}; see with_retry_counters")
    return counters[name]


def _scopes() -> Iterator[dict[str, Any]]:
    """Variables of this task and those above, the innermost first."""
    task: Task | None = current_task()
    while task is not None:
        yield task.scope
        task = task.parent


# --- policies ---------------------------------------------------------------------------------------------------------

PERIOD = 0.1


@dataclass(frozen=True)
class Policy:
    """A condition to watch while a body runs."""

    name: str
    check: Union[AnyFluent, Callable[[], Any]]  # a fluent, or a function that is polled; the body ends when it is true
    init: Callable[[], Any] | None = None  # runs first; the body does not begin when it returns False
    recover: Callable[[], Any] | None = None  # runs when the condition has come true, after the end of the body
    clean_up: Callable[[], Any] | None = None  # runs at the end in any case, uninterrupted
    period: float = PERIOD  # between two polls, s
    failure: Type[PolicyCheckConditionMet] = PolicyCheckConditionMet


_named: dict[str, Callable[..., Policy]] = {}


def define_policy(name: str) -> Callable[[Callable[..., Policy]], Callable[..., Policy]]:
    """Register a function that returns a policy under a name; it replaces an earlier one."""

    def keep(function: Callable[..., Policy]) -> Callable[..., Policy]:
        _named[name] = function
        return function

    return keep


def named_policy(name: str) -> Callable[..., Policy]:
    """The function of a policy's name."""
    if name not in _named:
        raise PolicyNotFound(f"no policy {name!r}{of_those(name, sorted(_named))}", policy=name)
    return _named[name]


@define_policy("timeout")
def timeout_policy(time: float) -> Policy:
    """Limits the time of the body, s of the plan's clock."""

    def over() -> bool:
        sleep(time)
        return True

    return Policy(f"at most {time:g} s", over, failure=PlanTimedOut)


def with_policy(policy: Policy, body: Branch) -> Any:
    """Run a body while a policy watches; the answer of the body.

    Raises:
        PolicyInitFailed: `init` returned False.
        PolicyCheckConditionMet: The condition came true; the body has been ended.
    """
    watched = f"policy {policy.name!r}"
    met = object()

    def watch() -> object:
        if isinstance(policy.check, AnyFluent):
            wait_for(policy.check)
        else:
            while not policy.check():
                sleep(policy.period)
        return met

    def run() -> Any:
        if policy.init is not None and policy.init() is False:
            raise PolicyInitFailed(f"{watched} could not begin", policy=policy.name)
        try:
            answer = pursue(body, do(watch, name=watched))
            if answer is not met:
                return answer
            if policy.recover is not None:
                policy.recover()
            raise policy.failure(f"{watched} ended what it watched", policy=policy.name)
        finally:
            if policy.clean_up is not None:
                with uninterrupted():
                    policy.clean_up()

    return subtask(Step("with_policy", run))


def with_named_policy(name: str, parameters: Iterable[Any], body: Branch) -> Any:
    """As `with_policy`, with the policy of a name for these parameters; PolicyNotFound if there is none."""
    return with_policy(named_policy(name)(*parameters), body)


def with_policies(policies: Iterable[Policy], body: Branch) -> Any:
    """As `with_policy` for several policies, the first one outermost."""
    inner = body
    for policy in reversed(list(policies)):
        inner = do(with_policy, policy, inner)
    return subtask(inner)


def with_named_policies(policies: Iterable[tuple[str, Iterable[Any]]], body: Branch) -> Any:
    """As `with_policies`, with pairs of a name and parameters; PolicyNotFound if there is none of a name."""
    return with_policies([named_policy(name)(*parameters) for name, parameters in policies], body)
