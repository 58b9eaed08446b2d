"""What a function takes in the fields of its message, declared in its signature. Pure.

A parameter of a library function, or of its check, says by its annotation what the field of its name may hold:

    Speed = Annotated[float, number((0.1, 1.0), "fraction of the greatest speed")]

    def go_to(self, str_param: Posture, speed: Speed) -> None: ...

The check of a chain, the description of a server and the documents read this declaration. What depends on several
fields, or on the robot, is said by the check beside the function (`chain.checked_by`).
"""

from __future__ import annotations

import inspect
import itertools
import logging
import math
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, Tuple, Union

from typing_extensions import Annotated

from ..base.errors import BadGoal
from ..base.field_checks import (
    KEY_FRAMES,
    require_known,
    require_number,
    require_rising,
    require_text,
    require_usual,
    require_whole,
)
from ..base.limits import Limit, limit, usual

__all__ = ["Annotated", "Field", "fields_of", "flag", "free", "moments", "number", "numbers", "text", "whole", "word"]

log = logging.getLogger(__name__)

Bounds = Union[str, Limit, Tuple[float, float]]
"""A kind of number in config/limits.json, its limit, or the least and the greatest number."""
Question = Tuple[Any, ...]
"""NAOqi module, method, arguments."""


@dataclass(frozen=True)
class Field:
    """What one field may hold.

    Attributes:
        help: What it means to the function, in a few words.
        unit: Of its numbers; empty if they have none, or if it holds none.
        allowed: What it may hold, as a refusal says it.
        minimum: The least number; not a number if there is none.
        maximum: The greatest one, likewise.
        choices: The words that it may hold, where they are the same for all robots.
        asked: What to ask the robot for these words, where they are not.
        check: Raises BadGoal for a value that will not do; takes the name of the field and the value.
        usual: Bounds of what is usual of its numbers; of a list with several for each place, in turn. None: anything.
    """

    help: str
    unit: str = ""
    allowed: str = ""
    minimum: float = math.nan
    maximum: float = math.nan
    choices: Sequence[str] = ()
    asked: Sequence[Question] = ()
    check: Callable[[str, Any], object] | None = None
    usual: Sequence[Limit | None] = ()

    def but(self, **changes: Any) -> Field:
        """The same with some attributes changed."""
        return replace(self, **changes)

    def require(self, name: str, value: Any) -> None:
        """See that a value will do. Raises BadGoal if it will not."""
        if self.check is not None:
            self.check(name, value)

    def require_usual(self, name: str, value: Any) -> None:
        """See that a value is usual, too. Raises BadGoal if it is not."""
        values = value if isinstance(value, (list, tuple)) else [value]
        for each, bounds in zip(values, itertools.cycle(self.usual)):
            require_usual(name, each, bounds)


def free(meaning: str, unit: str = "", allowed: str = "", **more: Any) -> Field:
    """A field of which any value will do by itself; `allowed` says what the function's own check lets pass."""
    return Field(meaning, unit, allowed, **more)


def flag(meaning: str) -> Field:
    """True or false."""
    return Field(meaning)


def number(bounds: Bounds, meaning: str, unit: str = "", zero: str | None = None, allowed: str = "") -> Field:
    """A number between two others, both included.

    Args:
        bounds: The two.
        meaning: The help.
        unit: Where not that of the kind.
        zero: What 0 stands for where it is allowed beside them: ": the default"; empty: itself; None: nothing.
        allowed: In words, where not the bounds.
    """
    own = _limit(bounds, unit)
    lowest, highest, unit = own
    allowed = allowed or own.text + ("" if zero is None else f", or 0{zero}")

    def check(name: str, value: float) -> None:
        if zero is None or value != 0.0:
            require_number(name, value, lowest, highest, allowed)

    least = lowest if zero is None else min(lowest, 0.0)
    return Field(meaning, unit, allowed, least, highest, check=check, usual=_usual(bounds))


def numbers(
    bounds: Bounds, meaning: str, unit: str = "", zero: str | None = None, allowed: str = "", least: int = 0
) -> Field:
    """A list of numbers, each as `number` takes it.

    Args:
        meaning: The help.
        unit: As `number` takes it.
        zero: As `number` takes it.
        allowed: As `number` takes it.
        least: How many there are at least.
    """
    each = number(bounds, meaning, unit, zero, allowed)

    def check(name: str, values: Sequence[float]) -> None:
        if len(values) < least:
            raise BadGoal(name, list(values), f"at least {least}: {each.allowed}")
        for value in values:
            each.require(name, value)

    return each.but(check=check)


def whole(lowest: int, highest: int, meaning: str, unit: str = "") -> Field:
    """A whole number between two others, both included."""
    check = partial(require_whole, lowest=lowest, highest=highest, unit=f" {unit}".rstrip())
    return Field(meaning, unit, f"a whole number {lowest}..{highest} {unit}".rstrip(), lowest, highest, check=check)


def moments(bounds: Bounds, meaning: str, most: Limit = KEY_FRAMES, shared: bool = False) -> Field:
    """Moments that follow each other, at least one, s from the start; as `require_rising` takes them."""
    limit_of_each = _limit(bounds, "")
    allowed = f"above 0 and rising, from {limit_of_each.lowest:g} to {limit_of_each.highest:g}"

    def check(name: str, times: Sequence[float]) -> None:
        require_rising(name, times, limit_of_each, most, shared)

    lowest, highest, _ = limit_of_each
    return Field(meaning, "s", allowed, lowest, highest, check=check, usual=_usual(bounds))


def word(choices: Sequence[str], meaning: str, kind: str = "", empty: str | None = None) -> Field:
    """One of several words.

    Args:
        meaning: The help.
        kind: What they name, in words: "voice".
        empty: What no word stands for, where that is allowed: "the default"; None: it is not.
    """

    def check(name: str, value: str) -> None:
        if empty is None or value.strip():
            require_known(name, value, choices, kind)

    listed = f"one of {', '.join(choices)}"
    return Field(meaning, "", listed if empty is None else f"{listed}; empty: {empty}", choices=choices, check=check)


def text(what: str, meaning: str) -> Field:
    """A text with something in it. `what`: it in words, for refusals: "the name of a group". `meaning`: the help."""
    return Field(meaning, "", what, check=lambda name, value: require_text(name, value, what))


def _usual(bounds: Bounds) -> Sequence[Limit | None]:
    return (usual(bounds),) if isinstance(bounds, str) else ()


def _limit(bounds: Bounds, unit: str) -> Limit:
    if isinstance(bounds, str):
        bounds = limit(bounds)
    lowest, highest, *own = bounds
    return Limit(lowest, highest, unit or "".join(own))


def fields_of(function: Callable[..., Any], names: Collection[str]) -> dict[str, Field]:
    """What a callable declares of fields, in the order of its parameters.

    `function`: a function, method or other callable, wrapped or not, also with some arguments given (`partial`).
    `names`: the fields that its message has; parameters of other names are none.
    """
    return {name: field for name, field in _declared(function) if name in names}


def _declared(function: Callable[..., Any]) -> Iterator[tuple[str, Field]]:
    scope = _scope(function)
    for name, parameter in inspect.signature(function).parameters.items():
        if parameter.kind is parameter.KEYWORD_ONLY:  # it has its default, whatever the message says
            continue
        kind = parameter.annotation
        if isinstance(kind, str):
            kind = _named(kind.strip("\"'"), scope, name)
        for told in getattr(kind, "__metadata__", ()):
            if isinstance(told, Field):
                yield name, told


def _scope(function: Any) -> Mapping[str, Any]:
    """Names that the annotations of a callable refer to."""
    while isinstance(function, partial):
        function = function.func
    function = inspect.unwrap(getattr(function, "__func__", function))
    return getattr(function if inspect.isfunction(function) else type(function).__call__, "__globals__", {})


def _named(annotation: str, scope: Mapping[str, Any], parameter: str) -> Any:
    """What an annotation that is a text names; None where it names nothing that declares a field."""
    if "Annotated[" in annotation:
        log.warning("the declaration of %s is not read: give %s a name of its own in the module", parameter, annotation)
    first, *others = annotation.split(".")
    named = scope.get(first)
    for other in others:
        named = getattr(named, other, None)
    return named
