"""What the functions of a server are, told from its code: names, arguments, units, limits, one line of help.

Nothing is written down for it. Names and arguments come from the function table and the functions' parameters, help
from docstrings, types and meaning of the fields from the message's definition with its comments, limits and words from
the checks, and the names that only a robot knows from the robot.
"""

from __future__ import annotations

import inspect
import json
import math
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from ..base.failure_policy import ALLOWED as POLICIES
from .chain import CHECK_ATTRIBUTE, COMMON, WAIT, fields_taken
from .describe_checks import allowed_in
from .describe_fields import FieldComment, FieldHelp, read_fields
from .describe_limits import Allowed
from .memory_functions import MemoryFunctions

NOTHING = "nothing"
_ANSWERS = {"str": "text", "float": "number", "int": "whole number", "bool": "truth value", "Any": "value"}
_COMMON_LIMITS = {
    "time": Allowed("{:g}..{:g} {}".format(*WAIT), WAIT.lowest, WAIT.highest),
    "on_error": Allowed(POLICIES),
}
_MANY = re.compile(r"(?:list|List|Sequence|tuple)\[(.*)\]")


@dataclass(frozen=True)
class Argument:
    """A field as one function reads it; see ArgumentDescription.msg."""

    name: str
    type: str
    unit: str
    default: str
    help: str
    allowed: str = ""
    choices: tuple[str, ...] = ()
    minimum: float = math.nan
    maximum: float = math.nan


@dataclass(frozen=True)
class Described:
    """One function; see FunctionDescription.msg."""

    name: str
    help: str
    answers: str
    shared: bool
    arguments: tuple[Argument, ...]


class Description:
    """The functions of one module. Each is worked out when it is asked for, and kept.

    Attributes:
        action: Type of the action, with its package.
        message: Type of the function messages, with its package.
        help: First line of the module's docstring.
        choices: Function, field -> words that it may hold, where the checks do not tell them: those of the robot.
    """

    def __init__(self, module: Any, action: type) -> None:
        """Look at what the module serves.

        Args:
            module: The module; its `function_table` may change later.
            action: Type of its action; the first field of the goal is the array of function messages.
        """
        self.choices: Callable[[str, str], Sequence[str]] = lambda function, field: ()
        goal = action().action_goal.goal
        self.action = f"{goal._type.rpartition('/')[0]}/{action.__name__[: -len('Action')]}"
        self.message = goal._slot_types[0].partition("[")[0]
        self.help = first_line(type(module))
        self._module = module
        self._message_type = message_class(goal)
        self._fields = read_fields(self._message_type._full_text)
        self._defaults = self._message_type()
        self._shared = frozenset(MemoryFunctions.memory_functions(module))
        self._limits: dict[str, tuple[Any, Mapping[str, Allowed]]] = {}

    @property
    def names(self) -> list[str]:
        """Names of the functions, in the order of the table."""
        return list(self._module.function_table)

    def functions(self, names: Sequence[str] = (), arguments: bool = True) -> list[Described]:
        """Descriptions of functions; of all without names. Unknown names are left out.

        Args:
            names: Names of functions.
            arguments: False: without what they take.
        """
        table = dict(self._module.function_table)
        texts = FieldHelp(self._fields, table, self._shared)
        return [self._describe(name, table[name], texts, arguments) for name in names or table if name in table]

    def common(self) -> list[Argument]:
        """The fields that every function has."""
        texts = FieldHelp(self._fields, self._module.function_table, self._shared)
        return [self._argument(name, "", texts, _COMMON_LIMITS[name]) for name in COMMON if name in self._fields]

    def _describe(self, name: str, function: Callable[..., Any], texts: FieldHelp, arguments: bool) -> Described:
        taken = self._arguments(name, function, texts) if arguments else ()
        return Described(name, first_line(function), answers(function), name in self._shared, tuple(taken))

    def _arguments(self, name: str, function: Callable[..., Any], texts: FieldHelp) -> list[Argument]:
        limits = self._limits_of(name, function)
        names = self._message_type.__slots__
        fields = fields_taken(function, names)
        check = getattr(function, CHECK_ATTRIBUTE, None)
        checked = fields_taken(check, names) if check else ()
        read = dict.fromkeys((*fields, *checked))
        return [self._argument(field, name, texts, limits.get(field, Allowed())) for field in read]

    def _limits_of(self, name: str, function: Callable[..., Any]) -> Mapping[str, Allowed]:
        known = self._limits.get(name)
        if known is None or known[0] is not function and known[0] != function:
            check = getattr(function, CHECK_ATTRIBUTE, None)
            owner = getattr(function, "__self__", self._module)
            known = self._limits[name] = (function, allowed_in(check, owner, self._fields))
        return known[1]

    def _argument(self, field: str, function: str, texts: FieldHelp, limits: Allowed) -> Argument:
        comment: FieldComment = self._fields[field]
        return Argument(
            field,
            comment.type,
            texts.unit(field, function, limits.text),
            default_text(getattr(self._defaults, field)),
            texts.help(field, function),
            limits.text,
            limits.choices or tuple(self.choices(function, field)),
            limits.minimum if comment.numeric else math.nan,  # "up to 64" counts the characters of a text
            limits.maximum if comment.numeric else math.nan,
        )


def message_class(goal: Any) -> type:
    """Type of the function messages in a goal."""
    import roslib.message  # not needed by who only looks at texts

    return roslib.message.get_message_class(goal._slot_types[0].partition("[")[0])


def default_text(value: Any) -> str:
    """A field's default as JSON; empty for a message inside."""
    to_sec = getattr(value, "to_sec", None)
    if to_sec is not None:
        value = to_sec()
    try:
        return json.dumps(value)
    except TypeError:
        return ""


def first_line(thing: Any) -> str:
    """First line of a docstring; empty if there is none."""
    return (inspect.getdoc(thing) or "").partition("\n")[0]


def answers(function: Callable[..., Any]) -> str:
    """What a function answers, in words, told from its annotation."""
    annotation = inspect.signature(function).return_annotation
    if annotation is inspect.Signature.empty or annotation in (None, "None"):
        return NOTHING
    return _in_words(annotation if isinstance(annotation, str) else getattr(annotation, "__name__", str(annotation)))


def _in_words(annotation: str) -> str:
    name = annotation.strip()
    many = _MANY.fullmatch(name)
    if many:
        return f"list of {_in_words(many[1].partition(', ...')[0])}"
    if name.endswith("| None"):
        return f"{_in_words(name[: -len('| None')])} or nothing"
    return _ANSWERS.get(name, re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name).lower())
