"""Which process modules there are, which run, and which one does what a designator describes.

with with_process_modules_running(Manipulation(robot), Speech(robot), voice="speech"):
    top_level(lambda: perform(an(action, type="opening", gripper="left")))
"""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, Union

from ...base.suggestion import of_those
from ..designators.designator import Designator, current_desig
from ..designators.rules import Command
from ..language.control import Step, subtask
from ..language.failures import (
    DesignatorError,
    GoalNotAchieved,
    NoMatchingProcessModule,
    PlanError,
    ProcessModuleNotRunning,
    ProcessModuleRunning,
    UnknownProcessModule,
)
from ..language.flow import Flow, wait_until
from ..language.fluents import Fluent
from ..language.goals import Occasion, holds
from .process_module import ModuleState, ProcessModule, Request, execute_on

Named = Union[ProcessModule, str]

_lock = threading.Lock()
_modules: dict[str, ProcessModule] = {}
_aliases: dict[str, str] = {}


def register_process_module(module: ProcessModule) -> ProcessModule:
    with _lock:
        there = _modules.get(module.name)
        if there is not None and there is not module and there.state is not ModuleState.OFFLINE:
            raise ProcessModuleRunning(f"a process module {module.name} runs already")
        _modules[module.name] = module
    return module


def get_process_module(name: Named) -> ProcessModule:
    """The module of a name, or of an alias."""
    if isinstance(name, ProcessModule):
        return name
    with _lock:
        found = _modules.get(_aliases.get(name, name))
        known = sorted({*_modules, *_aliases})
    if found is None:
        raise UnknownProcessModule(f"no process module {name!r}{of_those(name, known)}")
    return found


def get_running_process_module(name: Named) -> ProcessModule:
    """The module of a name; ProcessModuleNotRunning if it does not run."""
    module = get_process_module(name)
    if module.state is ModuleState.OFFLINE:
        raise ProcessModuleNotRunning(f"the process module {module.name} does not run")
    return module


def running_process_modules() -> list[ProcessModule]:
    with _lock:
        return [module for module in _modules.values() if module.state is not ModuleState.OFFLINE]


def wait_for_process_module_running(name: Named, timeout: float | None = None) -> bool:
    """Wait, in a plan, until a module runs; whether it does."""
    module = get_process_module(name)
    return wait_until(lambda: module.state is not ModuleState.OFFLINE, [module.status], timeout)


@contextmanager
def with_process_module_aliases(**aliases: str) -> Iterator[None]:
    """Other names for modules, by alias, while a block lasts."""
    with _lock:
        kept = {alias: _aliases.get(alias) for alias in aliases}
        _aliases.update(aliases)
    try:
        yield
    finally:
        with _lock:  # only these: plans beside this one have theirs
            for alias, before in kept.items():
                if before is None:
                    _aliases.pop(alias, None)
                else:
                    _aliases[alias] = before


@contextmanager
def with_process_modules_running(*modules: ProcessModule, **aliases: str) -> Iterator[tuple[ProcessModule, ...]]:
    """Run modules while a block lasts: they have started when it begins, and have ended after it.

    Raises ProcessModuleRunning if one of them runs already.
    """
    started: list[ProcessModule] = []
    with with_process_module_aliases(**aliases):
        try:
            for module in modules:
                register_process_module(module).start()
                started.append(module)
            for module in started:
                _wait_started(module)
            yield modules
        finally:
            for module in started:
                module.stop()


def start_process_modules(*modules: ProcessModule) -> None:
    """Run modules until `stop_process_modules`, each in a thread of its own."""
    for module in modules:
        register_process_module(module).start()
    for module in modules:
        _wait_started(module)


def stop_process_modules() -> None:
    for module in running_process_modules():
        module.stop()


# --- from designators to modules --------------------------------------------------------------------------------------


def matching_process_module(desig: Designator) -> str:
    """Name of the module that its solution is for.

    Raises DesignatorError if it has no solution that a module could carry out.
    """
    return _command_of(desig).module


def available_process_module(name: Named) -> bool:
    try:
        get_running_process_module(name)
    except (UnknownProcessModule, ProcessModuleNotRunning):
        return False
    return True


def pm_execute(module: Named, desig: Union[Designator, Command]) -> Any:
    """Have a module do what a designator describes, in a plan: waits until it is done. See `execute_on`.

    Raises DesignatorError: it has no solution that a module could carry out; PlanFailure: what the module failed with.
    """
    target = get_process_module(module)
    if isinstance(desig, Command):
        return execute_on(target, desig)
    return execute_on(target, _command_of(desig), desig)


def pm_execute_matching(desig: Designator) -> Any:
    """Have the matching module do what a designator describes.

    Raises NoMatchingProcessModule: the module does not run; PlanFailure: what the module failed with.
    """
    command = _command_of(desig)
    if not available_process_module(command.module):
        running = ", ".join(module.name for module in running_process_modules()) or "none"
        raise NoMatchingProcessModule(
            f"{desig} is for the process module {command.module}, which does not run: running are {running}"
        )
    return execute_on(get_process_module(command.module), command, desig)


def perform(desig: Union[Designator, Command]) -> Any:
    """Do what an action or a motion designator describes, in a plan; the answer of the module or the plan.

    An action whose rules give a plan (a function) runs that plan. A key `goal` with an occasion says what is to hold:
    nothing is done when it holds already, and it has to hold afterwards. Raises GoalNotAchieved if the goal does not
    hold afterwards, PlanFailure if it could not be done.
    """
    if isinstance(desig, Command):
        return execute_on(get_running_process_module(desig.module), desig)
    if not isinstance(desig, Designator) or desig.kind not in ("action", "motion"):
        raise PlanError(f"perform: {desig!r} is no designator of an action or a motion")
    desig = current_desig(desig)
    value = desig.get("goal")
    goal = value if isinstance(value, Occasion) else None  # of walks it is a place

    def body() -> Any:
        if goal is not None and holds(goal):
            return None
        solution = desig.reference()
        answer = solution() if callable(solution) else pm_execute_matching(desig)
        if goal is not None and not holds(goal):
            raise GoalNotAchieved(f"{goal} does not hold after {desig}", goal=goal)
        return answer

    return subtask(Step(f"perform {desig}", body, {"designator": str(desig)}))


def monitor_process_module(module: Named, *desigs: Union[Designator, Command]) -> Any:
    """Wait, in a plan, for the next end of a command of a module, or of one of `desigs`; its result.

    Raises PlanFailure: what it failed with.
    """
    target = get_process_module(module)
    ended = Fluent(f"what {target.name} has done", None)

    def watch(request: Request) -> None:
        # The first counts, however soon another one follows.
        if not desigs or any(each is request.designator or each is request.command for each in desigs):
            ended.update(lambda first: first or request)

    target.watchers.append(watch)
    try:
        wait_until(lambda: ended.value is not None, [ended])
    finally:
        target.watchers.remove(watch)
    request = ended.value
    if request.failure is not None:
        raise request.failure
    return request.result


def _command_of(desig: Designator) -> Command:
    solution = desig.reference()
    if not isinstance(solution, Command):
        raise DesignatorError(desig, f"its solution {solution!r} is nothing that a process module carries out")
    return solution


def _wait_started(module: ProcessModule) -> None:
    # A flow of its own works outside of plans, too, and the end of a plan does not cut it short.
    Flow(module.clock).wait(lambda: module.state is not ModuleState.OFFLINE, [module.status], None)
