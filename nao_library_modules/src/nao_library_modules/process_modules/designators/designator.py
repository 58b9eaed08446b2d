"""Designators: descriptions of actions, motions, places and things, resolved when they are needed.

    an(action, type="opening", gripper="left")
    a(location, near=the(object_, type="table"), distance=0.4)
    designator({"type": "action", "name": "to open", "side": "left"})     # as a list of keys and values, or as text

`reference` resolves a description by rules, and keeps that answer. When it does not work, `next_solution` gives the
next designator of the same thing. Designators of the same thing are equated: `current_desig` is the newest one,
`first_desig` the first.

Text may be Lisp, in two forms. CRAM's begins with a quantifier and a kind, followed by pairs:
`(an action (type opening) (gripper left))`. The other has pairs alone, as in
`(type: action (name: (to open)) (side: left))`: there the first key and value may stand without brackets of their own.
Colons before or after a word and the package of `desig:an` are ignored. Pairs behind the words of a name, within its
brackets, as in `(name: (to open) (side: left))`, are read as if they stood behind these.
"""

from __future__ import annotations

import itertools
import re
import threading
import time
from collections.abc import Callable, Iterator
from typing import Any, ClassVar, Iterable, Mapping, Union

import yaml

from ...core.fields import limit
from ...core.yaml_values import Budget, load_within
from ..failures import DesignatorError, MadeToBeUsed, PlanError, short_repr, use_all

KINDS = ("action", "motion", "location", "object")
QUANTIFIERS = ("a", "the", "all")
LONGEST, MOST_VALUES, DEEPEST = (
    int(limit(f"designator {what}").highest) for what in ("characters", "values", "levels")
)
BITS = 64
"""Of whole numbers in texts: others are no numbers of a robot, and no float is as large."""
Description = Union[Mapping[str, Any], Iterable[Any], str]


class Designator(MadeToBeUsed):
    """A description of one kind of thing.

    Designators do not change: copies, merges and next solutions are new ones. Two designate the same thing if they were
    equated (`desig_equal`); `==` is Python's own.

    Attributes:
        description: Keys and values; values may be designators. - in keys becomes _.
        parent: The one it was equated to; None at the first of a chain.
        successor: The one equated to it last; None at the newest.
        timestamp: When it was resolved, s since the epoch; None before.

    Args:
        quantifier: "a" for any match, "the" for the only one, "all" for all.
        resolve: Gives the solutions one by one; default: by the rules.
    """

    by_rules: ClassVar[Callable[[Designator], Iterable[Any]]]
    """Set by `rules`, which imports this module."""

    def __init__(
        self,
        kind: str,
        description: Mapping[str, Any],
        quantifier: str = "a",
        resolve: Callable[[Designator], Iterable[Any]] | None = None,
    ) -> None:
        if kind not in KINDS:
            raise PlanError(f"a designator of kind {kind!r}: {', '.join(KINDS)}")
        if quantifier not in QUANTIFIERS:
            raise PlanError(f"a designator with quantifier {quantifier!r}: {', '.join(QUANTIFIERS)}")
        self.kind = kind
        self.description = {plain_key(key): value for key, value in description.items()}
        use_all([*self.description.values()])
        self.quantifier = quantifier
        self.parent: Designator | None = None
        self.successor: Designator | None = None
        self.timestamp: float | None = None
        self._resolve = resolve
        self._lock = threading.RLock()
        self._solutions: Iterator[Any] | None = None
        self._found: list[Any] = []
        self._place = 0
        self._following: Designator | None = None

    # --- description --------------------------------------------------------------------------------------------------

    def __getitem__(self, key: str) -> Any:
        self.use()
        if plain_key(key) not in self.description:
            raise DesignatorError(self, f"no key {key!r}: it has {', '.join(self.description) or 'none'}")
        return self.description[plain_key(key)]

    def get(self, key: str, default: Any = None) -> Any:
        self.use()
        return self.description.get(plain_key(key), default)

    def __contains__(self, key: object) -> bool:
        self.use()
        return isinstance(key, str) and plain_key(key) in self.description

    def copy(self, **changes: Any) -> Designator:
        """A copy with some keys changed; None removes a key. It is not equated."""
        self.use()
        merged = {**self.description, **changes}
        kept = {key: value for key, value in merged.items() if value is not None}
        return type(self)(self.kind, kept, self.quantifier, self._resolve)

    def merge(self, other: Designator) -> Designator:
        """A designator with the keys of both.

        Raises DesignatorError if the kinds differ, or the values of a common key.
        """
        other.use()
        if other.kind != self.kind:
            raise DesignatorError(self, f"cannot be merged with {other}: the kinds differ")
        for key in self.description.keys() & other.description.keys():
            if self.description[key] != other.description[key]:
                values = f"{self.description[key]!r} and {other.description[key]!r}"
                raise DesignatorError(self, f"cannot be merged with {other}: {key} is {values}")
        return self.copy(**other.description)

    # --- solutions ----------------------------------------------------------------------------------------------------

    def reference(self) -> Any:
        """The first solution; always the same from then on. Raises DesignatorError if there is none."""
        with self._lock:
            if not self._has(self._place):
                tried = f" after {len(self._found)}" if self._found else ""
                raise DesignatorError(self, f"no solution{tried}")
            if self.timestamp is None:
                self.timestamp = time.time()
            return self._found[self._place]

    def next_solution(self) -> Designator | None:
        """A designator of the same thing whose reference is the next solution; None if there is none.

        Always the same one: parallel branches go on with one designator.
        """
        with self._lock:
            if self._following is not None:
                return self._following
            if not self._has(self._place + 1):
                return None
            following = self.copy()
            following._solutions, following._found = self._solutions, self._found
            following._lock, following._place = self._lock, self._place + 1
            following.reference()
            equate(self, following)
            self._following = following
        return following

    def solutions(self) -> Iterator[Any]:
        """All solutions from this one on, computed one by one."""
        for place in itertools.count(self._place):
            with self._lock:
                if not self._has(place):
                    return
                found = self._found[place]
            yield found

    @property
    def resolved(self) -> bool:
        return self.timestamp is not None

    def _has(self, place: int) -> bool:
        self.use()
        if self._solutions is None:
            resolve = self._resolve or Designator.by_rules
            self._solutions = itertools.islice(resolve(self), len(self._found), None)
        while len(self._found) <= place:
            try:
                self._found.append(next(self._solutions))
            except StopIteration:
                return False
            except DesignatorError:
                self._solutions = None  # the next call tries again
                raise
        return True

    # --- text ---------------------------------------------------------------------------------------------------------

    def unused(self) -> str:
        if "_found" not in vars(self) or self.kind not in (action, motion):  # without the first: it was refused
            return ""
        return f"{self!r} was made, and nothing was done with it: perform(...) carries it out"

    def __str__(self) -> str:
        self.use()
        return repr(self)

    def __repr__(self) -> str:
        inside = ", ".join(f"{key}={_shown(value)}" for key, value in self.description.items())
        quantifier = "an" if self.quantifier == "a" and self.kind[0] in "ao" else self.quantifier
        return f"{quantifier} {self.kind} ({inside})"


# --- making them ------------------------------------------------------------------------------------------------------

action, motion, location, object_ = KINDS


def a(kind: str, **description: Any) -> Designator:
    """Any match: `a(location, near=...)`, `an(action, type="opening", gripper="left")`."""
    return Designator(kind, description)


an = a


def the(kind: str, **description: Any) -> Designator:
    """The only match: `the(object_, type="ball", colour="red")`."""
    return Designator(kind, description, "the")


def all_(kind: str, **description: Any) -> Designator:
    return Designator(kind, description, "all")


def designator(description: Description, kind: str = "") -> Designator:
    """A designator from a mapping, a list of pairs, or text: YAML, or Lisp where it begins with a bracket.

    The kind is that of the argument, else the value of the key `type` if it is a kind, else action: both `{type:
    action, name: to open, side: left}` and `{type: opening, gripper: left}` are actions. Nested mappings that name a
    kind, `{location: {...}}` or `{type: location, ...}`, are designators as well. Raises PlanError if the description
    is none of these, or too large.
    """
    if isinstance(description, str):
        require_short(len(description))
        if description.lstrip().startswith("("):
            return _of_lisp(read_lisp(description, MOST_VALUES, DEEPEST), kind)
    content = _mapping(description)
    if not kind and content.get("type") in KINDS:
        kind = content.pop("type")
    return Designator(kind or action, {key: _nested(value) for key, value in content.items()})


def text_budget() -> Budget:
    """What all texts of one designator may expand to."""
    return Budget(MOST_VALUES, DEEPEST)


def require_short(characters: int) -> None:
    """Raise PlanError if the texts of a designator are too long together."""
    if characters > LONGEST:
        raise PlanError(f"designator: the text has {characters} characters: at most {LONGEST} are read")


def read_yaml(text: str, budget: Budget) -> Any:
    """The value of a YAML text, within a budget. Raises PlanError if it is not valid YAML, or too large."""
    try:
        return load_within(text, budget)
    except yaml.YAMLError as error:
        raise PlanError(f"designator: {short_repr(text)} is no YAML that is read here: {error}") from error


def _of_lisp(form: Mapping[str, Any], kind: str) -> Designator:
    pairs = {key: _lisp_value(value) for key, value in form["pairs"].items()}
    kind = kind or form["kind"] or (pairs.pop("type") if pairs.get("type") in KINDS else action)
    return Designator(kind, pairs, form["quantifier"])


def _lisp_value(value: Any) -> Any:
    if isinstance(value, list):
        return [_lisp_value(each) for each in value]
    return _of_lisp(value, "") if isinstance(value, Mapping) else _plain(value)


def plain_key(key: str) -> str:
    return key.replace("-", "_")


def _mapping(description: Description) -> dict[str, Any]:
    content: Any = description
    if isinstance(description, str):
        content = read_yaml(description, text_budget())
    try:
        content = dict(content)
    except (TypeError, ValueError):
        content = None
    if not content or not all(isinstance(key, str) for key in content):
        there = short_repr(description)
        raise PlanError(f"designator: {there} has no keys and values, as {{type: action, name: to open}} has")
    return content


def _nested(value: Any) -> Any:
    if isinstance(value, Mapping):
        if len(value) == 1:
            key, inner = next(iter(value.items()))
            if key in KINDS and isinstance(inner, Mapping):
                return designator(inner, key)
        if value.get("type") in KINDS:
            return designator(value)
        return {key: _nested(inner) for key, inner in value.items()}
    if isinstance(value, list):
        return [_nested(inner) for inner in value]
    return _plain(value)


def _plain(value: Any) -> Any:
    """A scalar; PlanError for a whole number out of range."""
    if isinstance(value, int) and value.bit_length() > BITS:
        raise PlanError(f"designator: a whole number has {value.bit_length()} bits: at most {BITS} are read")
    return value


# --- chains -----------------------------------------------------------------------------------------------------------

_chains = threading.Lock()


def equate(parent: Designator, successor: Designator) -> Designator:
    """Declare that two designators stand for the same thing, and that the second is newer; returns the second."""
    use_all([parent, successor])
    if parent.kind != successor.kind:
        raise DesignatorError(successor, f"cannot be equated to {parent}: the kinds differ")
    with _chains:
        if _first(parent) is _first(successor):
            return successor
        newest, oldest = _newest(parent), _first(successor)
        newest.successor, oldest.parent = oldest, newest
    return successor


def current_desig(desig: Designator) -> Designator:
    desig.use()
    with _chains:
        return _newest(desig)


def first_desig(desig: Designator) -> Designator:
    with _chains:
        return _first(desig)


def newest_effective_designator(desig: Designator) -> Designator | None:
    """The newest designator of the same thing that has been resolved; None if none has."""
    with _chains:
        each: Designator | None = _newest(desig)
        while each is not None and not each.resolved:
            each = each.parent
        return each


def desig_equal(one: Designator, other: Designator) -> bool:
    use_all([one, other])
    with _chains:
        return _first(one) is _first(other)


def _first(desig: Designator) -> Designator:
    while desig.parent is not None:
        desig = desig.parent
    return desig


def _newest(desig: Designator) -> Designator:
    while desig.successor is not None:
        desig = desig.successor
    return desig


def _shown(value: Any) -> str:
    return f"({value})" if isinstance(value, Designator) else short_repr(value)


# --- Lisp -------------------------------------------------------------------------------------------------------------

TOKEN = re.compile(r'\s*(?:(?P<bracket>[()])|"(?P<text>(?:[^"\\]|\\.)*)"|(?P<word>[^\s()"]+))')
NUMBER, FRACTION = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?"), re.compile(r"[.eE]")
LONGEST_NUMBER = 40
"""Characters."""
LISP_QUANTIFIERS = {"a": "a", "an": "a", "the": "the", "all": "all"}


def read_lisp(text: str, values: int, levels: int) -> dict[str, Any]:
    """Keys and values of a designator: the kind under `type` with its pairs, or as one key with a mapping.

    Raises PlanError: brackets are missing or too many, it has another form, or there is too much of it.

    Args:
        values: The most words, numbers and brackets allowed.
        levels: The deepest nesting of brackets allowed.

    Returns:
        `{"quantifier": "a", "kind": "action", "pairs": {...}}`; quantifier and kind are empty where there are none.
    """
    forms = _nested_lists(text, values, levels)
    if len(forms) != 1 or not isinstance(forms[0], list):
        raise PlanError(f"designator: {short_repr(text)} is not one form in brackets")
    return _designator(forms[0], text)


def _nested_lists(text: str, values: int, levels: int) -> list[Any]:
    """Nested lists of words; numbers are converted, quoted text is a `_Quoted`."""
    stack: list[list[Any]] = [[]]
    opened: list[int] = []
    position = 0
    end = len(text.rstrip())
    while position < end:
        values -= 1
        if values < 0 or len(opened) > levels:
            raise PlanError(
                f"designator: {short_repr(text)} has {'too many values' if values < 0 else 'too many levels'}"
            )
        match = TOKEN.match(text, position)
        if match is None:
            raise PlanError(f"designator: {short_repr(text)} has an open quotation mark at {position + 1}")
        if match["bracket"] == "(":
            opened.append(match.start("bracket") + 1)
            stack.append([])
        elif match["bracket"] == ")":
            if not opened:
                raise PlanError(
                    f"designator: {short_repr(text)} has a bracket too many at {match.start('bracket') + 1}"
                )
            opened.pop()
            form = stack.pop()
            stack[-1].append(form)
        elif match["word"] is not None:
            word = match["word"].strip(":")
            if word:
                stack[-1].append(_word_value(word))
        else:
            stack[-1].append(_Quoted(re.sub(r"\\(.)", r"\1", match["text"])))
        position = match.end()
    if opened:
        raise PlanError(f"designator: {short_repr(text)}: the bracket at {opened[-1]} is not closed")
    return stack[0]


class _Quoted(str):
    """A text in quotes: neither a key nor a number."""


def _word_value(word: str) -> Any:
    if NUMBER.fullmatch(word):
        if len(word) > LONGEST_NUMBER:
            raise PlanError(
                f"designator: the number {short_repr(word)} has {len(word)} characters: {LONGEST_NUMBER} at most"
            )
        return float(word) if FRACTION.search(word) else int(word)
    return {"t": True, "nil": False}.get(word.lower(), word)


def _designator(form: list[Any], text: str) -> dict[str, Any]:
    head = [str(each).rpartition(":")[2].lower() for each in form[:2]]
    if len(form) >= 2 and head[0] in LISP_QUANTIFIERS and isinstance(form[1], str):
        return {"quantifier": LISP_QUANTIFIERS[head[0]], "kind": head[1], "pairs": _pairs(form[2:], text)}
    return {"quantifier": "a", "kind": "", "pairs": _pairs(form, text)}


def _pairs(forms: list[Any], text: str) -> dict[str, Any]:
    pairs: dict[str, Any] = {}
    rest = list(forms)
    while rest:
        entry = rest.pop(0)
        if isinstance(entry, str) and not isinstance(entry, _Quoted) and rest:
            key, values = entry, [rest.pop(0)]
        elif isinstance(entry, list) and len(entry) >= 2 and isinstance(entry[0], str):
            key, values = entry[0], entry[1:]
        else:
            raise PlanError(f"designator: {short_repr(text)}: {_as_lisp(entry)} is no key with a value")
        if str(key).lower() == "name" and all(isinstance(value, list) for value in values):
            values, rest = values[:1], [*values[1:], *rest]  # a name is one text: these are further pairs
        pairs[key.lower()] = _meant(values, text)
    return pairs


def _meant(values: list[Any], text: str) -> Any:
    """The value of a key: one value, words that are one text, or a list."""
    if len(values) == 1:
        value = values[0]
        if isinstance(value, list):
            if value and str(value[0]).rpartition(":")[2].lower() in LISP_QUANTIFIERS and len(value) >= 2:
                return _designator(value, text)
            return _meant(value, text) if value else []
        return str(value) if isinstance(value, _Quoted) else value
    if all(isinstance(value, str) for value in values):
        return " ".join(values)
    return [_meant([value], text) for value in values]


def _as_lisp(form: Any) -> str:
    return f"({' '.join(map(_as_lisp, form))})" if isinstance(form, list) else str(form)
