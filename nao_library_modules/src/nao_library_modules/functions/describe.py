"""What the functions of a server are, as they declare it: names, arguments, units, limits, one line of help.

Names come from the function table, help from the docstrings, answers from the annotations, and what a field may hold
from its declaration in the signature (see `fields`). Of a field that is not declared the message's definition tells.
"""

from __future__ import annotations

import inspect
import json
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from .chain import COMMON, declared_fields, fields_read
from .fields import Field, Question
from .memory_functions import MemoryFunctions
from .message_fields import read_fields

NO_UNIT = "no unit"
"""Unit of numbers that have none."""
NOTHING = "nothing"
_ANSWERS = {"str": "text", "float": "number", "int": "whole number", "bool": "truth value", "Any": "value"}
_MANY = re.compile(r"(?:list|List|Sequence|tuple)\[(.*)\]")


@dataclass(frozen=True)
class Argument:
    """A field as one function reads it; see ArgumentDescription.msg."""

    name: str
    type: str
    unit: str
    default: str
    help: str
    allowed: str
    choices: tuple[str, ...]
    minimum: float
    maximum: float


@dataclass(frozen=True)
class Described:
    """One function; see FunctionDescription.msg."""

    name: str
    help: str
    answers: str
    shared: bool
    arguments: tuple[Argument, ...]


class Description:
    """The functions of one server. Each is worked out when it is asked for, and kept.

    Attributes:
        action: Type of the action, with its package.
        message: Type of the function messages, with its package.
        table: NAOqi function name -> callable; it may change.
        help: First line of the docstring of the module's class.
        choices: Function, field, what to ask the robot -> words that it may hold, where they are not declared.
    """

    def __init__(
        self,
        table: Mapping[str, Callable[..., Any]],
        kind: type,
        action: type,
        choices: Callable[[str, str, Sequence[Question]], Sequence[str]] = lambda function, field, asked: (),
    ) -> None:
        """Look at what the server takes.

        Args:
            table: Its functions, those of the robot's memory among them.
            kind: Class of the module behind it.
            action: Type of its action; the first field of the goal is the array of function messages.
            choices: As the attribute.
        """
        import roslib.message  # not needed by who only looks at texts

        self.choices = choices
        goal = action().action_goal.goal
        self.action = f"{goal._type.rpartition('/')[0]}/{action.__name__[: -len('Action')]}"
        self.message = goal._slot_types[0].partition("[")[0]
        self.table = table
        self.help = first_line(kind)
        self._message_type = roslib.message.get_message_class(self.message)
        self._fields = read_fields(self._message_type._full_text)
        self._defaults = self._message_type()
        self._shared = frozenset(MemoryFunctions.functions)

    def functions(self, names: Sequence[str] = (), arguments: bool = True) -> list[Described]:
        """Descriptions of functions; of all without names. Unknown names are left out.

        `names`: names of functions. `arguments`: False: without what they take.
        """
        table = dict(self.table)
        return [self._described(name, table[name], arguments) for name in names or table if name in table]

    def common(self) -> list[Argument]:
        """The fields that every function has."""
        return [self._argument("", name, field) for name, field in COMMON.items() if name in self._fields]

    def _described(self, name: str, function: Callable[..., Any], arguments: bool) -> Described:
        taken = self._arguments(name, function) if arguments else ()
        return Described(name, first_line(function), answers(function), name in self._shared, tuple(taken))

    def _arguments(self, name: str, function: Callable[..., Any]) -> list[Argument]:
        names = self._message_type.__slots__
        declared = declared_fields(function, names)
        return [self._argument(name, each, declared.get(each)) for each in fields_read(function, names)]

    def _argument(self, function: str, name: str, declared: Field | None) -> Argument:
        known = self._fields[name]
        field = declared or Field(known.comment)
        unit = "s" if known.is_time else field.unit
        return Argument(
            name,
            known.type,
            unit or (NO_UNIT if known.numeric and declared else ""),
            default_text(getattr(self._defaults, name)),
            field.help,
            field.allowed,
            tuple(field.choices) or tuple(self.choices(function, name, field.asked if declared else self._asked(name))),
            field.minimum,
            field.maximum,
        )

    def _asked(self, name: str) -> Sequence[Question]:
        """What a field of this name asks the robot in the first function that declares it so."""
        functions = (each for each in self.table.values() if callable(each))
        fields = (declared_fields(each, (name,)).get(name) for each in functions)
        return next((field.asked for field in fields if field and field.asked), ())


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
