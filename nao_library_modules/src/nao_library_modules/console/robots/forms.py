"""What a person fills in to call a function: its fields as the server declares them, and values from what is typed."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Tuple

from ...base.degrees import ANGLES, in_rad
from ...base.suggestion import did_you_mean
from ...behaviors.language.errors import BehaviorError
from ...behaviors.language.expressions import UNKNOWN, text_of
from ...behaviors.language.model import Behavior
from ...behaviors.language.yaml_text import dump_line, load

_WHOLE = re.compile(r"u?int\d+|byte|char")
_FLOAT = re.compile(r"float\d+|duration|time")
_TRUTH = {"true": True, "yes": True, "on": True, "1": True, "false": False, "no": False, "off": False, "0": False}
_KINDS = {"text": "string", "number": "number", "truth value": "bool", "list": "any"}
"""Kind of a behaviour's parameter -> type of a field."""
EXPRESSION = "${"
"""In a text: its value is calculated when a behaviour runs."""
_MARKS = "[]{},\"'#"
"""Characters that have a meaning in lists of YAML."""


@dataclass(frozen=True)
class FormField:
    """A field of a form."""

    name: str
    type: str  # of one value, as messages write it: string, float64, bool, duration, package/Message; "number", "any"
    help: str = ""
    unit: str = ""  # empty: none
    choices: Tuple[str, ...] = ()  # words that may be meant; others may do as well
    low: float = -math.inf  # the least number
    high: float = math.inf  # the greatest one
    default: Any = None  # plain value; None: there is none to show
    repeated: bool = False  # whether it holds a list
    allowed: str = ""  # what it may hold, in words

    @property
    def numeric(self) -> bool:
        return self.type == "number" or bool(_WHOLE.fullmatch(self.type) or _FLOAT.fullmatch(self.type))

    @property
    def hint(self) -> str:
        """What there is to say beside its name: its meaning, unit and range."""
        limits = self.allowed or self._range()
        if self.help.endswith(limits) or limits.endswith(self.help):  # "text to say", and "the text to say"
            limits = ""
        unit = f"in {self.unit}" if self.unit and self.unit not in limits.split() else ""
        return "; ".join(filter(None, (self.help, limits if not self.choices else "", unit)))

    def _range(self) -> str:
        low, high = math.isfinite(self.low), math.isfinite(self.high)
        if low and high:
            return f"{self.low:g}..{self.high:g}"
        return f"{self.low:g} or more" if low else f"{self.high:g} or less" if high else ""


def form_of(described_function: Any) -> list[FormField]:
    """The fields of a function. `described_function`: FunctionDescription, or whatever has its `arguments`."""
    return [_field(argument) for argument in described_function.arguments]


def form_of_parameters(parameters: Sequence[Any]) -> list[FormField]:
    """The fields for the parameters of a stored behaviour; `parameters`: BehaviorParameter of each."""
    return [
        _of_parameter(
            each.name,
            each.type,
            each.help,
            each.unit,
            [load(choice, each.name) for choice in each.choices],
            (each.min, each.max),
            load(each.default, each.name),
        )
        for each in parameters
    ]


def form_of_behavior(behavior: Behavior) -> list[FormField]:
    """The fields for the parameters of a behaviour that was read; without those that the file is wrong about."""
    return [
        _of_parameter(
            each.name, each.kind, each.help, each.unit, each.choices, (each.lowest, each.highest), each.default
        )
        for each in behavior.parameters.values()
        if each.default is not UNKNOWN
    ]


def _of_parameter(
    name: str, kind: str, help_: str, unit: str, choices: Sequence[Any], bounds: tuple[float, float], default: Any
) -> FormField:
    texts = tuple(map(text_of, choices))
    return FormField(name, _KINDS.get(kind, "any"), help_, unit, texts, *bounds, default, kind == "list")


def _field(argument: Any) -> FormField:
    kind, bracket, _ = argument.type.partition("[")
    low = -math.inf if math.isnan(argument.minimum) else argument.minimum
    high = math.inf if math.isnan(argument.maximum) else argument.maximum
    return FormField(
        argument.name,
        kind,
        argument.help,
        "" if argument.unit == "no unit" else argument.unit,
        tuple(argument.choices),
        low,
        high,
        json.loads(argument.default) if argument.default else None,
        bool(bracket),
        argument.allowed,
    )


def value_of(field: FormField, text: str) -> Any:
    """The plain value that a text stands for in a field; times in s.

    Lists are values with commas between them, or YAML in brackets; messages are YAML in braces. Raises ValueError with
    what is wrong and what would be right.
    """
    if not field.repeated:
        return _single(field, text)
    bare = text.strip()
    if not bare.startswith("["):
        return [_single(field, entry.strip()) for entry in bare.split(",")] if bare else []
    entries = _yaml(field, bare)
    if not isinstance(entries, list):
        raise ValueError(f"{field.name}: {text!r} is no list: values with commas between them, or [...]")
    return [_single(field, each) for each in entries]


def typed_value(field: FormField, text: str) -> Any:
    """As `value_of`, for steps of behaviours: a text with an expression in it is left as it is. Raises ValueError."""
    if EXPRESSION not in text:
        return value_of(field, text)
    bare = text.strip()
    if bare.startswith("["):
        return value_of(FormField(field.name, "any", repeated=True), bare)
    alone = bare.startswith(EXPRESSION) and bare.endswith("}") and bare.count(EXPRESSION) == 1
    return value_of(FormField(field.name, "string", repeated=field.repeated and not alone), text)


def text_of_value(field: FormField, value: Any) -> str:
    """A plain value as a person would type it: `value_of` reads it as the same."""
    if not field.repeated:
        return _typed(value)
    if not isinstance(value, list):
        return _typed(value)
    plain = all(not isinstance(each, (dict, list)) for each in value)
    texts = [_typed(each) for each in value]
    if plain and all(text and text == text.strip() and not any(mark in text for mark in _MARKS) for text in texts):
        return ", ".join(texts)
    return dump_line(value) if value else ""


def _typed(value: Any) -> str:
    if value is None:
        return ""
    if isinstance(value, (dict, list)):
        return dump_line(value)
    return repr(value) if isinstance(value, float) and not value.is_integer() else text_of(value)


def _single(field: FormField, value: Any) -> Any:
    kind = field.type
    if kind == "string":
        return value if isinstance(value, str) else text_of(value)
    if kind == "bool":
        return _truth(field, value)
    if kind == "any":
        return _yaml(field, value) if isinstance(value, str) else value
    if field.numeric:
        return _number(field, value)
    content = _yaml(field, value) if isinstance(value, str) else value
    if not isinstance(content, dict):
        raise ValueError(f"{field.name}: {value!r} is no {kind}: its fields in braces are wanted, as {{name: value}}")
    return content


def _truth(field: FormField, value: Any) -> bool:
    if isinstance(value, bool):
        return value
    word = str(value).strip().lower()
    if word not in _TRUTH:
        hint = did_you_mean(word, ("true", "false"))
        raise ValueError(f"{field.name}: {value!r} is neither true nor false{hint}")
    return _TRUTH[word]


def _number(field: FormField, value: Any) -> float | int:
    unit = f" {field.unit}" if field.unit else ""
    try:
        number = _angle(field, value)
    except ValueError:
        wanted = "a whole number" if _WHOLE.fullmatch(field.type) else "a number"
        raise ValueError(f"{field.name}: {value!r} is no number: {wanted}{f' in{unit}' if unit else ''}") from None
    if not math.isfinite(number):
        raise ValueError(f"{field.name}: {value!r} is no finite number")
    if not field.low <= number <= field.high:
        allowed = field.allowed or f"{field._range()}{unit}"
        raise ValueError(f"{field.name}: {number:g} is not allowed: {allowed}")
    if _WHOLE.fullmatch(field.type):
        if number != int(number):
            raise ValueError(f"{field.name}: {value!r} is no whole number")
        return int(number)
    if field.type == "number" and number == int(number) and not (isinstance(value, str) and "." in value):
        return int(number)
    return number


def _angle(field: FormField, value: Any) -> float:
    """A number; in a field for angles also one in degrees, as rad."""
    return in_rad(value) if field.name in ANGLES else float(value)


def _yaml(field: FormField, text: str) -> Any:
    try:
        return load(text, field.name)
    except BehaviorError as error:
        raise ValueError(f"{field.name}: {error.problems[0].text}") from None
