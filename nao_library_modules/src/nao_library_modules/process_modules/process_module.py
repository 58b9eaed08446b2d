"""Process modules: threads that carry out designators, one at a time or several at once; and which of them run.

A module is a class with `execute(command)`, which carries out one solution of a designator. It is plan code: it waits
with `wait_until`, and is ended there when its work is not wanted any more. Plans reach modules by `pm_execute`, and
mostly by `perform`, which finds the module itself:

    with with_process_modules_running(Manipulation(robot), Speech(robot), voice="speech"):
        top_level(lambda: perform(an(action, type="opening", gripper="left")))
"""

from __future__ import annotations

import enum
import logging
import threading
from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, Union

from ..core.errors import of_those
from ..core.waiting import WallClock
from .control import Step, do, subtask, top_level
from .designators.designator import Designator, current_desig
from .designators.rules import Command
from .failures import (
    DesignatorError,
    GoalNotAchieved,
    NoMatchingProcessModule,
    PlanError,
    PlanFailure,
    ProcessModuleNotRunning,
    ProcessModuleRunning,
    TaskEvaporatedFailure,
    UnknownProcessModule,
)
from .fluents import Flow, Fluent, retry_after_suspension, uninterrupted, wait_until
from .plans import Occasion, holds
from .tasks import Task

log = logging.getLogger(__name__)

END_PATIENCE = 10.0
"""s that a module has to put things right after a cancel, before a warning."""


# --- a process module -------------------------------------------------------------------------------------------------


class ModuleState(enum.Enum):
    OFFLINE = "offline"
    WAITING = "waiting"
    RUNNING = "running"
    FAILED = "failed"


class Request:
    """A designator that a module carries out, and what came of it."""

    def __init__(self, command: Command, designator: Designator | None) -> None:
        self.command = command
        self.designator = designator
        self.over = Fluent("request is over", False)
        self.result: Any = None
        self.failure: BaseException | None = None
        self.cancelled = False
        self.root: Task | None = None


class ProcessModule(ABC):
    """A module that does one thing at a time; other requests wait for their turn.

    Attributes:
        status: A fluent with its `ModuleState`; FAILED until the next request begins.
        result: A fluent with the last request that is over.
        observers: Called with each task of what it does whenever that has changed.
        watchers: Called with each request when it is over, in the thread that ended it.
    """

    name = ""
    asynchronous = False

    def __init__(self, name: str = "") -> None:
        self.name = name or self.name or type(self).__name__
        self.status = Fluent(f"status of {self.name}", ModuleState.OFFLINE)
        self.input = Fluent(f"input of {self.name}")
        self.result = Fluent(f"result of {self.name}")
        self.clock: Any = WallClock()
        self.observers: list[Callable[[Task], None]] = []
        self.watchers: list[Callable[[Request], None]] = []
        self._lock = threading.Lock()
        self._waiting: deque[Request] = deque()
        self._running: list[Request] = []
        self._work = threading.Event()
        self._ending = False
        self._left = threading.Event()
        self._own_thread = True
        self._thread: threading.Thread | None = None

    # --- what a module is made of -------------------------------------------------------------------------------------

    @abstractmethod
    def execute(self, command: Command) -> Any:
        """Carry out a command, in a thread of the module; the answer goes to the caller.

        Raises PlanFailure if it cannot be done.
        """

    def on_started(self) -> None:  # noqa: B027  most modules need none
        """Called in the module's thread when it begins to run."""

    def on_stopped(self) -> None:  # noqa: B027  most modules need none
        """Called in the module's thread when it has ended."""

    def resources(self, command: Command) -> frozenset[str]:
        """What a command needs for itself, as "left arm"; commands of an asynchronous module take turns."""
        return frozenset()

    # --- running ------------------------------------------------------------------------------------------------------

    @property
    def state(self) -> ModuleState:
        return self.status.value

    def start(self) -> ProcessModule:
        """Run `pm_run` in a thread of its own; see `stop`."""
        thread = threading.Thread(target=self.run, name=f"process module {self.name}", daemon=True)
        self._take(thread, own=True)
        thread.start()
        return self

    def stop(self) -> None:
        """End it, and wait for the end: what runs is cancelled, what waits fails."""
        with self._lock:
            thread = self._thread
            if thread is None:
                raise ProcessModuleNotRunning(f"the process module {self.name} does not run")
            self._ending = True
        self.cancel()
        self._work.set()
        self._left.wait()
        if self._own_thread:  # others lead a life of their own after pm_run
            thread.join()
        with self._lock:
            if self._thread is thread:
                self._thread = None

    def run(self) -> None:
        """The event loop, in the thread that calls; it ends with `stop`."""
        try:
            self._serve()
        finally:
            self._left.set()

    def submit(self, request: Request) -> None:
        with self._lock:
            if self._thread is not None and not self._ending:
                self._waiting.append(request)
                self._work.set()
                return
        request.failure = ProcessModuleNotRunning(f"the process module {self.name} does not run")
        request.over.value = True

    def cancel(self, request: Request | None = None) -> None:
        """Cancel a request, or all of them; returns at once, `request.over` is true when it has ended."""
        with self._lock:
            chosen = [request] if request is not None else [*self._running, *self._waiting]
            dropped = [each for each in chosen if each in self._waiting]
            for each in dropped:
                self._waiting.remove(each)
            for each in chosen:
                each.cancelled = True
            roots = [each.root for each in chosen if each.root is not None]
        for root in roots:
            root.evaporate("cancelled")
        for each in dropped:
            each.failure = TaskEvaporatedFailure(f"{self.name}: {each.command}", "cancelled before it began")
            self._tell(each)

    # --- inside -------------------------------------------------------------------------------------------------------

    def _take(self, thread: threading.Thread, own: bool) -> None:
        """Note the thread that is about to run it; `own`: whether that ends with it."""
        with self._lock:
            if self._thread is not None:
                raise ProcessModuleRunning(f"the process module {self.name} runs already")
            self._ending = False
            self._left.clear()
            self._own_thread = own
            self._thread = thread

    def _serve(self) -> None:
        self.on_started()
        self.status.value = ModuleState.WAITING
        workers: list[threading.Thread] = []
        try:
            while not self._ending:
                self._work.wait()
                self._work.clear()
                for request in self._due():
                    workers = [worker for worker in workers if worker.is_alive()]
                    workers.append(self._begin(request))
        finally:
            for worker in workers:
                worker.join()
            self._refuse_all()
            self.status.value = ModuleState.OFFLINE
            self.on_stopped()

    def _due(self) -> list[Request]:
        with self._lock:
            if not self.asynchronous:
                due = [self._waiting.popleft()] if self._waiting and not self._running else []
            else:
                taken: set[str] = set().union(*(self.resources(each.command) for each in self._running))
                due = []
                for each in tuple(self._waiting):
                    needs = self.resources(each.command)
                    if not needs & taken:
                        self._waiting.remove(each)
                        due.append(each)
                    taken |= needs  # requests for the same resource keep their order
            self._running += due
            return due

    def _begin(self, request: Request) -> threading.Thread:
        self.input.value = request
        self.status.value = ModuleState.RUNNING
        worker = threading.Thread(target=self._carry_out, args=(request,), name=f"{self.name} works", daemon=True)
        worker.start()
        return worker

    def _carry_out(self, request: Request) -> None:
        def see(task: Task) -> None:
            if request.root is None and task.parent is None:
                request.root = task
                if request.cancelled:
                    task.evaporate("cancelled")

        step = do(self.execute, request.command, name=str(request.command))
        try:
            request.result = top_level(step, clock=self.clock, observers=[see, *self.observers])
        except BaseException as error:
            request.failure = error
            if not isinstance(error, PlanFailure):
                log.exception("the process module %s: %s", self.name, request.command)
        finally:
            self._ended(request)

    def _ended(self, request: Request) -> None:
        with self._lock:
            self._running.remove(request)
            idle = not self._running
        failed = request.failure is not None and not request.cancelled
        if idle:
            self.status.value = ModuleState.FAILED if failed else ModuleState.WAITING
        self.result.value = request
        self._tell(request)
        self._work.set()

    def _refuse_all(self) -> None:
        with self._lock:
            left, self._waiting = list(self._waiting), deque()
        for request in left:
            request.failure = ProcessModuleNotRunning(f"the process module {self.name} was stopped")
            self._tell(request)

    def _tell(self, request: Request) -> None:
        for watch in tuple(self.watchers):
            watch(request)
        request.over.value = True


class AsynchronousProcessModule(ProcessModule):
    """A module that does several things at once, as far as they do not need the same; see `resources`."""

    asynchronous = True


def pm_run(module: ProcessModule) -> None:
    """Run the event loop of a module in this thread, until `stop`. `with_process_modules_running` is easier."""
    module._take(threading.current_thread(), own=False)
    try:
        module.run()
    finally:
        with module._lock:
            module._thread = None


def pm_status(module: ProcessModule) -> ModuleState:
    return module.state


def pm_cancel(module: ProcessModule) -> None:
    """Cancel what a module does, and what waits for it."""
    module.cancel()


def execute_on(module: ProcessModule, command: Command, designator: Designator | None = None) -> Any:
    """Have a module carry out a command, in a plan: waits until that is over.

    An offline module is waited for, with a warning. When the calling task is ended, the command is cancelled and its
    end awaited; a suspension cancels it, and it is sent again when the task is woken. Raises PlanFailure: what the
    module failed with.
    """

    def once() -> Any:
        if module.state is ModuleState.OFFLINE:
            log.warning("the process module %s is offline: %s waits for it", module.name, command)
            wait_until(lambda: module.state is not ModuleState.OFFLINE, [module.status])
        request = Request(command, designator)
        module.submit(request)
        try:
            wait_until(lambda: request.over.value, [request.over])
        finally:
            if not request.over.value:
                module.cancel(request)
                with uninterrupted():
                    while not wait_until(lambda: request.over.value, [request.over], END_PATIENCE):
                        log.warning("%s was cancelled %g s ago and does not end", command, END_PATIENCE)
        if request.failure is not None:
            raise request.failure
        return request.result

    return subtask(Step(str(command), lambda: retry_after_suspension(once)))


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
