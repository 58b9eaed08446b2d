"""Turns a plain Python class into a libqi service with NAOqi's exact signatures.

libqi resolves overloads by signature, and a Python method has only one. So for every overload in NAOqi's table the
published object gets a function of its own, all under the same remote name, and all of them end in the one method of
the implementation. A module may be implemented by several objects, each with a part of its methods. Wrong arguments
are refused by libqi itself with the list of candidates, as on the robot.
"""

from __future__ import annotations

import inspect
import logging
import threading
from functools import lru_cache, partial, wraps
from typing import Any, Callable, Iterable, Mapping, Sequence

import qi

from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.naoqi.binding.api import (
    Method,
    holds_buffer,
    module_methods,
    own_methods,
    published_type,
    tables_of,
)
from nao_sim_bridge.naoqi.binding.common import CommonModule
from nao_sim_bridge.naoqi.binding.later import Later, made
from nao_sim_bridge.naoqi.binding.limits import check_sizes
from nao_sim_bridge.naoqi.binding.older import older_methods, warning_once
from nao_sim_bridge.naoqi.binding.unfinished import Unfinished
from nao_sim_bridge.naoqi.binding.wire_types import fitted, fitted_to, has_bytes

log = logging.getLogger("nao_sim.services")

# Every libqi object has these by itself.
NATIVE = frozenset({"isStatsEnabled", "clearStats", "isTraceEnabled"})
ANY = ANY_ARGUMENTS = "m"
# Characters of an error text; what is between its ends is left out when somebody sent a book as a name.
LONGEST_ERROR = 1200
# The answer where something else was raised than what is raised on purpose.
DEFECT = "a defect of the simulator, whose log tells more"
PACKAGE = __name__.partition(".")[0]
Methods = Mapping[str, Callable[..., Any]]
WithBytes = Callable[[Any], Any]
"""Makes a libqi future of a value with bytes in it."""


class Service:
    """A libqi service of one NAOqi module. It stays on the network when other objects take over its work.

    Attributes:
        object: What to register under the name of the module.

    Args:
        module: A key of the API table.
        parts: Objects whose methods do the work; those with the names of the table are published. One with an attribute
            `signals` publishes these libqi signals, by name; it has to keep them in `take_over(former)`. Of parts that
            are made `Later` all of the table is published, and the signals that they are given.
        broker: What the methods that every module has need to know: its `name` and `unregister(module)`. Its
            `with_bytes(value)` makes a libqi future of an answer that holds bytes.
    """

    def __init__(self, module: str, parts: Sequence[Any], broker: Any) -> None:
        self._module = module
        self._broker = broker
        self._parts = parts
        self._targets = self._bound_to(parts)
        table = published_methods(module)
        self._any = {name for name, method in table.items() if published_type(method.returns) == ANY}
        self._pictures = {name for name, method in table.items() if holds_buffer(method.returns)}
        names = table.keys() - NATIVE if isinstance(parts, Later) else self._targets.methods
        body: dict[str, Any] = {}
        for name, functions in _functions(module).items():
            if name in names:
                body.update(functions)
        self.object = type(module, (), body)()
        self.object.__service__ = self  # what the functions, which services share, ask
        signals = [getattr(part, "signals", {}) for part in made(parts)]
        if isinstance(parts, Later) and parts.signals is not None:
            signals = [parts.signals.published]
        for name, signal in (entry for one in signals for entry in one.items()):
            setattr(self.object, name, signal)

    def answer(self, method: str, args: Sequence[Any]) -> Any:
        """What goes back to who calls a method; see `answer`."""
        with_bytes = self._broker.with_bytes if method in self._any else None
        return self._targets.answer(self._module, method, args, with_bytes, method in self._pictures)

    def rebind(self, parts: Sequence[Any]) -> Callable[[], None]:
        """Have other objects of the same kinds do the work from now on.

        What it returns is to be called when the former ones do nothing any more: it ends calls that wait for them.
        """
        if isinstance(parts, Later) and isinstance(self._parts, Later) and parts.signals and self._parts.signals:
            parts.signals.take_over(self._parts.signals)
        for part in made(parts):
            if hasattr(part, "take_over"):
                part.take_over(next(former for former in self._parts if type(former) is type(part)))
        former, self._targets, self._parts = self._targets, self._bound_to(parts), parts
        return former.end

    def _bound_to(self, parts: Sequence[Any]) -> _Targets:
        if isinstance(parts, Later):
            return _Targets({}, lambda: self._methods_of(parts))
        return _Targets(self._methods_of(parts))

    def _methods_of(self, parts: Sequence[Any]) -> Methods:
        table = published_methods(self._module)
        common = CommonModule(self._module, table, self._broker)
        for name, method in table.items():
            target = None if name in NATIVE else _target(name, parts, common)
            if target is not None:
                common.targets[name] = _checked(self._module, method, target)
        for name, older in older_methods(self._module).items():
            if older.calls and all(target in common.targets for target in older.targets):
                common.targets[name] = _checked(self._module, older.method, older.bound_to(common.targets))
        return {**common.targets, "pCall": common.pCall}


class _Targets:
    """What answers the calls of a service, and the calls that take simulated time and have not ended.

    Without `methods`, `make` gives them at the first call.
    """

    def __init__(self, methods: Methods, make: Callable[[], Methods] = dict) -> None:
        self.methods = methods
        self._make = make
        self._making = threading.Lock()
        self._unfinished = Unfinished()
        self._ended = False

    def answer(self, module: str, method: str, args: Iterable[Any], *about_bytes: Any) -> Any:
        call = self.methods.get(method) or partial(self._first, method)
        result = answer(module, method, call, args, self._unfinished, *about_bytes)
        if self._ended:  # by the time it was noted
            self.end()
        return result

    def end(self) -> None:
        """End what waits, as if it had been killed."""
        self._ended = True
        self._unfinished.kill_all()

    def _first(self, method: str, *args: Any) -> Any:
        with self._making:
            self.methods = self.methods or self._make()
        return self.methods[method](*args)


def typed(
    module: str, returns: Any, types: Sequence[Any], name: str | None = None
) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """For methods of a service that is no NAOqi module: as qi.bind, but arguments of other types are refused.

    `types` are those of the parameters after `self`; the `name` on the network is that of the function unless given.
    """

    def decorate(method: Callable[..., Any]) -> Callable[..., Any]:
        names = list(inspect.signature(method).parameters)[1:]
        called, letters = name or method.__name__, [str(kind) for kind in types]

        def checked(*args: Any) -> Any:
            return method(args[0], *fitted_to(names, letters, args[1:], module, called))

        @wraps(method)
        def published(*args: Any) -> Any:
            return answer(module, called, checked, args, vars(args[0]).setdefault("_unfinished", Unfinished()))

        return qi.bind(returns, types, name)(published)

    return decorate


def published_methods(module: str) -> dict[str, Method]:
    """Methods of a module by name, with those that it had before NAOqi 2.8."""
    return {**module_methods(module), **{name: older.method for name, older in older_methods(module).items()}}


def _functions(module: str) -> Mapping[str, Methods]:
    """What services publish for each of the `published_methods`: a function for every overload, by names in a class."""
    functions: dict[str, Methods] = {}
    for table in tables_of(module):
        for name, each in _functions_of(table).items():
            functions[name] = _published(module_methods(module)[name]) if name in functions else each
    return {**functions, **{name: _published(older.method) for name, older in older_methods(module).items()}}


@lru_cache(maxsize=None)
def _functions_of(table: str) -> Mapping[str, Methods]:
    """Those of a table; all services of modules that share it share them."""
    return {name: _published(method) for name, method in own_methods(table).items()}


def _published(method: Method) -> Methods:
    name = method.name
    if name == "pCall":
        return {name: _function(name, inspect.getdoc(CommonModule.pCall), qi.Dynamic, ANY_ARGUMENTS)}
    ways = [_function(name, method.summary, published_type(method.returns), way.signature) for way in method.overloads]
    return {name if i == 0 else f"{name}_{i}": way for i, way in enumerate(ways)}


def _function(name: str, summary: str | None, returns: Any, signature: str) -> Callable[..., Any]:
    def published(service: Any, *args: Any) -> Any:
        return service.__service__.answer(name, args)

    published.__doc__, published.__name__ = summary, name
    published = qi.bind(returns, methodName=name)(published)
    published.__qi_signature__ = signature
    return published


def offered(module: str, parts: Sequence[Any]) -> tuple[list[str], list[str]]:
    """Names of the table's methods that a service of these parts answers, and those it does not."""
    table = module_methods(module)
    answers = [n for n in table if n in NATIVE or _find(n, [*parts, CommonModule]) is not None]
    return answers, [n for n in table if n not in answers]


def _target(name: str, parts: Sequence[Any], common: CommonModule) -> Callable[..., Any] | None:
    """What answers a method: a part, or what all modules have; both, by the number of arguments, if it is of both."""
    own, shared = _find(name, parts), getattr(common, name, None)
    if own is None or shared is None:
        return own or shared
    count = len(inspect.signature(shared).parameters)
    return lambda *args: (shared if len(args) == count else own)(*args)


def _find(name: str, parts: Iterable[Any]) -> Callable[..., Any] | None:
    """The method `name` of the first part that has it."""
    return next((getattr(part, name) for part in parts if hasattr(part, name)), None)


def answer(
    module: str,
    method: str,
    call: Callable[..., Any],
    args: Iterable[Any],
    unfinished: Unfinished | None = None,
    with_bytes: WithBytes | None = None,
    bytes_later: bool = False,
) -> Any:
    """What libqi sends back for a call: a value, or a future for what takes simulated time.

    Errors go back as failed futures: raised through libqi they would carry a Python traceback in their text. The
    `unfinished` calls of the module, which may be too many, have each task that the client waits for. `with_bytes`
    makes the future of an answer with bytes, where the method may answer any value; `bytes_later`: that of a task has
    them.
    """
    args, label = tuple(args), f"{module}::{method}"
    try:
        check_sizes(args)
        if unfinished is not None:
            unfinished.require_room(method)
        result = call(*args)
        if with_bytes is not None and has_bytes(result):
            return with_bytes(result)
    except Exception as error:
        promise = qi.Promise()
        promise.setError(_text(label, error))
        return promise.future()
    if not isinstance(result, Task):
        return result
    if unfinished is not None:
        unfinished.note(result)
    return _as_future(result, label, with_bytes if bytes_later else None)


def _as_future(task: Task, label: str, with_bytes: WithBytes | None) -> Any:
    """A libqi future that ends with the task, or with the one that is its value; cancelling it kills the task."""
    cancelled = threading.Event()

    def cancel(_: Any) -> None:
        cancelled.set()
        task.request_kill()

    promise = qi.Promise(cancel)
    task.add_done_callback(partial(_settle, promise, cancelled, label, with_bytes))
    return promise.future() if with_bytes is None else promise.future().unwrap()


def _settle(promise: Any, cancelled: threading.Event, label: str, with_bytes: WithBytes | None, done: Task) -> None:
    # Not a closure that names itself: such a cycle would keep the promise until the next garbage collection, and a
    # promise with a value that is still there when the interpreter ends makes libqi abort the process.
    if done.error is not None:
        promise.setError(_text(label, done.error))
    elif isinstance(done.value, Task):
        done.value.add_done_callback(partial(_settle, promise, cancelled, label, with_bytes))
    elif done.killed and cancelled.is_set():
        promise.setCanceled()
    elif with_bytes is None:
        promise.setValue(done.value)
    else:
        try:
            promise.setValue(with_bytes(done.value))
        except RuntimeError as error:
            promise.setError(_text(label, error))


def _checked(module: str, method: Method, target: Callable[..., Any]) -> Callable[..., Any]:
    def checked(*args: Any) -> Any:
        return target(*fitted(method, args, module))

    return warning_once(module, method, checked)


def _text(label: str, error: Exception) -> str:
    if _on_purpose(error):
        return _shortened(f"{label} {error}")
    log.error("%s failed", label, exc_info=error)
    # What Python says about its own objects is of no use to a client.
    return f"{label} {DEFECT}"


def _on_purpose(error: Exception) -> bool:
    """Whether an error is one of ours, of libqi or of the system: its text is written for those who read it."""
    kind = type(error)
    return kind.__module__.startswith(PACKAGE) or kind is RuntimeError or isinstance(error, OSError)


def _shortened(text: str) -> str:
    half = LONGEST_ERROR // 2
    return text if len(text) <= LONGEST_ERROR else f"{text[:half]} ... {text[-half:]}"
