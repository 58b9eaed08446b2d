"""ALModule: a module of this process that the robot can call; ALBehavior: the base of scripts of Choregraphe boxes."""

from __future__ import annotations

import inspect
import logging
from typing import Any, Callable, Dict, List, Sequence
from weakref import WeakValueDictionary

import qi

from . import translate
from .broker import ALBroker, current_broker
from .errors import BrokerError, NaoError, UnknownMethod
from .state import Worker
from .translate import closest_names

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
                answer = getattr(module, name)(*map(translate.from_wire, given))
                promise.setValue(translate.to_wire((answer,), lambda: False)[0])
            except BaseException as error:  # sys.exit() in a callback must reach the caller as well
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


_modules: WeakValueDictionary[str, ALModule] = WeakValueDictionary()


class ALDocable:
    """Base class of what is served with its documentation, as in the SDK.

    All public methods of a module are served with their docstrings anyway; its constructor is there to be called.
    """

    def __init__(self, bindIfnoDocumented: bool = False) -> None:
        """Nothing is left to do: methods without a docstring are served, too."""


class ALModule(ALDocable):
    """Base class of modules: the public methods of a subclass are served under its name.

        class Buttons(ALModule):
            def on_touch(self, event, value, message):
                print(event, value)

        broker = ALBroker("broker", "0.0.0.0", 0, "nao.local", 9559)
        buttons = Buttons("Buttons")
        ALProxy("ALMemory").subscribeToEvent("FrontTactilTouched", "Buttons", "on_touch")

    All calls of one module run one after the other in a thread of the module: events keep their order, and a
    callback may block and call the robot. An event callback may take fewer than the three arguments. An exception
    in a callback is logged with its trace and returned to the caller as an error. A module must not wait for a
    call of itself through a proxy: that call would wait for the running one.
    """

    def __init__(self, name: str) -> None:
        """Register the module with the newest broker.

        Raises BrokerError if there is no broker, or if the name is taken; RobotUnreachable if there is no connection.
        """
        self.__name = name
        self.__broker: ALBroker = current_broker()
        self.__worker = Worker(f"naoqi module {name}", self.__broker.connection.presence)
        self.__methods: List[str] = public_methods(self)
        self.logger = logging.getLogger(name)
        self.__broker.serve(name, self.__served(), self.__worker)
        _modules[name] = self

    @classmethod
    def getModule(cls, name: str) -> ALModule:
        """The module of this process with a name; a BrokerError when there is none."""
        module = _modules.get(name)
        if module is None:
            known = ", ".join(sorted(_modules)) or "none"
            raise BrokerError("", f"module {name!r} does not exist in this process; there are: {known}")
        return module

    def getName(self) -> str:
        """Name of the module."""
        return self.__name

    def getBrokerName(self) -> str:
        """Name of the broker that serves it."""
        return self.__broker.getName()

    def ping(self) -> bool:
        """True, as proof that calls arrive."""
        return True

    def exit(self) -> None:
        """Unregister the module from the robot; it is not called any more."""
        self.__broker.withdraw(self.__name)

    def BIND_PYTHON(self, module_name: str, method: str, _parameters: int = -1) -> None:
        """Serve a method that is not served by default: one with a leading underscore, or one added later.

        A method that the module does not have is no error, as with the SDK, but a warning in the log: programs bind a
        `callback` that they never define.
        """
        if not callable(getattr(self, method, None)):
            known = [each for each in dir(self) if not each.startswith("__") and callable(getattr(self, each))]
            logger.warning("BIND_PYTHON: %s", UnknownMethod(module_name, method, closest_names(method, known), known))
            return
        if method not in self.__methods:
            self.__methods.append(method)
            self.__broker.exchange(self.__name, self.__served())

    def __served(self) -> Any:
        return served_object(self, self.__name, self.__methods, self.__worker)


def createModule(name: str) -> ALModule:
    """Make a module without methods of its own; its broker keeps it, as all modules, until it exits."""
    return ALModule(name)


class ALBehavior(ALModule):
    """Base class of the script of a box, served under its name as a module is.

        class MyClass(ALBehavior):
            def onInput_onStart(self):
                self.session().service("ALTextToSpeech").say(self.getParameter("Text"))
                self.onStopped()

    A box has its outputs, its parameters and its timeline from Choregraphe. Here a program calls the inputs itself,
    gives values by `setParameter`, and defines methods for the outputs that the script calls. Nothing calls
    `onLoad` and `onUnload`. What belongs to a box in a running behaviour raises a NaoError.
    """

    def __init__(self, name: str, autoBind: bool = True, brokerRegister: bool = True) -> None:
        """Register the box with the newest broker, as `ALModule`.

        All of its public methods are served, whatever `autoBind` and `brokerRegister` say.

        Raises:
            BrokerError: There is no broker, or the name is taken.
            RobotUnreachable: There is no connection.
        """
        self.__parameters: Dict[str, Any] = {}
        self.behaviorId = 0
        ALModule.__init__(self, name)

    def onLoad(self) -> None:
        """What the box does before it is begun; a subclass says what."""

    def onUnload(self) -> None:
        """What the box does when it is stopped; a subclass says what."""

    def getParameter(self, parameterName: str) -> Any:
        """Value of a parameter that `setParameter` has given; a NaoError when it has none."""
        if parameterName not in self.__parameters:
            known = ", ".join(sorted(self.__parameters)) or "none"
            text = f"box {self.getName()} has no parameter {parameterName!r}; set it by setParameter; known: {known}"
            raise NaoError(text)
        return self.__parameters[parameterName]

    def setParameter(self, parameterName: str, newValue: Any) -> None:
        self.__parameters[parameterName] = newValue

    def session(self) -> qi.Session:
        """The session of the broker: `self.session().service("ALMotion")`."""
        return current_broker().session()

    def log(self, text: Any) -> None:
        """Write into the log of the program; `self.logger` does so with levels."""
        self.logger.info("%s", text)

    def getParentTimeline(self) -> Any:
        """Not outside of a robot, as all that follows: raises a NaoError."""
        raise NaoError(
            f"box {self.getName()} is in no timeline: it runs in a program, outside of a behaviour of Choregraphe; "
            "ALBehaviorManager starts and stops behaviours, ALFrameManager plays timelines"
        )

    def playTimeline(self, *_: Any) -> Any:
        return self.getParentTimeline()

    stopTimeline = gotoAndPlay = gotoAndStop = exitBehavior = playTimeline
    playTimelineParent = stopTimelineParent = gotoAndPlayParent = gotoAndStopParent = exitBehaviorParent = playTimeline
