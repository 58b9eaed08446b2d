"""Rules that resolve designators: they turn a description into a command or a plan, by patterns and small functions.

    @rule(action, type="opening", gripper=one_of("left", "right"))
    def opening(gripper):
        return Command("manipulation", "open_gripper", side=gripper)

A rule matches when every key of its pattern does; other keys do not matter. Among the matching rules the highest
priority comes first, then the most specific, then the one added last: a user's rule precedes ours. A rule returns
solutions, in its order; those of the next rule follow. What words mean in numbers is in `config/process_modules.yaml`.
"""

from __future__ import annotations

import inspect
import threading
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, fields
from functools import lru_cache
from numbers import Real
from pathlib import Path
from typing import Any, Dict, Tuple

import yaml

from naoqi.errors import NaoError

from ...core.errors import did_you_mean
from ...core.fields import limit
from ...core.files import config_file
from ..failures import DesignatorError, PlanError, short_repr
from .designator import KINDS, Designator, plain_key

# --- numbers ----------------------------------------------------------------------------------------------------------

FILE = config_file("process_modules.yaml")


@dataclass(frozen=True)
class Settings:
    """What words of designators mean in numbers: lengths in m, times in s, angles in rad."""

    gripper: Dict[str, float]  # openings 0..1 by word: open, closed
    gripper_tolerance: float  # of the opening
    gripper_time: float  # of a motion
    head: Dict[str, Tuple[float, float]]  # (yaw, pitch) by word, as forward
    head_speed: float  # rad/s
    head_tolerance: float
    camera: Dict[str, float]  # on the head, see `objects_and_locations.head_angles`: forward, up, neck, tilt
    arm_targets: Dict[str, Tuple[float, float, float]]  # of the left hand by word, in the torso frame; right: mirrored
    arm_speed: float  # rad/s
    arm_tolerance: float  # of the hand
    shoulder: Tuple[float, float, float]  # the left one, in the torso frame
    pointing_reach: float  # from the shoulder to the hand that points
    shortest_motion: float
    stable: Dict[str, float]  # angles of all joints of the stable pose
    stable_time: float  # of the motion there
    eyes: float  # above the torso's frame
    robot_radius: float  # around the middle of the robot, has to be free
    robot_height: float  # above the floor, has to be free up to there
    eye_height: float  # above the floor, of a standing robot
    near_distance: float  # from the edge of a thing that a place is near to
    seeing_distances: Tuple[float, ...]  # to look at things from, in order of preference
    steepest_look: float  # downward, of the top camera with the head fully bowed
    shoulder_height: float  # above the floor, of a standing robot
    shoulder_aside: float  # from the middle of the robot
    reaching_distances: Tuple[float, ...]  # of things ahead, in order of preference
    longest_reach: float  # from a shoulder to the hand
    walk_tolerance: Tuple[float, float]  # m and rad at the target
    walk_speed: Tuple[float, float]  # m/s and rad/s at least: with the distance, the time limit of a walk


def load_settings(file: Path | str = FILE) -> Settings:
    """Read settings. Raises NaoError if the file cannot be read, or a key is unknown or missing."""
    path = Path(file)
    try:
        content = yaml.safe_load(path.read_text(encoding="utf-8"))
    except (OSError, yaml.YAMLError) as error:
        raise NaoError(f"{path.name}: cannot be read: {error}") from error
    if not isinstance(content, Mapping):
        raise NaoError(f"{path.name}: is {content!r}, not keys and values")
    names = [field.name for field in fields(Settings)]
    unknown = [key for key in content if key not in names]
    missing = [name for name in names if name not in content]
    if unknown or missing:
        problems = [f"unknown {key!r}{did_you_mean(str(key), names)}" for key in unknown]
        problems += [f"missing {', '.join(missing)}"] * bool(missing)
        raise NaoError(f"{path.name}: {'; '.join(problems)} (keys are {', '.join(names)})")
    return Settings(**{name: _tuples(content[name]) for name in names})


@lru_cache(maxsize=None)
def numbers_of_nao() -> Settings:
    """Settings of the package, for rules without a robot; read once."""
    return load_settings()


def _tuples(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {key: _tuples(inner) for key, inner in value.items()}
    return tuple(value) if isinstance(value, list) else value


# --- patterns ---------------------------------------------------------------------------------------------------------

SETTING = limit("setting")


class Mismatch(Exception):  # caught by the matcher
    """A value does not match a pattern; the text names what would."""


@dataclass(frozen=True)
class Pattern:
    """A pattern for a value."""

    wanted: str
    take: Callable[[Any], Any]  # converts the value to what the rule receives; raises Mismatch
    default: Any = ...  # for an absent key; a key without a default is required
    exact: int = 1  # specificity: more specific rules are tried first

    def or_else(self, default: Any) -> Pattern:
        """The same pattern, for an optional key."""
        return Pattern(f"{self.wanted}, or nothing for {default!r}", self.take, default, self.exact)


def taken(pattern: Pattern, value: Any) -> Any:
    """What a pattern makes of a value outside of rules. Raises PlanError if it does not match."""
    try:
        return pattern.take(value)
    except Mismatch:
        raise PlanError(f"{value!r} is not {pattern.wanted}") from None


def anything() -> Pattern:
    return Pattern("anything", lambda value: value, exact=0)


def text() -> Pattern:

    def take(value: Any) -> str:
        if not isinstance(value, str) or not value.strip():
            raise Mismatch
        return value

    return Pattern("a text", take)


def number(lowest: float = SETTING.lowest, highest: float = SETTING.highest, unit: str = "") -> Pattern:
    ends = "" if (lowest, highest) == SETTING[:2] else f" from {lowest:g} to {highest:g}"

    def take(value: Any) -> float:
        if not isinstance(value, Real) or isinstance(value, bool) or not lowest <= value <= highest:
            raise Mismatch
        return float(value)

    return Pattern(f"a number{ends}{' ' + unit if unit else ''}", take)


def numbers(count: int, unit: str = "") -> Pattern:
    """A tuple of that many numbers; also from a mapping of x, y and z."""

    def take(value: Any) -> tuple[float, ...]:
        if isinstance(value, Mapping):
            value = [value[axis] for axis in "xyz" if axis in value]
        try:
            listed = tuple(float(each) for each in value)
        except (TypeError, ValueError, OverflowError):
            raise Mismatch from None
        if len(listed) != count or not all(SETTING.lowest <= each <= SETTING.highest for each in listed):
            raise Mismatch
        return listed

    return Pattern(f"{count} numbers{' in ' + unit if unit else ''}", take)


def one_of(*values: Any) -> Pattern:
    """One of some values; texts match in any case, with - and _ for spaces."""

    def take(value: Any) -> Any:
        for each in values:
            if value == each or (isinstance(value, str) and isinstance(each, str) and plain(value) == plain(each)):
                return each
        raise Mismatch

    return Pattern(" or ".join(map(repr, values)), take, exact=2 if len(values) == 1 else 1)


def described(kind: str) -> Pattern:

    def take(value: Any) -> Designator:
        if not isinstance(value, Designator) or value.kind != kind:
            raise Mismatch
        return value

    return Pattern(f"a designator of a{'n' if kind[0] in 'ao' else ''} {kind}", take)


def as_pattern(value: Any) -> Pattern:
    """A pattern; a plain value matches itself."""
    return value if isinstance(value, Pattern) else one_of(value)


def plain(words: str) -> str:
    """Words as they are compared: "To_Open" and "to open" are alike."""
    return " ".join(words.replace("_", " ").replace("-", " ").lower().split())


MOST_SHOWN = 4
DESIG = "desig"


@dataclass(frozen=True)
class Command:
    """A command of a process module: the solution of an action or a motion."""

    module: str
    name: str
    arguments: Mapping[str, Any] = field(default_factory=dict)

    def __str__(self) -> str:
        inside = ", ".join(f"{name}={short_repr(value)}" for name, value in self.arguments.items())
        return f"{self.module}: {self.name}({inside})"


def command(module: str, name: str, /, **arguments: Any) -> Command:
    """A command with its arguments by name."""
    return Command(module, name, arguments)


@dataclass(frozen=True)
class Rule:
    """A rule, as described at the top of this file.

    Attributes:
        solve: Receives the keys that its arguments are named after, and the designator as `desig`.
        solution, several, or None.
    """

    name: str
    kind: str
    patterns: Mapping[str, Pattern]
    solve: Callable[..., Any]
    priority: int = 0

    def __post_init__(self) -> None:
        for argument in self._arguments():
            if argument not in self.patterns and argument != DESIG:
                keys = ", ".join([*self.patterns, DESIG])
                raise PlanError(f"the rule {self.name!r}: its argument {argument} is none of its keys {keys}")

    def _arguments(self) -> list[str]:
        return list(inspect.signature(self.solve).parameters)

    def solutions(self, desig: Designator, values: Mapping[str, Any]) -> Iterable[Any]:
        """What it returns for a matching designator; `values` are those of `match`."""
        known = {**values, DESIG: desig}
        return _several(self.solve(**{name: known[name] for name in self._arguments()}))

    @property
    def exact(self) -> int:
        return sum(pattern.exact for pattern in self.patterns.values())

    def match(self, desig: Designator) -> dict[str, Any]:
        """The values of its keys; Mismatch with the key and what it wants."""
        values = {}
        for key, pattern in self.patterns.items():
            if key not in desig:
                if pattern.default is ...:
                    raise Mismatch(f"{key} is missing: {pattern.wanted}")
                values[key] = pattern.default
                continue
            try:
                values[key] = pattern.take(desig[key])
            except Mismatch:
                raise Mismatch(f"{key} is {short_repr(desig[key])}, not {pattern.wanted}") from None
        return values

    def keys_that_fit(self, desig: Designator) -> int:
        """Specificity of the matching keys, which ranks rules that nearly match."""
        fit = 0
        for key, pattern in self.patterns.items():
            try:
                if key in desig:
                    pattern.take(desig[key])
                    fit += pattern.exact
            except Mismatch:
                pass
        return fit


class Rules:
    """A set of rules; safe to use from any thread."""

    def __init__(self) -> None:
        self._rules: tuple[Rule, ...] = ()
        self._lock = threading.Lock()

    def add(self, new: Rule) -> Rule:
        """Add a rule; it replaces one of the same name and kind."""
        if new.kind not in KINDS:
            raise PlanError(f"the rule {new.name}: designators are of the kinds {', '.join(KINDS)}, not {new.kind!r}")
        with self._lock:
            others = [rule for rule in self._rules if (rule.name, rule.kind) != (new.name, new.kind)]
            self._rules = tuple(sorted([new, *others], key=lambda rule: (-rule.priority, -rule.exact)))
        return new

    def remove(self, old: Rule) -> None:
        with self._lock:
            self._rules = tuple(rule for rule in self._rules if rule is not old)

    def of(self, kind: str) -> list[Rule]:
        """Rules for a kind of designator, in the order in which they are tried."""
        return [rule for rule in self._rules if rule.kind == kind]

    def solutions(self, desig: Designator) -> Iterator[Any]:
        """Solutions of all matching rules.

        Raises DesignatorError if no rule matches; the text names the nearest, and the key on which each failed.
        """
        rules, misses = self.of(desig.kind), []
        for rule in rules:
            try:
                values = rule.match(desig)
            except Mismatch as mismatch:
                misses.append((rule, str(mismatch)))
                continue
            yield from rule.solutions(desig, values)
        if len(misses) == len(rules):
            raise DesignatorError(desig, _no_match(desig, misses))


RULES = Rules()
"""Those of this package, and what users add."""
Designator.by_rules = RULES.solutions


def rule(
    kind: str | tuple[str, ...],
    keys: Mapping[str, Any] | None = None,
    *,
    priority: int = 0,
    called: str = "",
    rules: Rules = RULES,
    **patterns: Any,
) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Register a function as a rule.

    Args:
        kind: Of designators; several in a tuple.
        keys: Patterns for keys with the name of an argument of this function, as `priority`.
        priority: The highest is tried first.
        called: Name in messages; default: the function's.
        patterns: By key: a pattern (see `patterns`), or a value to be equal to.
    """

    def add(solve: Callable[..., Any]) -> Callable[..., Any]:
        wanted = {plain_key(key): as_pattern(value) for key, value in {**(keys or {}), **patterns}.items()}
        for each in (kind,) if isinstance(kind, str) else kind:
            rules.add(Rule(called or solve.__name__.replace("_", " ").strip(), each, wanted, solve, priority))
        return solve

    return add


def _several(solved: Any) -> Iterable[Any]:
    if solved is None:
        return ()
    return solved if isinstance(solved, (list, tuple, Iterator)) else (solved,)


def _no_match(desig: Designator, misses: list[tuple[Rule, str]]) -> str:
    if not misses:
        return f"no rules for {desig.kind}s: import process_modules.action_rules, which has those of a NAO"
    near = sorted(misses, key=lambda miss: -miss[0].keys_that_fit(desig))[:MOST_SHOWN]
    nearest = "; ".join(f"rule {rule.name!r}: {miss}" for rule, miss in near)
    more = f" ({len(misses) - len(near)} more)" if len(misses) > len(near) else ""
    return f"no rule fits: {nearest}{more}"
