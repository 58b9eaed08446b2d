"""Parameters of behaviours: what they may be, and values for them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from ...base.errors import BadGoal
from ...base.suggestion import did_you_mean
from .errors import BehaviorError, Problem
from .expressions import LARGEST, UNKNOWN, text_of
from .yaml_text import load

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
