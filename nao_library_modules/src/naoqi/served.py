"""The face that a module shows to libqi: its public methods, and nothing that may harm libqi's threads."""

from __future__ import annotations

import inspect
import logging
from typing import Any, Callable, List, Sequence

import qi

from . import wire
from .worker import Worker

logger = logging.getLogger("naoqi")

EVENT_ARGUMENTS = 3
"""ALMemory calls a callback with the name of the event, its value, and the message of the subscription."""
NOT_SERVED = frozenset(
    """BIND_PYTHON exit getModule log logger onLoad onUnload session playTimeline stopTimeline gotoAndPlay gotoAndStop
    exitBehavior playTimelineParent stopTimelineParent gotoAndPlayParent gotoAndStopParent exitBehaviorParent
    getParentTimeline""".split()
)
"""Methods of ALModule and ALBehavior themselves that are for their own process; those of a subclass are served."""
DECLARED = {"processRemote": ["m", "m", "m", "r"]}
"""Methods that NAOqi calls with raw bytes (ALAudioDevice: channels, samples a channel, time, sound).

libqi 3.1.5 would turn bytes for a parameter of any type into the text of their repr.
"""


def public_methods(module: Any) -> List[str]:
    """Names of the methods that a module serves: the public ones of its class, but for `NOT_SERVED` of this package."""
    own = __name__.rpartition(".")[0]
    names = []
    for name in dir(type(module)):
        method = getattr(type(module), name)
        hidden = name.startswith("_") or inspect.isclass(method) or not callable(method)
        if not hidden and not (name in NOT_SERVED and getattr(method, "__module__", "").rpartition(".")[0] == own):
            names.append(name)
    return names


def served_object(module: Any, name: str, methods: Sequence[str], worker: Worker) -> Any:
    """An object for `qi.Session.registerService`.

    `module`: whose methods are called, looked up at each call. `worker`: calls them, one at a time and in order.
    """
    namespace = {each: _served_method(module, name, each, worker) for each in methods}
    namespace["__doc__"] = inspect.getdoc(module)
    return type("Served", (), namespace)()


def _served_method(module: Any, module_name: str, name: str, worker: Worker) -> Callable[..., Any]:
    method = getattr(module, name)
    lowest, highest = _argument_counts(method)
    fixed = lowest == highest >= EVENT_ARGUMENTS  # then libqi itself can check the arguments of a call

    def serve(_served: Any, *arguments: Any) -> Any:
        promise = qi.Promise()

        def run() -> None:
            try:
                given = _fitting(arguments, lowest, highest)
                answer = getattr(module, name)(*map(wire.from_wire, given))
                promise.setValue(wire.to_wire((answer,), lambda: False)[0])
            except BaseException as error:  # sys.exit() in a callback must reach whoever called it as well
                logger.error("%s.%s%r failed", module_name, name, arguments, exc_info=True)
                promise.setError(f"{type(error).__name__}: {error}")

        if not worker.submit(run):
            promise.setError(f"module {module_name} has exited")
        return promise.future()

    serve.__name__ = name
    serve.__doc__ = inspect.getdoc(method) or ""
    parameters = DECLARED.get(name) or (["m"] * lowest if fixed else qi.AnyArguments)
    return qi.bind("m", parameters)(serve)


def _argument_counts(method: Callable[..., Any]) -> Sequence[int]:
    """Fewest and most positional arguments that a method takes."""
    lowest, highest = 0, 0
    for parameter in inspect.signature(method).parameters.values():
        if parameter.kind is parameter.VAR_POSITIONAL:
            highest = 1000
        elif parameter.kind in (parameter.POSITIONAL_ONLY, parameter.POSITIONAL_OR_KEYWORD):
            highest += 1
            lowest += parameter.default is parameter.empty
    return lowest, highest


def _fitting(arguments: Sequence[Any], lowest: int, highest: int) -> Sequence[Any]:
    """The arguments, without those of an event that the method does not want to know.

    Raises TypeError if they do not fit.
    """
    given = len(arguments)
    if given == EVENT_ARGUMENTS > highest:
        return arguments[:highest]
    if not lowest <= given <= highest:
        wanted = str(lowest) if lowest == highest else f"{lowest} to {highest}"
        raise TypeError(f"takes {wanted} arguments, {given} given")
    return arguments
