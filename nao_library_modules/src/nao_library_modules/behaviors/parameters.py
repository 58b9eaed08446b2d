"""Parameters of behaviours: what they may be, values for them, and `${...}` expressions that use them. Pure.

An expression has names of parameters, numbers, + - * / and parentheses. Alone it stands for the value as it is; in a
text it becomes text. `$${` stands for the two characters `${`.
"""

from __future__ import annotations

import ast
import keyword
import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Union

from ..core.errors import BadGoal, did_you_mean
from .behavior_errors import BehaviorError, Problem
from .strict_yaml import load

Number = Union[int, float]
_PART = re.compile(r"\$\$\{|\$\{([^{}]*)\}|\$\{")
_WORD = re.compile(r"[A-Za-z_]\w*")
IDENTIFIER = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
"""What parameters, servers and functions may be called."""
_PLAIN = "__plain"
"""Behind a word of Python's in what its parser reads: a parameter may be called `from`."""
_OPERATIONS = {
    ast.Add: lambda a, b: a + b,
    ast.Sub: lambda a, b: a - b,
    ast.Mult: lambda a, b: a * b,
    ast.Div: lambda a, b: a / b,
}
GRAMMAR = "a parameter, or arithmetic on numbers and parameters: + - * / and parentheses"
LARGEST = 1e300
LONGEST = 200
"""Characters of an expression: deeper ones than fit in would be too deep for the parser."""


class Unknown:
    """Takes the place of a value that is wrong: what depends on it is looked at no further, as that is told already."""

    def __repr__(self) -> str:
        return "a value that is wrong"


UNKNOWN = Unknown()


class NotKnown(Exception):  # a signal: a value depends on one that is wrong
    """Something cannot be worked out as a value in it is `UNKNOWN`."""


class BadExpression(BadGoal):
    """An expression cannot be read or worked out."""

    def __init__(self, text: str, problem: str, allowed: str = GRAMMAR) -> None:
        super().__init__("${" + text + "}", text, allowed, problem=problem)


def substitute(value: Any, values: Mapping[str, Any]) -> Any:
    """A value with everything in `${}` worked out, also inside lists and mappings.

    Raises BadExpression if something cannot be worked out, NotKnown if it depends on a value that is wrong.
    """
    if value is UNKNOWN:
        raise NotKnown
    if isinstance(value, str):
        return _substitute_text(value, values)
    if isinstance(value, list):
        return [substitute(each, values) for each in value]
    if isinstance(value, dict):
        return {key: substitute(each, values) for key, each in value.items()}
    return value


def names_in(value: Any) -> Iterator[str]:
    """Names that the expressions in a value use, also inside lists and mappings.

    Raises BadExpression if an expression cannot be read.
    """
    if isinstance(value, str):
        for match in _PART.finditer(value):
            if match[0] != "$${":
                yield from (_name(each) for each in ast.walk(_parsed(match)) if isinstance(each, ast.Name))
    elif isinstance(value, (list, tuple)):
        for each in value:
            yield from names_in(each)
    elif isinstance(value, dict):
        for each in value.values():
            yield from names_in(each)


def escaped(value: Any) -> Any:
    """A value such that `substitute` gives it back as it is."""
    if isinstance(value, str):
        return value.replace("${", "$${")
    if isinstance(value, list):
        return [escaped(each) for each in value]
    if isinstance(value, dict):
        return {key: escaped(each) for key, each in value.items()}
    return value


def text_of(value: Any) -> str:
    """A value as it appears within a text: 3.0 as "3", true as "true"."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        return f"{value:.12g}"
    if isinstance(value, list):
        return ", ".join(map(text_of, value))
    return str(value)


def _substitute_text(text: str, values: Mapping[str, Any]) -> Any:
    whole = _PART.fullmatch(text)
    if whole is not None and whole[0] != "$${":
        return _value(whole, values)
    return _PART.sub(lambda match: "${" if match[0] == "$${" else text_of(_value(match, values)), text)


def _value(match: re.Match[str], values: Mapping[str, Any]) -> Any:
    return _worked_out(_parsed(match), match[1], values)


def _parsed(match: re.Match[str]) -> ast.expr:
    text = match[1]
    if text is None:
        raise BadExpression(match.string[match.end() :][:20], "its } is missing, or it holds a brace")
    if len(text) > LONGEST:
        raise BadExpression(text[:20] + "...", f"it has {len(text)} characters, at most {LONGEST} are read")
    try:
        plain = _WORD.sub(lambda word: word[0] + _PLAIN * keyword.iskeyword(word[0]), text.strip())
        return ast.parse(plain, mode="eval").body
    except (SyntaxError, ValueError, MemoryError, RecursionError) as error:
        raise BadExpression(text, "it cannot be read") from error


def _name(node: ast.Name) -> str:
    return node.id[: -len(_PLAIN)] if node.id.endswith(_PLAIN) else node.id


def _worked_out(node: ast.expr, text: str, values: Mapping[str, Any]) -> Any:
    if isinstance(node, ast.Name):
        name = _name(node)
        if name not in values:
            known = f"there are {', '.join(values)}" if values else "there are no parameters"
            raise BadExpression(text, f"there is no parameter {name!r}{did_you_mean(name, values)}", known)
        if values[name] is UNKNOWN:
            raise NotKnown
        return values[name]
    if isinstance(node, ast.Constant) and type(node.value) in (int, float):
        return _checked(node.value, text)
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, (ast.USub, ast.UAdd)):
        operand = _number(node.operand, text, values)
        return -operand if isinstance(node.op, ast.USub) else operand
    if isinstance(node, ast.BinOp) and type(node.op) in _OPERATIONS:
        left, right = _number(node.left, text, values), _number(node.right, text, values)
        try:
            result = _OPERATIONS[type(node.op)](left, right)
        except ZeroDivisionError:
            raise BadExpression(text, "it divides by zero") from None
        except OverflowError:
            raise BadExpression(text, "its result is too large") from None
        return _checked(result, text)
    raise BadExpression(text, "it cannot be read")


def _checked(number: Number, text: str) -> Number:
    if abs(number) > LARGEST or not math.isfinite(number):
        raise BadExpression(text, "its result is too large")
    return number


def _number(node: ast.expr, text: str, values: Mapping[str, Any]) -> Number:
    value = _worked_out(node, text, values)
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise BadExpression(text, f"{text_of(value)!r} is no number to calculate with")
    return value


# --- parameters -------------------------------------------------------------------------------------------------------

TEXT, NUMBER, TRUTH, LIST = "text", "number", "truth value", "list"


def kind_of(value: Any) -> str | None:
    """The kind of a value; None if parameters have none such."""
    if isinstance(value, bool):
        return TRUTH
    if isinstance(value, (int, float)):
        return NUMBER if abs(value) <= LARGEST else None  # integers of YAML may have any length; not for NaN either
    if isinstance(value, str):
        return TEXT
    if isinstance(value, list) and all(kind_of(each) in (TEXT, NUMBER, TRUTH) for each in value):
        return LIST
    return None


@dataclass(frozen=True)
class Parameter:
    """A parameter of a behaviour."""

    name: str
    default: Any  # value where none is given; its kind is that of the parameter. `UNKNOWN`: the file is wrong about it
    help: str
    choices: tuple[Any, ...] = ()  # values that it may have; empty: any
    lowest: float = -math.inf
    highest: float = math.inf
    unit: str = ""
    line: int = 0  # of its file, where it is declared; 0 if it is not known

    @property
    def kind(self) -> str:
        """text, number, truth value or list."""
        kind = kind_of(self.default)
        assert kind is not None, "the reader lets no other defaults through"
        return kind

    @property
    def allowed(self) -> str:
        """What it may be, in words."""
        if self.choices:
            return f"one of {', '.join(map(text_of, self.choices))}"
        unit = f" {self.unit}" if self.unit else ""
        low, high = math.isfinite(self.lowest), math.isfinite(self.highest)
        if low and high:
            return f"{self.lowest:g} to {self.highest:g}{unit}"
        if low or high:
            return f"{self.lowest:g}{unit} or more" if low else f"{self.highest:g}{unit} or less"
        return f"a {self.kind}{f' in{unit}' if unit else ''}"

    def check(self, value: Any) -> Any:
        """The value as it is used. Raises BadGoal if the parameter cannot have it."""
        if UNKNOWN in (self.default, value):
            return UNKNOWN
        if self.kind == TEXT and kind_of(value) == NUMBER:
            value = text_of(value)
        if kind_of(value) != self.kind:
            raise BadGoal(self.name, value, self.allowed, problem=f"{value!r} is no {self.kind}")
        if self.choices and value not in self.choices:
            hint = did_you_mean(value, map(text_of, self.choices)) if isinstance(value, str) else ""
            raise BadGoal(self.name, value, self.allowed, problem=f"{value!r} is not allowed{hint}")
        if self.kind == NUMBER and not self.lowest <= value <= self.highest:
            raise BadGoal(self.name, value, self.allowed)
        return value

    def parse(self, text: str) -> Any:
        """The value that a text stands for: texts as they are, all else as in YAML.

        Raises BadGoal if it is none of the parameter's kind.
        """
        if self.default is UNKNOWN or self.kind == TEXT:
            return self.check(text)
        try:
            value = load(text, self.name)
        except BehaviorError as error:
            raise BadGoal(self.name, text, self.allowed, problem=f"{text[:200]!r} is no {self.kind}") from error
        return self.check(value)


def arguments(parameters: Mapping[str, Parameter], given: Mapping[str, Any]) -> dict[str, Any]:
    """Name -> value of all parameters: those given, and the defaults of the others.

    Raises BadGoal if one is unknown, or a value will not do.
    """
    require_known(given, parameters)
    return {name: each.check(given[name]) if name in given else each.default for name, each in parameters.items()}


def require_known(names: Iterable[str], parameters: Mapping[str, Parameter]) -> None:
    """See that all names are parameters. Raises BadGoal if one is not."""
    for name in names:
        if name not in parameters:
            known = f"there are {', '.join(parameters)}" if parameters else "it has none"
            problem = f"there is no parameter {name!r}{did_you_mean(str(name), parameters)}"
            raise BadGoal("parameters", name, known, problem=problem)


def given_as_text(
    parameters: Mapping[str, Parameter], texts: Sequence[str], problems: list[Problem], file: str = ""
) -> dict[str, Any]:
    """Name -> value of what is given as "name=value".

    `problems`: where to note what is unknown, comes twice, or has a value that will not do; that becomes `UNKNOWN`.
    `file`: that declares the parameters.
    """
    given: dict[str, Any] = {}
    for text in texts:
        name, equals, value = text.partition("=")
        name = name.strip()
        try:
            if not equals:
                raise BadGoal("parameters", text, "name=value, each one string", problem=f"{text!r} has no '='")
            if name in given:
                raise BadGoal("parameters", text, "each once", problem=f"{name!r} comes twice")
            require_known([name], parameters)
            given[name] = parameters[name].parse(value)
        except BadGoal as error:
            if name in parameters:
                given[name] = UNKNOWN
            line = parameters[name].line if name in parameters else 0
            problems.append(Problem(f"parameter {name}" if name in parameters else "", str(error), line, file))
    return given
