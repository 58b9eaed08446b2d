"""NAOqi for Python 3: the interface of the robot maker's SDK over libqi, for a robot or the simulator.

    from naoqi import ALProxy

    speech = ALProxy("ALTextToSpeech", "nao.local", 9559)
    speech.say("Hello")

Beyond the SDK: asynchronous calls (`proxy.call_async`), time limits, automatic reconnection (`naoqi.connection`),
and typed errors that name the remedy (`naoqi.errors`).
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from .errors import (
    BadArguments,
    BrokerError,
    CallCanceled,
    CallTimeout,
    ConnectionLost,
    NaoError,
    RobotError,
    RobotUnreachable,
    UnknownMethod,
    UnknownModule,
)

if TYPE_CHECKING:
    from .broker import ALBroker
    from .calls import Call
    from .limits import Timing
    from .module import ALBehavior, ALDocable, ALModule, createModule
    from .proxy import ALProxy
    from .robot_connection import Connection, close_all, connection
    from .state import State

__all__ = [
    "ALBehavior",
    "ALBroker",
    "ALDocable",
    "ALModule",
    "ALProxy",
    "BadArguments",
    "BrokerError",
    "Call",
    "CallCanceled",
    "CallTimeout",
    "Connection",
    "ConnectionLost",
    "NaoError",
    "RobotError",
    "RobotUnreachable",
    "State",
    "Timing",
    "UnknownMethod",
    "UnknownModule",
    "close_all",
    "connection",
    "createModule",
    "motion",
]

_HOMES = {
    "ALBehavior": "module",
    "ALBroker": "broker",
    "ALDocable": "module",
    "ALModule": "module",
    "ALProxy": "proxy",
    "Call": "calls",
    "Connection": "robot_connection",
    "State": "state",
    "Timing": "limits",
    "close_all": "robot_connection",
    "connection": "robot_connection",
    "createModule": "module",
}
"""What is loaded when it is first asked for: programs that know the errors alone need no libqi."""


def __getattr__(name: str) -> Any:
    if name == "motion":  # which programs of the SDK import from here
        return import_module(name)
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f".{_HOMES[name]}", __name__), name)
