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
from functools import partial, wraps
from typing import Any, Callable, Iterable, Sequence

import qi

from nao_sim_bridge.services.api import Method, Overload, module_methods, qi_type
from nao_sim_bridge.services.common import CommonModule
from nao_sim_bridge.services.wire_types import fitted, fitted_to
from nao_sim_bridge.sim.tasks import Task

log = logging.getLogger("nao_sim.services")

# Every libqi object has these by itself.
NATIVE = frozenset({"isStatsEnabled", "clearStats", "isTraceEnabled"})
# Characters of an error text; what is between its ends is left out when somebody sent a book as a name.
LONGEST_ERROR = 1200
# The answer where something else was raised than what is raised on purpose.
DEFECT = "a defect of the simulator, whose log tells more"
PACKAGE = __name__.partition(".")[0]


def make_service(module: str, parts: Sequence[Any], broker: Any) -> Any:
    """The object to register under the name `module`.

    Args:
        module: NAOqi name, a key of the API table.
        parts: Objects whose methods do the work; those with the names of the table are published. One with an attribute
            `signals` publishes these libqi signals, by name.
        broker: What the methods that every module has need to know: its `name` and `unregister(module)`.
    """
    table = module_methods(module)
    common = CommonModule(module, table, broker)
    body: dict[str, Any] = {}
    for name, method in table.items():
        if name in NATIVE:
            continue
        target = _find(name, [*parts, common])
        if target is None:
            continue
        target = common.targets[name] = _checked(method, target)
        for position, overload in enumerate(method.overloads):
            attribute = name if position == 0 else f"{name}_{position}"
            body[attribute] = _bound(module, method, overload, target)
    body["pCall"] = _bound_any(module, "pCall", common.pCall)
    service = type(module, (), body)()
    for part in parts:
        for name, signal in getattr(part, "signals", {}).items():
            setattr(service, name, signal)
    return service


def typed(module: str, returns: Any, types: Sequence[Any]) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """For methods of a service that is no NAOqi module: as qi.bind, but arguments of other types are refused.

    Args:
        module: Name of the service.
        returns: Type of the answer, as for qi.bind.
        types: Types of the parameters after `self`, as for qi.bind.
    """

    def decorate(method: Callable[..., Any]) -> Callable[..., Any]:
        names = list(inspect.signature(method).parameters)[1:]

        def checked(*args: Any) -> Any:
            return method(args[0], *fitted_to(names, [str(kind) for kind in types], args[1:]))

        @wraps(method)
        def published(*args: Any) -> Any:
            return answer(module, method.__name__, checked, args)

        return qi.bind(returns, types)(published)

    return decorate


def offered(module: str, parts: Sequence[Any]) -> tuple[list[str], list[str]]:
    """Names of the table's methods that a service of these parts answers, and those it does not."""
    table = module_methods(module)
    answers = [n for n in table if n in NATIVE or _find(n, [*parts, CommonModule]) is not None]
    return answers, [n for n in table if n not in answers]


def _find(name: str, parts: Iterable[Any]) -> Callable[..., Any] | None:
    """The method `name` of the first part that has it."""
    return next((getattr(part, name) for part in parts if hasattr(part, name)), None)


def answer(module: str, method: str, call: Callable[..., Any], args: Iterable[Any]) -> Any:
    """What libqi sends back for a call: a value, or a future for what takes simulated time.

    Errors go back as failed futures: raised through libqi they would carry a Python traceback in their text.
    """
    try:
        result = call(*args)
    except Exception as error:
        return _failed(_text(f"{module}::{method}", error))
    if isinstance(result, Task):
        return as_future(result, f"{module}::{method}")
    return result


def as_future(task: Task, label: str) -> Any:
    """A libqi future that ends with the task; cancelling it kills the task.

    Args:
        task: A command of the simulation thread, whose value may be a further task that takes simulated time, or such
            a task itself.
        label: "Module::method", for error texts.
    """
    cancelled = threading.Event()

    def cancel(_: Any) -> None:
        cancelled.set()
        task.request_kill()

    promise = qi.Promise(cancel)
    task.add_done_callback(partial(_settle, promise, cancelled, label))
    return promise.future()


def _settle(promise: Any, cancelled: threading.Event, label: str, done: Task) -> None:
    # Not a closure that names itself: such a cycle would keep the promise until the next garbage collection, and a
    # promise with a value that is still there when the interpreter ends makes libqi abort the process.
    if done.error is not None:
        promise.setError(_text(label, done.error))
    elif isinstance(done.value, Task):
        done.value.add_done_callback(partial(_settle, promise, cancelled, label))
    elif done.killed and cancelled.is_set():
        promise.setCanceled()
    else:
        promise.setValue(done.value)


def _bound(module: str, method: Method, overload: Overload, target: Callable[..., Any]) -> Callable[..., Any]:
    name = method.name

    def published(self: Any, *args: Any) -> Any:
        return answer(module, name, target, args)

    published.__doc__ = method.summary
    published.__name__ = name
    bind = qi.bind(qi_type(method.returns), None, name)
    bind(published)
    published.__qi_signature__ = overload.signature
    return published


def _checked(method: Method, target: Callable[..., Any]) -> Callable[..., Any]:
    def checked(*args: Any) -> Any:
        return target(*fitted(method, args))

    return checked


def _bound_any(module: str, name: str, target: Callable[..., Any]) -> Callable[..., Any]:
    def published(self: Any, *args: Any) -> Any:
        return answer(module, name, target, args)

    published.__doc__ = inspect.getdoc(target)
    return qi.bind(qi.Dynamic, qi.AnyArguments, name)(published)


def _failed(text: str) -> Any:
    promise = qi.Promise()
    promise.setError(text)
    return promise.future()


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
