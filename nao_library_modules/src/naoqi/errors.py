"""The errors of the proxy layer: one family, which is also `RuntimeError` for scripts of the maker's SDK.

    RuntimeError
      NaoError                 root: catch this to catch all of them
        RobotUnreachable       no NAOqi at that address, or not yet again
          ConnectionLost       the call had been sent when the connection broke: it may have been carried out
        UnknownModule          the robot has no module (service) of that name
        UnknownMethod          the module has no method of that name (also an AttributeError)
        BadArguments           the arguments fit none of the method's signatures, or cannot be sent at all
        CallTimeout            no answer within the time limit of the call
        CallCanceled           the call was cancelled before it was finished
        RobotError             the method itself failed; the text is the robot's
        BrokerError            an ALBroker is missing, shut down, or cannot serve what it was given

Each subclass keeps the facts of its text as attributes.
"""

from __future__ import annotations

import re
from typing import Any, Sequence

LISTED_NAMES = 40
"""Most known names listed in a text; the attribute of the error always has all of them."""


class NaoError(RuntimeError):
    """Root of all errors that the proxy layer raises."""


class RobotUnreachable(NaoError):
    """There is no connection to NAOqi at this address, and the call was not sent.

    `check`: what to look at; may be empty.
    """

    def __init__(self, host: str, port: int, reason: str, check: str = "") -> None:
        super().__init__(f"NAOqi at {host}:{port}: {reason}" + (f". Check {check}." if check else "."))
        self.host = host
        self.port = port
        self.reason = reason
        self.check = check


class ConnectionLost(RobotUnreachable):
    """The connection broke during the call, `Module.method`; whether the robot carried it out is unknown."""

    def __init__(self, host: str, port: int, reason: str, call: str) -> None:
        super().__init__(host, port, f"{call} was under way when the connection broke ({reason})")
        self.call = call


class UnknownModule(NaoError):
    """The robot has no module of that name.

    `closest`: known names that look like it, best first. `modules`: all names the robot knows.
    """

    def __init__(self, module: str, address: str, closest: Sequence[str], modules: Sequence[str]) -> None:
        suggestion = _suggestion(closest, modules, "modules")
        super().__init__(f"NAOqi at {address} has no module {module!r}{suggestion}")
        self.module = module
        self.closest = list(closest)
        self.modules = list(modules)


class UnknownMethod(NaoError, AttributeError):
    """The module has no method of that name; `hasattr(proxy, name)` is False for it.

    `closest`: known names that look like it, best first. `methods`: all methods of the module.
    """

    def __init__(self, module: str, method: str, closest: Sequence[str], methods: Sequence[str]) -> None:
        super().__init__(f"{module} has no method {method!r}{_suggestion(closest, methods, 'methods')}")
        self.module = module
        self.method = method
        self.closest = list(closest)
        self.methods = list(methods)


class BadArguments(NaoError):
    """The arguments of a call do not fit.

    `signatures`: what the method accepts, in readable types, one text for each overload. `reason`: what does not fit;
    may be empty.
    """

    def __init__(
        self, module: str, method: str, given: Sequence[Any], signatures: Sequence[str] = (), reason: str = ""
    ) -> None:
        text = f"{module}.{method} cannot be called with ({', '.join(map(_shortened, given))})"
        if reason:
            text += f": {reason}"
        if signatures:
            text += "; allowed: " + " or ".join(signatures)
        super().__init__(text)
        self.module = module
        self.method = method
        self.given = tuple(given)
        self.signatures = list(signatures)
        self.reason = reason


class CallTimeout(NaoError):
    """A call got no answer within its time limit (s); the connection itself is alive."""

    def __init__(self, module: str, method: str, limit: float) -> None:
        super().__init__(f"{module}.{method} gave no answer within {limit:g} s")
        self.module = module
        self.method = method
        self.limit = limit


class CallCanceled(NaoError):
    """A call was cancelled, by this program or by the robot, before it was finished."""

    def __init__(self, module: str, method: str) -> None:
        super().__init__(f"{module}.{method} was cancelled")
        self.module = module
        self.method = method


class RobotError(NaoError):
    """The method failed on the robot.

    Attributes:
        text: The robot's message.
        kind: Name of the exception class if a service written in Python raised it, else empty.
        trace: Where that service raised it, else empty.
    """

    def __init__(self, module: str, method: str, text: str, kind: str = "", trace: str = "") -> None:
        """The message often begins with the method; the composed text names the method once."""
        reason = re.sub(rf"\A\s*{re.escape(module)}(::|\.){re.escape(method)}\b[\s:]*", "", text)
        super().__init__(f"{module}.{method} failed: {reason or kind or 'the robot gave no reason'}")
        self.module = module
        self.method = method
        self.text = text
        self.kind = kind
        self.trace = trace


class BrokerError(NaoError):
    """An ALBroker is missing (then its name is empty), has been shut down, or cannot serve what it was given."""

    def __init__(self, broker: str, reason: str) -> None:
        super().__init__(f"broker {broker!r}: {reason}" if broker else reason)
        self.broker = broker
        self.reason = reason


def _suggestion(closest: Sequence[str], known: Sequence[str], what: str) -> str:
    if closest:
        return f": did you mean {' or '.join(map(repr, closest))}?"
    if len(known) <= LISTED_NAMES:
        return f"; its {what} are: {', '.join(known)}"
    return f" and nothing like it among its {len(known)} {what}"


def _shortened(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."
