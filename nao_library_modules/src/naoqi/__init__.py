"""NAOqi for Python 3: the interface of the robot maker's SDK over libqi, for a robot or the simulator.

    from naoqi import ALProxy

    speech = ALProxy("ALTextToSpeech", "nao.local", 9559)
    speech.say("Hello")

Beyond the SDK: asynchronous calls (`proxy.call_async`), time limits, automatic reconnection (`naoqi.connection`),
and typed errors that name the remedy (`naoqi.errors`).
"""

from __future__ import annotations

import motion

from .broker import ALBroker
from .calls import Call
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
from .module import ALModule
from .proxy import ALProxy
from .registry import close_all, connection
from .robot_connection import Connection
from .state import State, Timing

__all__ = [
    "ALBroker",
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
    "motion",
]
