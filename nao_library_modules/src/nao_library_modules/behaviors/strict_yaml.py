"""YAML of behaviours, read strictly: no key twice, nothing endless, and every mapping knows its line."""

from __future__ import annotations

import re
from collections.abc import Hashable
from typing import Any

import yaml

from ..core.yaml_values import Budget, ShallowLoader, TooMuch, load_within
from .behavior_errors import BehaviorError, Problem

LONGEST = 4_000_000
"""Characters of a file."""
MOST_NODES = 100_000
"""Values of a file, those of aliases counted each time: a few lines can stand for more than any memory holds."""
DEEPEST = 40
"""Lists and mappings inside of each other."""
WIDTH = 110


class Mapping(dict):  # type: ignore[type-arg]
    """A mapping of a file. `line`: where it begins, counted from 1. `lines`: key -> its line."""

    line = 0
    lines: dict[Any, int] = {}


class Items(list):  # type: ignore[type-arg]
    """A list of a file.

    `line`: where it begins, counted from 1. `lines`: position, counted from 0 -> line of what stands there.
    """

    line = 0
    lines: dict[Any, int] = {}


def line_of(value: Any) -> int:
    """Line of a value of a file; 0 if it is not known."""
    return getattr(value, "line", 0)


def line_in(value: Any, key: Any) -> int:
    """Line of a key of a mapping, or of a place in a list, counted from 0; 0 if it is not known."""
    return getattr(value, "lines", {}).get(key, 0)


# YAML 1.2's: on, off, yes and no are words as any other (NaoLights has functions of these names), 1e3 is a number, and
# 1:30 and 2024-01-01 are texts.
_PLAIN = (
    ("bool", re.compile(r"true|True|TRUE|false|False|FALSE"), "tTfF"),
    ("int", re.compile(r"[-+]?[0-9]+"), "-+0123456789"),
    (
        "float",
        re.compile(
            r"[-+]?(?:\.[0-9]+|[0-9]+(?:\.[0-9]*)?)(?:[eE][-+]?[0-9]+)?|[-+]?\.(?:inf|Inf|INF)|\.(?:nan|NaN|NAN)"
        ),
        "-+0123456789.",
    ),
    ("null", re.compile(r"~|null|Null|NULL|"), ["~", "n", "N", ""]),
    ("merge", re.compile(r"<<"), "<"),
)


def _resolvers() -> dict[Any, list[tuple[str, re.Pattern[str]]]]:
    by_first: dict[Any, list[tuple[str, re.Pattern[str]]]] = {}
    for tag, pattern, firsts in _PLAIN:
        whole = re.compile(f"(?:{pattern.pattern})$")
        for first in firsts:
            by_first.setdefault(first, []).append((f"tag:yaml.org,2002:{tag}", whole))
    return by_first


class _Loader(ShallowLoader):
    """Plain values only."""

    yaml_implicit_resolvers = _resolvers()


def _mapping(loader: _Loader, node: yaml.MappingNode) -> Mapping:
    loader.flatten_mapping(node)
    mapping = Mapping()
    mapping.line, mapping.lines = node.start_mark.line + 1, {}
    for key_node, value_node in node.value:
        key = loader.construct_object(key_node, deep=True)
        if not isinstance(key, Hashable):
            raise yaml.constructor.ConstructorError(None, None, "a key is a list or a mapping", key_node.start_mark)
        if key in mapping:
            raise yaml.constructor.ConstructorError(None, None, f"the key {key!r} comes twice", key_node.start_mark)
        mapping[key] = loader.construct_object(value_node, deep=True)
        mapping.lines[key] = key_node.start_mark.line + 1
    return mapping


def _items(loader: _Loader, node: yaml.SequenceNode) -> Items:
    items = Items(loader.construct_object(each, deep=True) for each in node.value)
    items.line = node.start_mark.line + 1
    items.lines = {i: each.start_mark.line + 1 for i, each in enumerate(node.value)}
    return items


_Loader.add_constructor("tag:yaml.org,2002:map", _mapping)
_Loader.add_constructor("tag:yaml.org,2002:seq", _items)
_Loader.add_constructor("tag:yaml.org,2002:int", lambda loader, node: int(loader.construct_scalar(node), 10))


def load(text: str, name: str) -> Any:
    """The value of a text. Raises BehaviorError if it is no YAML, or too much of it."""
    if len(text) > LONGEST:
        raise BehaviorError(name, [Problem("", f"the file has {len(text)} characters: at most {LONGEST} are read")])
    try:
        return load_within(text, Budget(MOST_NODES, DEEPEST), _Loader)
    except TooMuch as error:
        raise BehaviorError(name, [Problem("", str(error))]) from error
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        problem = " ".join(str(getattr(error, "problem", None) or error).split())
        line = 0 if mark is None else mark.line + 1
        syntax = isinstance(error, (yaml.parser.ParserError, yaml.scanner.ScannerError))
        hint = "; a text with ? : , # or brackets in it needs quotes" if syntax else ""
        raise BehaviorError(name, [Problem("", f"no YAML: {problem}{hint}", line)]) from error


def compose(text: str, name: str) -> yaml.Node | None:
    """The nodes of a text, which know their places in it; None if it is empty. Raises BehaviorError as `load`."""
    load(text, name)
    return yaml.compose(text, Loader=_Loader)


class _Dumper(yaml.SafeDumper):
    """Without anchors: people read and change these files. Quotes what YAML 1.1 or 1.2 would not take for a text."""

    yaml_implicit_resolvers = {
        first: [*yaml.SafeDumper.yaml_implicit_resolvers.get(first, []), *_resolvers().get(first, [])]
        for first in {*yaml.SafeDumper.yaml_implicit_resolvers, *_resolvers()}
    }

    def ignore_aliases(self, data: Any) -> bool:
        return True


_Dumper.add_representer(Mapping, lambda dumper, value: dumper.represent_dict(value.items()))
_Dumper.add_representer(Items, lambda dumper, value: dumper.represent_list(list(value)))


def dump(value: Any) -> str:
    """A value as YAML that `load` reads as the same; short lists and mappings on a line of their own."""
    return yaml.dump(value, Dumper=_Dumper, default_flow_style=None, sort_keys=False, width=WIDTH, allow_unicode=True)


def dump_line(value: Any) -> str:
    text = yaml.dump(value, Dumper=_Dumper, default_flow_style=True, sort_keys=False, width=10**9, allow_unicode=True)
    return text.replace("\n...\n", "").strip()
