"""Conditions of protocols, as `answer == yes` or `touches + 1 < 3`, and names in texts, as `{participant}`. Pure."""

from __future__ import annotations

import operator
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from ...base.suggestion import of_those
from ...behaviors.language.expressions import BadExpression, names_in, substitute, text_of

NOTHING = "none"
"""What a value is that has not been given yet, and the answer of a step without one."""
OPERATIONS = {
    "==": operator.eq,
    "!=": operator.ne,
    "<=": operator.le,
    ">=": operator.ge,
    "<": operator.lt,
    ">": operator.gt,
}
ORDERED = ("<", "<=", ">", ">=")
"""Operators that compare numbers only."""
FORM = (
    "a condition is VALUE == WORD, VALUE != WORD, or VALUE < NUMBER (also <=, >, >=); VALUE is a name, or arithmetic "
    "on names; {NAME} on the right stands for a value"
)
_COMPARISON = re.compile(r"\s*([^=!<>]+?)\s*(==|!=|<=|>=|<|>)\s*([^=!<>]*?)\s*")
_NAME = re.compile(r"\{([A-Za-z_]\w*)\}")
_ONE_EQUALS = re.compile(r"\s*([A-Za-z_]\w*)\s*=\s*([^=]+)")
_JOINED = re.compile(r"\s+(and|or|&&|\|\|)\s+")


@dataclass(frozen=True)
class StudyCondition:
    """A comparison of a value of the trial with a word, a number or another value."""

    left: str  # a name, or arithmetic on names and numbers
    operation: str  # one of `OPERATIONS`
    right: str  # a word, a number, or {name}
    line: int = field(default=0, compare=False)  # of the file

    @staticmethod
    def read(text: str, line: int = 0) -> StudyCondition:
        """Of its text. Raises ValueError if it is none."""
        joined = _JOINED.search(text)
        if joined:
            remedy = (
                "a list has several that all have to hold: [A == B, C == D]"
                if joined[1] in ("and", "&&")
                else "`choose` has a branch for each answer, and `timeout` ends a wait as well"
            )
            raise ValueError(f"{text!r} is no condition: `{joined[1]}` is not known; {remedy}")
        match = _COMPARISON.fullmatch(text)
        if match is None:
            single = _ONE_EQUALS.fullmatch(text)
            hint = f"did you mean {single[1]} == {single[2].strip()}? " if single else ""
            raise ValueError(f"{text!r} is no condition: {hint}{FORM}")
        left, operation, right = match.groups()
        condition = StudyCondition(left, operation, right.strip("'\""), line)
        try:
            condition.names()
        except BadExpression:
            raise ValueError(f"{left!r} in {text!r} cannot be read: {FORM}") from None
        if not condition.right:
            raise ValueError(f"{text!r} has nothing on the right; {NOTHING} is what an answer is that was not given")
        if operation in ORDERED and not _NAME.fullmatch(condition.right) and number_of(condition.right) is None:
            raise ValueError(f"{right!r} in {text!r} is no number: {operation} compares numbers")
        return condition

    def names(self) -> list[str]:
        """Names that it asks for."""
        return [*names_in(_expression(self.left)), *_NAME.findall(self.right)]

    def holds(self, values: Mapping[str, Any]) -> bool:
        """Whether it is true. A value that was not given is `none`, and neither less nor greater than a number."""
        left, right = self._left(values), filled(self.right, _given(_NAME.findall(self.right), values))
        number, other = number_of(left), number_of(right)
        if number is not None and other is not None:
            return bool(OPERATIONS[self.operation](number, other))
        if self.operation in ORDERED:
            return False
        return bool(OPERATIONS[self.operation](text_of(left), right))

    def _left(self, values: Mapping[str, Any]) -> Any:
        given = _given(names_in(_expression(self.left)), values)
        if self.left in given:
            return given[self.left]
        numbers = {name: number_of(value) for name, value in given.items()}
        try:
            return NOTHING if None in numbers.values() else substitute(_expression(self.left), numbers)
        except BadExpression:  # it divides by zero
            return NOTHING

    def __str__(self) -> str:
        return f"{self.left} {self.operation} {self.right}"


def filled(text: str, values: Mapping[str, Any]) -> str:
    """A text with its `{name}` replaced by values; names that there are not stay as they are."""
    return _NAME.sub(lambda match: text_of(values[match[1]]) if match[1] in values else match[0], text)


def unknown_names(text: str, known: Iterable[str]) -> list[str]:
    """What is to be said of the `{name}` in a text that mean nothing."""
    names = list(known)
    return [f"there is no {{{name}}}{of_those(name, names)}" for name in _NAME.findall(text) if name not in names]


def number_of(value: Any) -> float | None:
    """A number, also of its text; None for anything else."""
    if isinstance(value, bool):
        return None
    try:
        return float(value)
    except (TypeError, ValueError):
        return None


def _given(names: Iterable[str], values: Mapping[str, Any]) -> dict[str, Any]:
    return {name: NOTHING if values.get(name) in (None, "") else values[name] for name in names}


def _expression(text: str) -> str:
    return "${" + text + "}"
