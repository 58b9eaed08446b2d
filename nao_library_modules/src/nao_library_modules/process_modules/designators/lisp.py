"""Designators in Lisp notation: `(an action (type opening) (gripper left))`. Pure.

Two forms are read. CRAM's begins with a quantifier and a kind, followed by pairs. The other has pairs alone, as in
`(type: action (name: (to open)) (side: left))`: there the first key and value may stand without brackets of their own.
Colons before or after a word and the package of `desig:an` are ignored. Pairs behind the words of a name, within its
brackets, as in `(name: (to open) (side: left))`, are read as if they stood behind these.
"""

from __future__ import annotations

import re
from typing import Any

from ..language.failures import PlanError
from ..language.short_text import short_repr

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
