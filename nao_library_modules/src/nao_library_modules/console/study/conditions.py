"""Conditions of protocols, as `answer == yes` or `touches + 1 < 3`, and names in texts, as `{participant}`. Pure."""

from __future__ import annotations

import operator
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from ...base.suggestion import of_those
from ...behaviors.language.expressions import BadExpression, names_in, substitute, text_of

OPERATIONS = {
    "==": operator.eq,
    "!=": operator.ne,
    "<=": operator.le,
    ">=": operator.ge,
    "<": operator.lt,
    ">": operator.gt,
}
FORM = "VALUE == WORD, VALUE != WORD, or VALUE < NUMBER (also <=, >, >=); a VALUE is a name, or arithmetic on names"
_COMPARISON = re.compile(r"\s*([^=!<>]+?)\s*(==|!=|<=|>=|<|>)\s*([^=!<>]*?)\s*")
_NAME = re.compile(r"\{([A-Za-z_]\w*)\}")


@dataclass(frozen=True)
class StudyCondition:
    """A comparison of a value of the trial with a word or a number."""

    left: str  # a name, or arithmetic on names and numbers
    operation: str  # one of `OPERATIONS`
    right: str  # a word or a number

    @staticmethod
    def read(text: str) -> StudyCondition:
        """Of its text. Raises ValueError if it is none."""
        match = _COMPARISON.fullmatch(text)
        if match is None:
            raise ValueError(f"{text!r} is no condition: {FORM}")
        left, operation, right = match.groups()
        condition = StudyCondition(left, operation, right.strip("'\""))
        try:
            condition.names()
        except BadExpression:
            raise ValueError(f"{left!r} in {text!r} cannot be read: {FORM}") from None
        if operation not in ("==", "!=") and _number(condition.right) is None:
            raise ValueError(f"{right!r} in {text!r} is no number: {operation} compares numbers")
        return condition

    def names(self) -> list[str]:
        """Names that it asks for."""
        return list(names_in(_expression(self.left)))

    def holds(self, values: Mapping[str, Any]) -> bool:
        """Whether it is so; a number that is not known (of a step that was not done) is neither less nor greater."""
        missing = [name for name in self.names() if values.get(name) in (None, "")]
        left = "" if missing else substitute(_expression(self.left), values)
        number, other = _number(left), _number(self.right)
        if number is not None and other is not None:
            return OPERATIONS[self.operation](number, other)
        if self.operation in ("==", "!="):
            return OPERATIONS[self.operation](text_of(left), self.right)
        return False

    def __str__(self) -> str:
        return f"{self.left} {self.operation} {self.right}"


def filled(text: str, values: Mapping[str, Any]) -> str:
    """A text with its `{name}` replaced by values; names that there are not stay as they are."""
    return _NAME.sub(lambda match: text_of(values[match[1]]) if match[1] in values else match[0], text)


def unknown_names(text: str, known: Iterable[str]) -> list[str]:
    """What is to be said of the `{name}` in a text that mean nothing."""
    names = list(known)
    return [f"there is no {{{name}}}{of_those(name, names)}" for name in _NAME.findall(text) if name not in names]


def _expression(text: str) -> str:
    return "${" + text + "}"


def _number(value: Any) -> float | None:
    if isinstance(value, bool):
        return None
    try:
        return float(value)
    except (TypeError, ValueError):
        return None
