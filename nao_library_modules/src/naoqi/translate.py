"""Between Python's values and errors and those of libqi. Nothing else in the stack looks at libqi's texts.

Values: libqi's Python binding refuses NumPy values, and turns an unknown object into a remote one silently; so
everything that is not plain is converted here or refused by name. What arrives as raw data becomes `bytes`.

Errors: libqi (3.1.5) raises `RuntimeError` for everything, so its text decides, most specific first. The texts of a
service written in Python open with the class name and close with a trace; those of a robot's own do neither.
"""

from __future__ import annotations

import difflib
import enum
import re
from collections.abc import Iterator, Mapping, MappingView, Set
from dataclasses import dataclass
from typing import Any, Callable, List, Sequence, Tuple

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

PLAIN = frozenset((bool, int, float, str, type(None)))
LOWEST_INTEGER, HIGHEST_INTEGER = -(2**63), 2**63 - 1
PYTHON2_LISTS = (range, Iterator, MappingView, Set)
"""`range()`, `map()`, `d.keys()` and others were lists when the SDK was current; ported scripts pass them."""
_CONTAINERS = frozenset((list, tuple, dict, bytearray))


class UnsendableError(Exception):
    """A value that libqi cannot carry; its text says which and why. Never leaves the proxy layer."""


def to_wire(arguments: Tuple[Any, ...], takes_raw: Callable[[], bool]) -> Tuple[Any, ...]:
    """Arguments of a call as libqi takes them.

    `arguments`: what the caller gave. `takes_raw`: asked only when there are bytes: does the method declare raw data?
    Returns the same tuple if all was plain, else a converted one. Raises UnsendableError if an argument cannot travel.
    """
    for argument in arguments:
        if type(argument) not in PLAIN:
            return tuple(_outwards(each, takes_raw) for each in arguments)
    return arguments


def from_wire(value: Any) -> Any:
    """A value that came from the robot, with raw data as `bytes` at every depth."""
    kind = type(value)
    if kind not in _CONTAINERS:
        return value
    if kind is bytearray:
        return bytes(value)
    if kind is dict:
        if _CONTAINERS.isdisjoint(map(type, value.values())):
            return value
        return {key: from_wire(each) for key, each in value.items()}
    if _CONTAINERS.isdisjoint(map(type, value)):
        return value
    return kind(map(from_wire, value))


def check_sendable(value: Any) -> None:
    """Look for what libqi itself refuses inside plain values; too slow for every call, so after a failure.

    Raises UnsendableError if there is an integer beyond 64 bits or a text that is no Unicode.
    """
    if isinstance(value, int) and not LOWEST_INTEGER <= value <= HIGHEST_INTEGER:
        raise UnsendableError(f"{value} does not fit into 64 bits")
    if isinstance(value, str):
        try:
            value.encode("utf-8")
        except UnicodeEncodeError:
            raise UnsendableError(f"{value!r} holds characters that are not Unicode") from None
    elif isinstance(value, dict):
        for pair in value.items():
            check_sendable(pair)
    elif isinstance(value, (list, tuple)):
        for each in value:
            check_sendable(each)


def _outwards(value: Any, takes_raw: Callable[[], bool]) -> Any:
    if type(value) in PLAIN:
        return value
    if isinstance(value, (list, tuple)):
        if PLAIN.issuperset(map(type, value)):
            return value if type(value) in _CONTAINERS else tuple(value)
        return [_outwards(each, takes_raw) for each in value]
    if isinstance(value, (bytes, bytearray, memoryview)):
        return _raw_outwards(bytes(value), takes_raw)
    if isinstance(value, enum.Enum):
        return _outwards(value.value, takes_raw)
    if hasattr(value, "tolist"):  # NumPy scalars and arrays, without importing NumPy
        return _outwards(value.tolist(), takes_raw)
    for base in (int, float, str):
        if isinstance(value, base):
            return base(value)
    if isinstance(value, Mapping):
        return {_outwards(key, takes_raw): _outwards(each, takes_raw) for key, each in value.items()}
    if isinstance(value, PYTHON2_LISTS):
        return [_outwards(each, takes_raw) for each in value]
    if callable(value) or type(value).__module__.split(".")[0] == "qi":
        return value  # functions, and objects of libqi itself, travel as remote objects
    raise UnsendableError(f"a value of type {type(value).__name__} cannot be sent: {value!r}")


def _raw_outwards(value: bytes, takes_raw: Callable[[], bool]) -> Any:
    if takes_raw():
        return value
    try:
        return value.decode("utf-8")
    except UnicodeDecodeError:
        # libqi 3.1.5 would send the text of their repr instead, without an error.
        raise UnsendableError(
            f"{len(value)} raw bytes can only be sent to a method that declares raw data, or as UTF-8 text"
        ) from None


WORDS = {
    "v": "nothing",
    "b": "bool",
    "c": "int8",
    "C": "uint8",
    "w": "int16",
    "W": "uint16",
    "i": "int",
    "I": "uint",
    "l": "int64",
    "L": "uint64",
    "f": "float",
    "d": "double",
    "s": "string",
    "m": "any value",
    "o": "object",
    "r": "raw bytes",
    "X": "unknown",
}
PREFIXES = {"#": "any number of", "~": "named", "+": "optional"}
CLOSING = {"(": ")", "[": "]", "{": "}"}
ANY_ARGUMENTS = "m"
"""As parameters of a method, without brackets: it looks at the arguments itself."""


def readable_type(signature: str) -> str:
    """Words for one type.

    `signature`: a libqi signature such as `[(sf)]`. Returns its meaning, such as `list of (string, float)`; the
    signature itself where it is not understood.
    """
    try:
        text, rest = _read_type(signature)
    except (IndexError, KeyError):
        return signature
    return signature if rest else text


def readable_call(method: str, parameters: str) -> str:
    """Words for a method with its parameters.

    `method`: name of the method. `parameters`: its parameters as libqi writes them, such as `(sf)`. Returns text such
    as `setIntensity(string, float)`.
    """
    try:
        return f"{method}({', '.join(readable_parameters(parameters))})"
    except (IndexError, KeyError):
        return f"{method}{parameters}"


def readable_parameters(parameters: str) -> List[str]:
    """Words for each parameter of a method; `...` stands for any number of any values."""
    if parameters == ANY_ARGUMENTS:
        return ["..."]
    words, rest = [], parameters[1:-1]
    while rest:
        text, rest = _read_type(rest)
        words.append(text)
    return words


def mentions_raw(signature: str) -> bool:
    """Whether a signature holds raw bytes; struct and field names between < and > do not count."""
    depth = 0
    for letter in signature:
        depth += (letter == "<") - (letter == ">")
        if letter == "r" and depth == 0:
            return True
    return False


def _read_type(signature: str) -> Tuple[str, str]:
    """Read one type off the front; return its words and what is left of the signature."""
    letter, rest = signature[0], signature[1:]
    if letter in PREFIXES:
        text, rest = _read_type(rest)
        return f"{PREFIXES[letter]} {text}", rest
    if letter not in CLOSING:
        return WORDS[letter], rest
    members = []
    while rest[0] != CLOSING[letter]:
        text, rest = _read_type(rest)
        members.append(text)
    rest = _skip_annotation(rest[1:])
    if letter == "(":
        return f"({', '.join(members)})", rest
    if letter == "[":
        return f"list of {members[0]}", rest
    return f"map of {members[0]} to {members[1]}", rest


def _skip_annotation(signature: str) -> str:
    """Drop the names a struct carries: `<Name,field,field>`."""
    if not signature.startswith("<"):
        return signature
    depth = 0
    for index, letter in enumerate(signature):
        depth += (letter == "<") - (letter == ">")
        if depth == 0:
            return signature[index + 1 :]
    raise IndexError(signature)


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
    ("disconnected", ("closed by the robot", "that NAOqi (or the simulator) runs there")),
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
        check_sendable(arguments)
    except UnsendableError as error:
        return str(error)
    return ""
