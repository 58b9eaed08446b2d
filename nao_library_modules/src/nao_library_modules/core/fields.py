"""Fields of function messages: limits, checks, and declarations in signatures. Pure; every check raises BadGoal."""

from __future__ import annotations

import inspect
import itertools
import json
import logging
import math
import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from typing import Any, NamedTuple, Tuple, Union

from typing_extensions import Annotated

from naoqi.errors import NaoError

from .errors import BadGoal, did_you_mean
from .files import config_file

log = logging.getLogger(__name__)

FILE = "limits.json"


class Limit(NamedTuple):
    """Bounds of one kind of number, both included; neither is infinite."""

    lowest: float
    highest: float
    unit: str

    @property
    def text(self) -> str:
        """What is allowed, in words: "0.1..60 s"."""
        return f"{self.lowest:g}..{self.highest:g} {self.unit}".strip()


def limit(kind: str) -> Limit:
    """The bounds of a kind of number."""
    declared = _declared_limits()[kind]
    return Limit(declared["lowest"], declared["highest"], declared["unit"])


def usual(kind: str) -> Limit | None:
    """The bounds of what is usual of a kind of number, which checks before a run look at; None: all that is allowed."""
    declared = _declared_limits()[kind]
    return Limit(*declared["usual"], declared["unit"]) if "usual" in declared else None


class Row(NamedTuple):
    """A line of the table of bounds: a kind of number, its bounds, where they hold, in words, and what is usual."""

    kind: str
    lowest: float
    highest: float
    unit: str
    where: str
    usual: tuple[float, float] | None = None


def table() -> list[Row]:
    """All kinds, in the order of the file."""
    return [Row(kind, **declared) for kind, declared in _declared_limits().items()]


@lru_cache(maxsize=None)
def _declared_limits() -> dict[str, dict[str, Any]]:
    content = json.loads(config_file(FILE).read_text(encoding="utf-8"))
    return {kind: declared for kind, declared in content.items() if not kind.startswith("_")}


LONGEST_NAME = 255
"""Longest name of a file that file systems take, bytes."""
KEY_FRAMES = limit("key frames")
CONTROL = re.compile(r"[\x00-\x1f\x7f]")
"""Characters that no name has."""


def require_number(field: str, value: float, lowest: float, highest: float, allowed: str = "") -> float:
    """A number between two others, both included; `allowed` says in words what the field may hold."""
    if not lowest <= value <= highest:  # also for NaN
        raise BadGoal(field, value, allowed or f"{lowest:g}..{highest:g}")
    return float(value)


def require_within(field: str, value: float, limit: Limit, allowed: str = "") -> float:
    """A number within the declared bounds of its kind."""
    return require_number(field, value, limit.lowest, limit.highest, allowed or limit.text)


UNUSUAL = "unusual"
"""Key of a step, in behaviours, protocols and the wizard's file, that means a number which is not usual."""


def require_usual(field: str, value: float, limit: Limit | None) -> None:
    """A number within what is usual of its kind; 0, which often stands for something else, always is."""
    if limit is not None and value != 0.0 and not limit.lowest <= value <= limit.highest:
        allowed = f"usual is {limit.text}; with `{UNUSUAL}: true` beside it, it is allowed"
        raise BadGoal(field, value, allowed, problem=f"{value:g} is unusual")


def require_zero_or(field: str, value: float, limit: Limit, zero: str = "") -> float:
    """As `require_within`; 0 is allowed as well; `zero` says what it stands for: ": the default"."""
    if value == 0.0:
        return float(value)
    return require_number(field, value, limit.lowest, limit.highest, f"{limit.text}, or 0{zero}")


def require_each(field: str, values: Iterable[float], limit: Limit) -> list[float]:
    """Numbers within the declared bounds of their kind."""
    return [require_within(field, value, limit) for value in values]


def require_length(field: str, length: int, limit: Limit) -> None:
    """A list that is not too long; `length` is that of the field or of what it stands for."""
    if length > limit.highest:
        problem = " ".join(f"{length} {limit.unit} are too many".split())
        raise BadGoal(field, length, f"at most {limit.highest:.0f}", problem=problem)


def require_rising(
    field: str, times: Sequence[float], limit: Limit, most: Limit = KEY_FRAMES, shared: bool = False
) -> None:
    """Moments that follow each other, at least one.

    `times`: s from the start. `shared`: whether the same moments are for all of several joints.
    """
    require_length(field, len(times), most)
    lowest, highest, _ = limit
    rise = all(later > earlier for earlier, later in zip(times, times[1:]))
    if not times or not rise or not all(lowest <= time <= highest for time in times):
        allowed = f"s from the start, at least one, above 0 and rising, from {lowest:g} to {highest:g}"
        allowed += "; the same times are for all joints" if shared else ""
        raise BadGoal(field, list(times), allowed)


def number_parameter(name: str, value: Any, limit: Limit, also: float | None = None) -> float:
    """A number that is a parameter of a node, within the declared bounds of its kind.

    `also`: a further number that it may be. Raises NaoError if it is something else.
    """
    number = isinstance(value, (int, float)) and not isinstance(value, bool)
    if not (number and (limit.lowest <= value <= limit.highest or value == also)):
        further = "" if also is None else f", or {also:g}"
        allowed = f"{limit.lowest:g} to {limit.highest:g} {limit.unit}".strip()
        raise NaoError(f"{name} is {value!r}: {allowed}{further}")
    return float(value)


def require_count(field: str, values: Sequence[float], count: int, what: str, places: str = "") -> None:
    """So many numbers, or so many for each of several places.

    `what`: they in words, with units. `places`: what they are repeated for, in words: "step"; empty where they are not.
    """
    if not values or len(values) % count if places else len(values) != count:
        each = f" for each {places}" if places else ""
        problem = f"{count} numbers{each} are needed"
        raise BadGoal(field, list(values), f"{what}; here are {len(values)}", problem=problem)


def degrees_hint(angle: float, lower: float, upper: float) -> str:
    """Text to append where a number is no angle in rad from `lower` to `upper`, and was thought of in degrees.

    Either it is a number that people type, and would be right in degrees, or it comes from some that were typed.
    """
    turned = math.radians(angle)
    if round(angle, 2) != angle and abs(math.degrees(angle) - round(math.degrees(angle), 1)) < 1e-4:
        return f"; in degrees {math.degrees(lower):.1f} to {math.degrees(upper):.1f}"
    if abs(angle) <= math.pi or not lower <= turned <= upper:
        return ""
    return f"; {angle:g} degrees are {turned:.4f} rad"


def require_whole(field: str, value: float, lowest: int, highest: int, unit: str = "") -> int:
    """A whole number between two others, both included."""
    if not (math.isfinite(value) and value == int(value) and lowest <= value <= highest):
        raise BadGoal(field, value, f"a whole number {lowest}..{highest}{unit}")
    return int(value)


def require_known(field: str, value: str, known: Sequence[str], kind: str = "") -> str:
    """One of several words, without blanks around it; `kind` is what it names: "voice"."""
    word = value.strip()
    if word not in known:
        problem = f"{word!r} is {f'no {kind}' if kind else 'not known'}{did_you_mean(word, known)}"
        raise BadGoal(field, value, f"one of {', '.join(known)}" if known else "there is none", problem=problem)
    return word


def require_text(field: str, value: str, what: str) -> str:
    if not value.strip():
        raise BadGoal(field, value, what, problem="it is empty")
    return value.strip()


ALLOWED = 'empty or "stop", "skip", "retry N" or "retry N skip" with N from 1 to 100'
_RETRY = re.compile(r"retry +(\d{1,3})(?: +(stop|skip))?")
MOST_RETRIES = limit("retries").highest


@dataclass(frozen=True)
class FailurePolicy:
    """How often a function that fails is tried again, and whether the chain goes on without it afterwards."""

    retries: int = 0  # how often it is tried again
    skip: bool = False  # True: the chain goes on with the next function; False: the goal is aborted

    @classmethod
    def of(cls, text: str) -> FailurePolicy:
        """The policy that a text names. `text`: see `ALLOWED`. Raises BadGoal if it names none."""
        words = text.strip().lower()
        if words in ("", "stop"):
            return cls()
        if words == "skip":
            return cls(skip=True)
        match = _RETRY.fullmatch(words)
        if match is None or not 1 <= int(match[1]) <= MOST_RETRIES:
            raise BadGoal("on_error", text, ALLOWED)
        return cls(int(match[1]), match[2] == "skip")


__all__ = ["Annotated", "Field", "fields_of", "flag", "free", "moments", "number", "numbers", "text", "whole", "word"]


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
