"""Chains of functions, from messages to calls: look-up, binding of fields to parameters by name, checks. No ROS."""

from __future__ import annotations

import copy
import inspect
from collections import ChainMap
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Callable, ClassVar, TypeVar

from naoqi.errors import NaoError

from .errors import BadGoal, FunctionFailed, Preempted, UnknownFunction
from .fields import ALLOWED as POLICIES
from .fields import FailurePolicy, Field, fields_of, free, limit, number, require_length


class Part:
    """A group of library functions with the state that they share; without functions, state that other parts share.

    A module builds its parts and takes them in with `NaoBasic.add_parts`. The check of a function gets the part that
    the function belongs to as its first argument. Checks of goals that are not carried out get copies of all parts,
    which refer to each other as the parts do.
    """

    functions: ClassVar[Mapping[str, Callable[..., Any]]] = {}
    """NAOqi function name -> function of the class."""
    left_by_goals: ClassVar[frozenset[str]] = frozenset()
    """Attributes that checks read and goals change: what is stored, loaded, running."""

    def prepare_for_checks(self) -> None:
        """Called on a copy: replace what checks change by something of the copy's own."""


def bound(owner: Any, functions: Mapping[str, Callable[..., Any]]) -> dict[str, Callable[..., Any]]:
    """Functions of the owner's class as its methods, any others as they are."""
    members: dict[int, str] = {}
    for kind in type(owner).__mro__:
        for name, member in vars(kind).items():
            members.setdefault(id(member), name)
    return {
        name: getattr(owner, members[id(function)]) if id(function) in members else function
        for name, function in functions.items()
    }


def joined(kinds: Iterable[type[Part]]) -> dict[str, Callable[..., Any]]:
    """The functions of several parts. Raises TypeError if two parts declare functions of the same name."""
    found: dict[str, Callable[..., Any]] = {}
    for kind in kinds:
        twice = found.keys() & kind.functions.keys()
        if twice:
            raise TypeError(f"{kind.__name__} declares {', '.join(sorted(twice))}, and another part does so, too")
        found.update(kind.functions)
    return found


def copied(owners: Iterable[Any]) -> dict[int, Any]:
    """Copies of objects that refer to each other, by the identity of the original: the copies refer to each other."""
    copies = {id(owner): copy.copy(owner) for owner in owners}
    for each in copies.values():
        vars(each).update({name: copies[id(value)] for name, value in vars(each).items() if id(value) in copies})
    return copies


Function = TypeVar("Function", bound=Callable[..., Any])
StandIn = Callable[[object], object]

FUNCTIONS, NAMES, NUMBERS, CHARACTERS = map(limit, ("functions", "names", "numbers", "characters"))
CHECK_ATTRIBUTE = "goal_check"
COMMON = {
    "time": number("wait", "how long the server waits after the function"),
    "on_error": free("what becomes of the goal when the function fails: stop it, go on, try again", allowed=POLICIES),
}
"""Fields that every function has, and that no function takes."""
CONTEXT = "context"
REST = "args"
OF_THE_SERVER = frozenset({"function", *COMMON})
"""Fields that are no arguments."""


def checked_by(check: Callable[..., None]) -> Callable[[Function], Function]:
    """Declare the check of a library function.

    `check`: called before the chain runs with `self` and the fields it names; raises BadGoal when they will not do. A
    parameter `context` is a dict that lives as long as the check of one chain: what an earlier function will define can
    be left there for the checks of later ones.
    """

    def declare(function: Function) -> Function:
        setattr(function, CHECK_ATTRIBUTE, check)
        return function

    return declare


@dataclass(frozen=True)
class ChainStep:
    """One function of a chain, ready to run."""

    position: int  # place in the chain, counted from 1
    function: str  # name in the function table
    args: tuple[Any, ...]  # arguments in the order of the function's parameters
    sleep_time: float  # s to wait afterwards
    policy: FailurePolicy = FailurePolicy()  # what becomes of the chain when it fails


def seconds(duration: Any) -> float:
    """A duration in s, from a ROS duration or a number."""
    to_sec = getattr(duration, "to_sec", None)
    return float(duration if to_sec is None else to_sec())


def fields_taken(function: Callable[..., Any], fields: Sequence[str]) -> list[str]:
    """Fields of a message, of those given in their order, that a function takes as arguments."""
    parameters = inspect.signature(function).parameters.values()
    named = [parameter.name for parameter in parameters if parameter.name in fields]
    return [*named, *_rest(named, fields)] if any(map(_takes_rest, parameters)) else named


def fields_read(function: Callable[..., Any], fields: Sequence[str]) -> list[str]:
    """Fields of a message, as `fields_taken`, and those that only the check beside the function looks at."""
    check = getattr(function, CHECK_ATTRIBUTE, None)
    checked = fields_taken(check, fields) if check else ()
    return list(dict.fromkeys((*fields_taken(function, fields), *checked)))


def declared_fields(function: Callable[..., Any], names: Collection[str]) -> dict[str, Field]:
    """What a function and the check beside it declare of fields.

    `function`: the function. `names`: the fields of its message.
    """
    check = getattr(function, CHECK_ATTRIBUTE, None)
    of_check = {} if check is None else fields_of(check, names)
    own = fields_of(function, names)
    return {**own, **{name: field for name, field in of_check.items() if name not in own}}


def _takes_rest(parameter: inspect.Parameter) -> bool:
    return parameter.kind is parameter.VAR_POSITIONAL or parameter.name == REST


def _rest(named: Collection[str], fields: Sequence[str]) -> list[str]:
    return [field for field in fields if field not in named and field not in OF_THE_SERVER]


def _arguments(
    function: Callable[..., Any], message_type: type, after_self: bool = False
) -> Callable[[Any, dict[str, Any]], tuple[Any, ...]]:
    """What gives the arguments of a callable: message, context -> arguments; worked out once for a message type.

    `after_self`: whether the first parameter is not looked at.
    """
    fields = message_type.__slots__
    parameters = list(inspect.signature(function).parameters.values())
    if after_self:
        parameters = parameters[1:]
    rest = _rest([parameter.name for parameter in parameters], fields)
    spread: list[str] = []
    values: list[Callable[[Any, dict[str, Any]], Any]] = []
    for parameter in parameters:
        if parameter.kind is parameter.KEYWORD_ONLY and parameter.default is parameter.empty:
            problem = "the function takes it by its name alone"
            raise BadGoal(parameter.name, None, "a parameter before *args", problem=problem)
        if parameter.kind is parameter.VAR_POSITIONAL:
            spread = rest
        elif parameter.kind not in (parameter.KEYWORD_ONLY, parameter.VAR_KEYWORD):  # those keep their defaults
            values.append(_value(parameter, fields, rest, message_type.__name__))

    def arguments(message: Any, context: dict[str, Any]) -> tuple[Any, ...]:
        return (*(value(message, context) for value in values), *(getattr(message, field) for field in spread))

    return arguments


def _value(
    parameter: inspect.Parameter, fields: Sequence[str], rest: Sequence[str], message: str
) -> Callable[[Any, dict[str, Any]], Any]:
    """What gives the value of a parameter: message, context -> value."""
    name, default = parameter.name, parameter.default
    if name in fields:
        return lambda message, _: getattr(message, name)
    if name == CONTEXT:
        return lambda _, context: context
    if default is not parameter.empty:
        return lambda *_: default
    if name == REST:
        return lambda message, _: [getattr(message, field) for field in rest]
    raise BadGoal(
        name,
        None,
        f"the fields are {', '.join(fields)}; {REST} stands for all that are not named",
        problem=f"a parameter of the function, but no field of {message}",
    )


class BoundFunction:
    """A table entry bound to a message type: its arguments, and its check with the check's arguments.

    Attributes:
        function: The callable.
        arguments: Takes a message and the context, gives the arguments.
        fields: What it declares of fields, by their names.
        check: The check that was declared for it, if any.
    """

    def __init__(self, function: Callable[..., Any], message_type: type) -> None:
        self.function = function
        self.arguments = _arguments(function, message_type)
        self.fields = declared_fields(function, message_type.__slots__)
        self.check: Callable[..., None] | None = getattr(function, CHECK_ATTRIBUTE, None)
        if self.check is not None:
            self._bound_self = getattr(function, "__self__", None)
            self._check_arguments = _arguments(self.check, message_type, self._bound_self is not None)

    def check_fields(self, message: Any) -> None:
        """See that each field that the function declares holds what it may hold.

        Raises BadGoal, which names the first field that does not.
        """
        for name, field in self.fields.items():
            value = getattr(message, name)
            field.require(name, seconds(value) if hasattr(value, "to_sec") else value)

    def check_usual(self, message: Any) -> None:
        """See that the numbers of its fields are usual. Raises BadGoal, which names the first field that is not."""
        for name, field in {**self.fields, "time": COMMON["time"]}.items():
            value = getattr(message, name)
            field.require_usual(name, seconds(value) if hasattr(value, "to_sec") else value)

    def run_check(self, message: Any, context: dict[str, Any], stand_in: StandIn = lambda owner: owner) -> None:
        """Run the check, if there is one.

        `context`: what the checks of a chain share. `stand_in`: owner of the function -> what takes its place in the
        check.
        """
        if self.check is None:
            return
        owner = () if self._bound_self is None else (stand_in(self._bound_self),)
        self.check(*owner, *self._check_arguments(message, context))


def require_callable(name: str, function: Any) -> Callable[..., Any]:
    """The function of a table's entry itself. Raises NaoError if it cannot be called."""
    if not callable(function):
        raise NaoError(f"function_table[{name!r}] is {function!r}: a function or method is needed, without ()")
    return function


class FunctionTable(ChainMap):
    """A module's own functions over those of the robot's memory; it takes callables only."""

    def __setitem__(self, name: str, function: Callable[..., Any]) -> None:
        super().__setitem__(name, require_callable(name, function))

    def __ior__(self, table: Mapping[str, Callable[..., Any]]) -> FunctionTable:
        self.update(table)
        return self


class FunctionChain:
    """Reads chains of function messages for one function table.

    A binding is kept only as long as the table holds the same callable. `table`: NAOqi function name -> callable;
    anybody may change it at any time. `server`: name of the action that serves it, for texts; it may be set later.
    """

    def __init__(self, function_table: Mapping[str, Callable[..., Any]], server: str = "") -> None:
        self.server = server
        self.table = function_table
        self._bindings: dict[tuple[str, type], BoundFunction] = {}

    def look_up(self, name: str) -> Callable[..., Any]:
        """The callable of a name.

        Raises UnknownFunction with the closest names, or the list of all; NaoError: what the table has there cannot be
        called.
        """
        if not name:
            raise BadGoal("function", name, "the name of a function", problem="it is empty")
        try:
            return require_callable(name, self.table[name])
        except KeyError:
            raise UnknownFunction(name, self.table, self.server) from None

    def read(self, messages: Sequence[Any], before_check: Callable[[int], None] = lambda _: None) -> list[ChainStep]:
        """Check a whole chain and bind it; nothing runs.

        `messages`: function messages with at least the fields `function` and `time`. `before_check`: called with the
        place of each function, counted from 1, before it is checked. Raises BadGoal if the chain is empty or too long;
        FunctionFailed, which names the first function that is wrong and says why.
        """
        context: dict[str, Any] = {}
        # Two passes: what can be told without the robot is told without it.
        bindings = self.bind(messages)
        steps = []
        for i, (message, binding) in enumerate(zip(messages, bindings), start=1):
            before_check(i)
            arguments = binding.arguments(message, context)
            step = ChainStep(i, message.function, arguments, seconds(message.time), _policy(message))
            self._guarded(i, message, lambda m, b=binding: b.run_check(m, context))
            steps.append(step)
        return steps

    def failures(
        self,
        messages: Sequence[Any],
        before_check: Callable[[int], None] = lambda _: None,
        context: dict[str, Any] | None = None,
        stand_in: StandIn = lambda owner: owner,
    ) -> list[FunctionFailed]:
        """All that `read` would find, function by function; nothing runs.

        Raises BadGoal if the chain is empty or too long.

        Args:
            before_check: As `read` takes it.
            context: What the checks share, with those of the chains before.
            stand_in: As `BoundFunction.run_check` takes it.
        """
        _require_some(messages)
        context = {} if context is None else context
        found = []
        for i, message in enumerate(messages, start=1):
            before_check(i)
            try:
                binding = self._guarded(i, message, self.bind_one)
                self._guarded(i, message, lambda m, b=binding: b.run_check(m, context, stand_in))
            except FunctionFailed as failed:
                found.append(failed)
        return found

    def unusual(self, messages: Sequence[Any]) -> list[FunctionFailed]:
        """Functions whose fields hold numbers that are allowed and not usual; those that are wrong are left out."""
        found = []
        for i, message in enumerate(messages, start=1):
            try:
                binding = self.bind_one(message)
            except (BadGoal, UnknownFunction):
                continue
            try:
                self._guarded(i, message, binding.check_usual)
            except FunctionFailed as failed:
                found.append(failed)
        return found

    def bind(self, messages: Sequence[Any]) -> list[BoundFunction]:
        """Look at what concerns no robot: names of functions, times, failure policies, what fields declare.

        Returns for each message what is to be called; its `run_check` runs the check. Raises BadGoal if the chain is
        empty or too long; FunctionFailed, which names the first function that is wrong and says why.
        """
        _require_some(messages)
        return [self._guarded(i, message, self.bind_one) for i, message in enumerate(messages, start=1)]

    @staticmethod
    def _guarded(position: int, message: Any, action: Callable[[Any], Any]) -> Any:
        try:
            return action(message)
        except Preempted:
            raise
        except Exception as error:  # a check with a mistake in it as well: the text names the function
            raise FunctionFailed(position, message.function, _text_for_list(message, error) or error) from error

    def bind_one(self, message: Any) -> BoundFunction:
        """As `bind`, for one message; raises what is wrong with it, BadGoal or UnknownFunction."""
        _require_lengths(message)
        COMMON["time"].require("time", seconds(message.time))
        _policy(message)
        function = self.look_up(message.function)
        key = (message.function, type(message))
        binding = self._bindings.get(key)
        if binding is None or binding.function is not function:
            binding = self._bindings[key] = BoundFunction(function, type(message))
        binding.check_fields(message)
        return binding


def _text_for_list(message: Any, error: Exception) -> BadGoal | None:
    """The error to tell where the field that is wrong is a text in letters: ROS takes "Eyes" as a list of four."""
    values = getattr(message, error.field, None) if isinstance(error, BadGoal) else None
    if not isinstance(values, (list, tuple)) or len(values) < 2:
        return None
    if not all(isinstance(value, str) and len(value) == 1 for value in values):
        return None
    return BadGoal(error.field, values, repr(["".join(values)]), problem="it is a text, and a list is needed")


def _require_some(messages: Sequence[Any]) -> None:
    if not messages:
        raise BadGoal("functions", list(messages), "at least one function", problem="the chain is empty")
    require_length("functions", len(messages), FUNCTIONS)


def _require_lengths(message: Any) -> None:
    """See that no list and no text of a message is too long, whatever the function does with it."""
    for field in type(message).__slots__:
        value = getattr(message, field)
        if isinstance(value, (list, tuple)) and value:
            require_length(field, len(value), NAMES if isinstance(value[0], str) else NUMBERS)
        elif isinstance(value, str):
            require_length(field, len(value), CHARACTERS)


def _policy(message: Any) -> FailurePolicy:
    """The failure policy of a message; a module's own message type need not have the field."""
    return FailurePolicy.of(getattr(message, "on_error", ""))
