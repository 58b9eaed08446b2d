"""From what libqi raises to our errors. Nothing else in the stack looks at libqi's texts.

libqi (3.1.5) raises `RuntimeError` for everything, so its text decides, most specific first. The texts of a
service written in Python open with the class name and close with a trace; those of a robot's own do neither.
"""

from __future__ import annotations

import difflib
import re
from dataclasses import dataclass
from typing import Any, Callable, List, Sequence, Tuple

from . import wire
from .errors import (
    BadArguments,
    CallCanceled,
    ConnectionLost,
    NaoError,
    RobotError,
    RobotUnreachable,
    UnknownMethod,
    UnknownModule,
)
from .signatures import readable_call

NOT_SENT = ("Socket is not connected", "Session not connected.", "The call request could not be handled.")
"""The method has not been called: there is no connection, or nothing behind the address of the module."""
BROKEN_UNDER_WAY = ("Session closed", "Session disconnected", "Socket Disconnected", "Service removed")
CANCELED = ("Future canceled.", "Call has been canceled.")
PYTHON_SERVICE = re.compile(r"(?P<kind>[A-Za-z_][\w.]*)(?:: (?P<text>.*?))?\n+(?P<trace>At:\n.*)\Z", re.DOTALL)
CONVERSION_FAILED = re.compile(r"Call argument number \d+ (conversion failure from .* to [^.]*)")

Reason = Tuple[str, str]
"""What went wrong with a connection, and what to check."""

CONNECT_REASONS: Sequence[Tuple[str, Reason]] = (
    ("refused", ("connection refused", "that NAOqi (or the simulator) runs there and listens on this port")),
    ("not found", ("the name of the host is not known", "the spelling, or use the IP address of the robot")),
    ("unreachable", ("no route to the host", "that robot and computer are on the same network")),
    ("no route", ("no route to the host", "that robot and computer are on the same network")),
    ("timed out", ("no answer", "that the robot is on, and its address")),
)


@dataclass(frozen=True)
class CallSite:
    """What is known about a call that failed."""

    host: str  # name or address of the robot
    port: int  # TCP port of NAOqi
    module: str  # name of the module
    method: str  # name of the method
    arguments: Tuple[Any, ...]  # as they were sent
    overloads: Callable[[], List[str]]  # asked only when needed: the signatures of the method, in words
    methods: Callable[[], List[str]]  # asked only when needed: names of the methods of the module
    lost: str  # why the connection is lost; empty while it is not known, or stands


def connect_reason(text: str) -> Reason:
    """Why no connection could be opened, and what to check, from libqi's text."""
    lowered = text.lower()
    for sign, reason in CONNECT_REASONS:
        if sign in lowered:
            return reason
    return text.strip(), "that the robot is on, its address, and that NAOqi listens on this port"


def call_error(raised: Exception, site: CallSite) -> NaoError:
    """The error of a call that failed.

    `raised`: what libqi raised. `site`: the call. Returns the error to raise, with `raised` as its cause.
    """
    text = str(raised).strip()
    if text in NOT_SENT:
        reason = f"{site.module}.{site.method} was not carried out: the module, or the connection, has just gone"
        return RobotUnreachable(site.host, site.port, reason)
    if text in BROKEN_UNDER_WAY:
        return ConnectionLost(site.host, site.port, site.lost or text.rstrip("."), f"{site.module}.{site.method}")
    if text in CANCELED:
        return CallCanceled(site.module, site.method)
    unsendable = _unsendable(site.arguments)
    if unsendable:
        return BadArguments(site.module, site.method, site.arguments, site.overloads(), unsendable)
    kind, text, trace = _taken_apart(text)
    if not kind or kind == "RuntimeError":
        refused = _refused(text, site)
        if refused is not None:
            return refused
    return RobotError(site.module, site.method, text, kind, trace)


def unknown_module(name: str, host: str, port: int, modules: Sequence[str]) -> UnknownModule:
    """The error for a module that is not there, with the names that come closest."""
    shown = sorted(each for each in modules if not each.startswith("_"))
    return UnknownModule(name, f"{host}:{port}", closest_names(name, shown), shown)


def unknown_method(module: str, name: str, methods: Sequence[str]) -> UnknownMethod:
    """The error for a method that is not there, with the names that come closest."""
    shown = sorted(each for each in methods if not each.startswith("_"))
    return UnknownMethod(module, name, closest_names(name, shown), shown)


def closest_names(name: str, known: Sequence[str]) -> List[str]:
    """Up to three known names that look like this one, best first; upper and lower case count as alike."""
    by_lowered = {each.lower(): each for each in known}
    found = difflib.get_close_matches(name.lower(), by_lowered, n=3, cutoff=0.6)
    return [by_lowered[each] for each in found]


def is_unknown_service(text: str) -> bool:
    """Whether libqi says that it knows no service of the name it was asked for."""
    return text.startswith("Cannot find service")


def _refused(text: str, site: CallSite) -> NaoError | None:
    """The error if libqi found no method for the call, None if the method itself failed."""
    if text.startswith(f"Arguments types did not match for {site.method} "):
        candidates = re.findall(rf"^\s*{re.escape(site.method)}::(\S+) ", text, re.MULTILINE)
        words = [readable_call(site.method, each) for each in candidates] or site.overloads()
        return BadArguments(site.module, site.method, site.arguments, words)
    conversion = CONVERSION_FAILED.match(text)
    if conversion:
        return BadArguments(site.module, site.method, site.arguments, site.overloads(), conversion[1])
    if re.match(rf"Can't find method(?: or signal)?: {re.escape(site.method)}\b", text):
        return unknown_method(site.module, site.method, site.methods())
    return None


def _taken_apart(text: str) -> Tuple[str, str, str]:
    """Class name, text and trace of an error; class and trace are empty unless a Python service raised it."""
    match = PYTHON_SERVICE.match(text)
    if match is None:
        return "", text, ""
    return match["kind"], (match["text"] or "").strip(), match["trace"].strip()


def _unsendable(arguments: Tuple[Any, ...]) -> str:
    try:
        wire.check_sendable(arguments)
    except wire.UnsendableError as error:
        return str(error)
    return ""
