"""The servers that steps may use: their functions, messages, and what can be checked of a goal without a robot.

Messages are made of the fields of a file, and back, by the types that genpy knows of each field.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from types import MethodType
from typing import TYPE_CHECKING, Any, Optional

import genpy
import roslib.message

from naoqi.errors import NaoError

from ..core.chain import COMMON, FunctionChain, FunctionTable, fields_taken
from ..core.errors import BadGoal, FunctionFailed, UnknownFunction, did_you_mean, field_hint
from ..core.geometry import ANGLES, in_rad, is_in_degrees
from ..core.goal_checks import GoalCheck, GoalProblem, check_goals, offline_module
from ..core.memory_functions import MemoryFunctions
from ..core.server_types import ACTIONS, ServerType, described_type, server_type
from .parameters import text_of

if TYPE_CHECKING:
    from nao_library_msgs.srv import DescribeFunctionsResponse


_ARRAY = re.compile(r"(?P<item>.+)\[(?P<length>\d*)\]")
_RANGES = {f"{sign}int{bits}": bits for sign in ("", "u") for bits in (8, 16, 32, 64)}
_RANGES.update(byte=8, char=8)
_FLOATS = {"float32": 3.4028235e38, "float64": math.inf}
NANOSECONDS = 1_000_000_000


def message_of(message_type: type, fields: Any, where: str = "", taken: Sequence[str] = ()) -> Any:
    """A message with some fields filled; the others have their defaults.

    Raises BadGoal if a field is unknown, or its value is of the wrong kind.

    Args:
        fields: Name -> plain value; times and durations in s.
        where: What errors put before the names of fields.
        taken: Fields that make sense here, where not all do: errors name these.
    """
    if not isinstance(fields, dict):
        raise BadGoal(where or message_type.__name__, fields, f"a mapping with {', '.join(message_type.__slots__)}")
    message = message_type()
    types = dict(zip(message_type.__slots__, message_type._slot_types))
    prefix = f"{where}." if where else ""
    for name, value in fields.items():
        if name not in types:
            known = [*taken] or [*types]
            hint = field_hint(str(name), known)
            problem = f"{message_type.__name__} has no field {name!r}{hint}"
            raise BadGoal(f"{prefix}{name}", value, f"there are {', '.join(known)}", problem=problem)
        setattr(message, name, _value(types[name], _in_rad(value) if name in ANGLES else value, f"{prefix}{name}"))
    return message


def _in_rad(value: Any) -> Any:
    """Angles in rad; what is no angle in degrees as it is."""
    if isinstance(value, list):
        return [_in_rad(each) for each in value]
    try:
        return in_rad(value) if is_in_degrees(value) else value
    except ValueError:
        return value


def fields_of(message: Any) -> dict[str, Any]:
    """Fields of a message that differ from their defaults: `message_of` makes the same message of them."""
    default = type(message)()
    return {
        name: _plain(kind, getattr(message, name))
        for name, kind in zip(message.__slots__, message._slot_types)
        if not _same(getattr(message, name), getattr(default, name))
    }


def _value(kind: str, value: Any, where: str) -> Any:
    array = _ARRAY.fullmatch(kind)
    if array:
        return _list(array["item"], array["length"], value, where)
    if kind in ("time", "duration"):
        return _time(genpy.Time if kind == "time" else genpy.Duration, value, where)
    if kind == "bool":
        if not isinstance(value, bool):
            raise BadGoal(where, value, "true or false")
        return value
    if kind == "string":
        if isinstance(value, bool) or not isinstance(value, (str, int, float)):
            raise BadGoal(where, value, "a text, in quotes", problem=f"{text_of(value)[:200]!r} is no text")
        return text_of(value)
    if kind in _RANGES:
        return _integer(kind, value, where)
    if kind in _FLOATS:
        return _float(kind, value, where)
    message_type = roslib.message.get_message_class(kind)
    if message_type is None:
        raise BadGoal(where, value, "fields whose messages are built", problem=f"the message {kind} is not known")
    return message_of(message_type, value, where)


def _list(kind: str, length: str, value: Any, where: str) -> Any:
    if not isinstance(value, list):
        example = text_of(value) if isinstance(value, (str, int, float)) else "..."
        raise BadGoal(where, value, f"a list: [{example}]")
    if length and len(value) != int(length):
        raise BadGoal(where, value, f"{length} values", problem=f"it has {len(value)} values")
    items = [_value(kind, each, f"{where}[{i}]") for i, each in enumerate(value)]
    return bytes(items) if kind in ("uint8", "char") else items


def _integer(kind: str, value: Any, where: str) -> int:
    unsigned = kind.startswith("u") or kind == "char"
    bits = _RANGES[kind]
    lowest, highest = (0, 2**bits - 1) if unsigned else (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1)
    whole = isinstance(value, int) or (isinstance(value, float) and value.is_integer())
    if isinstance(value, bool) or not whole or not lowest <= value <= highest:
        raise BadGoal(where, value, f"a whole number {lowest}..{highest}")
    return int(value)


def _float(kind: str, value: Any, where: str) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise BadGoal(where, value, "a number")
    # Integers of YAML may have any length.
    if abs(value) > 1e308 or not math.isfinite(value) or abs(value) > _FLOATS[kind]:
        raise BadGoal(where, value, "a finite number")
    return float(value)


def _time(kind: type, value: Any, where: str) -> Any:
    number = _float("float64", value, where)
    if not -(2**31) <= number < 2**31 or (kind is genpy.Time and number < 0.0):
        raise BadGoal(where, value, "s, less than 2147483648")
    # from_sec cuts digits off instead of rounding them.
    seconds, nanoseconds = divmod(round(number * NANOSECONDS), NANOSECONDS)
    return kind(seconds, nanoseconds)


def _plain(kind: str, value: Any) -> Any:
    array = _ARRAY.fullmatch(kind)
    if array:
        return [_plain(array["item"], each) for each in value]
    if kind in ("time", "duration"):
        return value.to_sec()
    if isinstance(value, genpy.Message):
        return fields_of(value)
    if kind == "bool":
        return bool(value)
    return value


def _same(a: Any, b: Any) -> bool:
    """Whether two values are equal; lists and tuples are, when what is in them is."""
    if isinstance(a, (list, tuple)) and isinstance(b, (list, tuple)):
        return len(a) == len(b) and all(map(_same, a, b))
    return bool(a == b)


# --- servers ----------------------------------------------------------------------------------------------------------

OWN = "NaoBehavior"
NAMES = tuple(name for name in ACTIONS if name != OWN)
"""Servers of this package that steps may use."""

Describe = Callable[[str, Optional[Sequence[str]]], "DescribeFunctionsResponse"]
"""Has a server describe functions, by their names, all of them (no names) or none (None: only itself); raises
NotDescribed if no server of that name runs."""


class NotDescribed(NaoError):
    """A server did not tell what its functions are."""


Running = Callable[[], Iterable[str]]
"""Names of the servers that run."""


def nobody_describes(_server: str, _functions: Sequence[str] | None) -> DescribeFunctionsResponse:
    raise NotDescribed("no server was asked")


class FunctionTables:
    """What the servers can do: functions, and checks that need no robot.

    Functions of the servers of this package are read from their classes, each when it is asked for the first time. A
    server of another name, and a function that one of these does not have, is asked of the server that runs. Any thread
    may ask; two that come at the same time do the same work. `describe`: has a server that runs describe its functions.
    """

    def __init__(self, describe: Describe = nobody_describes, running: Running = tuple) -> None:
        self._describe = describe
        self._running = running
        self._modules: dict[str, Any] = {}
        self._chains: dict[str, FunctionChain] = {}
        self._others: dict[str, ServerType] = {}

    def server(self, name: str, field: str = "step") -> ServerType:
        """The types of a server that steps may use.

        `name`: its relative name. `field`: what names it, for the error. Raises BadGoal if there is none of that name.
        """
        if name in NAMES:
            return server_type(name)
        if name == OWN:
            problem = "a behavior that sends goals to NaoBehavior would end itself: use 'behavior: NAME'"
            raise BadGoal(field, name, f"the servers are {', '.join(NAMES)}", problem)
        if name not in self._others:
            try:
                self._others[name] = described_type(name, self._describe(name, None))
            except NotDescribed:
                names = list(dict.fromkeys([*NAMES, *(each for each in self._running() if each != OWN)]))
                problem = f"there is no server {name!r}{did_you_mean(name, names)}"
                raise BadGoal(field, name, f"the servers are {', '.join(names)}", problem) from None
        return self._others[name]

    def fields(self, server: ServerType, function: str) -> list[str]:
        """Fields that a function of a server takes, with those that all functions have; empty: there is none such."""
        known = self._chain(server).table if server.ours else {}
        if function in known:
            taken = fields_taken(known[function], server.function.__slots__)
        else:
            described = self._described(server, [function])
            if not described:
                return []
            taken = [argument.name for argument in described[function].arguments]
        return [*taken, *(name for name in COMMON if name in server.function.__slots__)]

    def check(self, server: ServerType, messages: Sequence[Any]) -> tuple[list[FunctionFailed], list[int]]:
        """Check a goal as far as that is possible without any robot and without what goals before it have done.

        Returns:
            What is wrong with it, whichever robot it is for; and the places, counted from 1, of the functions whose
            checks only the server can finish.
        """
        if server.ours:
            failures = self._chain(server).failures(messages)
        else:
            # Nothing of it is known here: all its functions are asked of the server that runs.
            names = [message.function for message in messages]
            failures = [FunctionFailed(i, name, UnknownFunction(name, [])) for i, name in enumerate(names, start=1)]
        failures = [self._checked_there(server, failed) for failed in failures]
        unfinished = [failed.position for failed in failures if isinstance(failed.cause, _AtTheServer)]
        return [failed for failed in failures if failed.position not in unfinished], unfinished

    def unusual(self, server: ServerType, messages: Sequence[Any]) -> list[FunctionFailed]:
        """Functions of a goal whose numbers are allowed and not usual, as far as they are known here."""
        return self._chain(server).unusual(messages) if server.ours else []

    def check_goals(self, name: str, goals: Sequence[Any]) -> GoalCheck:
        """Check goals as their server would for a robot that is as all of its family are.

        `goals`: in the order in which they would be sent.
        """
        server = self.server(name)
        if not server.ours:
            unchecked = [
                GoalProblem(number, index, message.function, "", "only its server can check it")
                for number, goal in enumerate(goals)
                for index, message in enumerate(getattr(goal, goal.__slots__[0]))
            ]
            return GoalCheck((), unchecked)
        found = check_goals(self._module(server), goals, elsewhere=True)
        unknown = {each.function for each in found.problems} - set(self._chain(server).table)
        there = self._described(server, sorted(unknown)) if unknown else {}
        return GoalCheck(
            [each for each in found.problems if each.function not in there],
            [*found.unchecked, *(each for each in found.problems if each.function in there)],
        )

    def _checked_there(self, server: ServerType, failed: FunctionFailed) -> FunctionFailed:
        """A failure as it is; one of a function that only the server that runs has, as its to check."""
        if not isinstance(failed.cause, UnknownFunction):
            return failed
        if self._described(server, [failed.function]):
            return FunctionFailed(failed.position, failed.function, _AtTheServer(failed.function))
        known = self._described(server, [])
        if known:
            cause: Exception = UnknownFunction(failed.function, known, server.name)
        elif server.ours:
            return failed
        else:
            there = "it has to be there before the behavior"
            cause = BadGoal("step", server.name, there, f"{server.name} does not run")
        return FunctionFailed(failed.position, failed.function, cause)

    def _described(self, server: ServerType, functions: Sequence[str]) -> Mapping[str, Any]:
        """Functions of a server that runs by name, as FunctionDescription; none if it does not."""
        try:
            return {each.name: each for each in self._describe(server.name, functions).functions}
        except NotDescribed:
            return {}

    def _chain(self, server: ServerType) -> FunctionChain:
        if server.name not in self._chains:
            declared = {**MemoryFunctions.functions, **server.module.declared_functions()}
            methods = {name: MethodType(function, _Elsewhere()) for name, function in declared.items()}
            self._chains[server.name] = FunctionChain(FunctionTable(methods), server.name)
        return self._chains[server.name]

    def _module(self, server: ServerType) -> Any:
        if server.name not in self._modules:
            self._modules[server.name] = offline_module(server.module)
        return self._modules[server.name]


class _AtTheServer(Exception):  # a signal: the rest of a check can only be done by the server
    """A check asks for something that is only known where the server runs."""


class _Elsewhere:
    """Stands for the server in its checks: it knows nothing."""

    def __getattr__(self, name: str) -> Any:
        raise _AtTheServer(name)
