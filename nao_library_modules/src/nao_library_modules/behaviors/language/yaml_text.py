"""YAML of behaviours, read strictly: no key twice, nothing endless, and every mapping knows its line."""

from __future__ import annotations

import re
from collections.abc import Hashable
from typing import Any

import yaml

from .errors import BehaviorError, Problem

LONGEST = 4_000_000
"""Characters of a file."""
MOST_NODES = 100_000
"""Values of a file, those of aliases counted each time: a few lines can stand for more than any memory holds."""
DEEPEST = 40
"""Lists and mappings inside of each other."""
WIDTH = 110


class Mapping(dict):  # type: ignore[type-arg]
    """A mapping of a file.

    Attributes:
        line: Where it begins, counted from 1.
    """

    line = 0


def line_of(value: Any) -> int:
    """Line of a value of a file; 0 if it is not known."""
    return getattr(value, "line", 0)


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


class _Loader(yaml.SafeLoader):
    """Plain values only."""

    yaml_implicit_resolvers = _resolvers()


def _mapping(loader: _Loader, node: yaml.MappingNode) -> Mapping:
    loader.flatten_mapping(node)
    mapping = Mapping()
    mapping.line = node.start_mark.line + 1
    for key_node, value_node in node.value:
        key = loader.construct_object(key_node, deep=True)
        if not isinstance(key, Hashable):
            raise yaml.constructor.ConstructorError(None, None, "a key is a list or a mapping", key_node.start_mark)
        if key in mapping:
            raise yaml.constructor.ConstructorError(None, None, f"the key {key!r} comes twice", key_node.start_mark)
        mapping[key] = loader.construct_object(value_node, deep=True)
    return mapping


_Loader.add_constructor("tag:yaml.org,2002:map", _mapping)
_Loader.add_constructor("tag:yaml.org,2002:int", lambda loader, node: int(loader.construct_scalar(node), 10))


def load(text: str, name: str) -> Any:
    """The value of a text.

    Args:
        text: YAML.
        name: What errors call it.

    Raises:
        BehaviorError: If it is no YAML, or too much of it.
    """
    if len(text) > LONGEST:
        raise BehaviorError(name, [Problem("", f"the file has {len(text)} characters: at most {LONGEST} are read")])
    try:
        loader = _Loader(text)
        try:
            node = loader.get_single_node()
            if node is None:
                return None
            _count(node, 0, [0], name)
            return loader.construct_document(node)
        finally:
            loader.dispose()
    except (yaml.YAMLError, ValueError, OverflowError, RecursionError) as error:
        raise BehaviorError(name, [Problem("", f"no YAML: {_in_a_line(error)}")]) from error


def _count(node: yaml.Node, depth: int, nodes: list[int], name: str) -> None:
    nodes[0] += 1
    if depth > DEEPEST or nodes[0] > MOST_NODES:
        raise BehaviorError(name, [Problem("", f"more than {MOST_NODES} values, or more than {DEEPEST} levels deep")])
    if isinstance(node, yaml.SequenceNode):
        for each in node.value:
            _count(each, depth + 1, nodes, name)
    elif isinstance(node, yaml.MappingNode):
        for key, value in node.value:
            _count(key, depth + 1, nodes, name)
            _count(value, depth + 1, nodes, name)


def _in_a_line(error: Exception) -> str:
    mark = getattr(error, "problem_mark", None)
    problem = getattr(error, "problem", None) or str(error)
    where = f"line {mark.line + 1}: " if mark is not None else ""
    return where + " ".join(str(problem).split())


class _Dumper(yaml.SafeDumper):
    """Without anchors: people read and change these files. Quotes what YAML 1.1 or 1.2 would not take for a text."""

    yaml_implicit_resolvers = {
        first: [*yaml.SafeDumper.yaml_implicit_resolvers.get(first, []), *_resolvers().get(first, [])]
        for first in {*yaml.SafeDumper.yaml_implicit_resolvers, *_resolvers()}
    }

    def ignore_aliases(self, data: Any) -> bool:
        return True


_Dumper.add_representer(Mapping, lambda dumper, value: dumper.represent_dict(value.items()))


def dump(value: Any) -> str:
    """A value as YAML that `load` reads as the same; short lists and mappings on a line of their own."""
    return yaml.dump(value, Dumper=_Dumper, default_flow_style=None, sort_keys=False, width=WIDTH, allow_unicode=True)


def dump_line(value: Any) -> str:
    """A value as YAML in one line."""
    text = yaml.dump(value, Dumper=_Dumper, default_flow_style=True, sort_keys=False, width=10**9, allow_unicode=True)
    return text.replace("\n...\n", "").strip()
