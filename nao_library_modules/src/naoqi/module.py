"""ALModule: a module of this process that the robot can call."""

from __future__ import annotations

import logging
from typing import Any, List
from weakref import WeakValueDictionary

from .broker import ALBroker, current_broker
from .errors import BrokerError, UnknownMethod
from .served import public_methods, served_object
from .translate import closest_names
from .worker import Worker

logger = logging.getLogger("naoqi")

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
        self.__worker = Worker(f"naoqi module {name}")
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
