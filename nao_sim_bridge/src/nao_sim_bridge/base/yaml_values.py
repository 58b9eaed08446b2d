"""Reads YAML that stands for few values: with aliases, a few lines can stand for more than any memory holds."""

from __future__ import annotations

from typing import Any

import yaml

from nao_sim_bridge.base.sizes import load_sizes

MOST_BRACKETS = 100
"""In each other: with more, PyYAML takes a second for a few lines."""

INT, LONGEST_NUMBER = "tag:yaml.org,2002:int", 40
"""Characters of a whole number: no float is as large, and Python does not print those of some thousand."""


def load_yaml(text: str) -> Any:
    """The value of a text.

    Raises:
        yaml.YAMLError: It is no YAML, or stands for more values or levels than `sizes.json` allows.
    """
    try:
        loader = _Loader(text)
        try:
            node = loader.get_single_node()
            if node is None:
                return None
            _count(node, 0, [0])
            return loader.construct_document(node)
        finally:
            loader.dispose()
    except (ValueError, OverflowError, RecursionError) as error:  # numbers and dates that there are not
        raise yaml.YAMLError(str(error)) from error


class _Loader(yaml.SafeLoader):
    """Gives up early where there is too much."""

    def __init__(self, text: str) -> None:
        super().__init__(text)
        self._nodes = 0

    def compose_node(self, parent: Any, index: Any) -> Any:
        self._nodes += 1
        _require(self._nodes, 0)
        return super().compose_node(parent, index)

    def fetch_flow_collection_start(self, token: type) -> None:
        if self.flow_level >= MOST_BRACKETS:
            raise yaml.YAMLError(f"more than {MOST_BRACKETS} brackets in each other")
        super().fetch_flow_collection_start(token)


def _count(node: yaml.Node, depth: int, values: list[int]) -> None:
    """Count a node and what is in it, what aliases stand for each time."""
    values[0] += 1
    _require(values[0], depth)
    if isinstance(node, yaml.ScalarNode) and node.tag == INT and len(node.value) > LONGEST_NUMBER:
        raise yaml.YAMLError(f"a whole number of {len(node.value)} characters")
    inner: Any = node.value if isinstance(node, yaml.CollectionNode) else ()
    if isinstance(node, yaml.MappingNode):
        inner = (each for pair in inner for each in pair)
    for each in inner:
        _count(each, depth + 1, values)


def _require(values: int, depth: int) -> None:
    sizes = load_sizes().yaml
    if values > sizes.values or depth > sizes.levels:
        raise yaml.YAMLError(f"more than {sizes.values} values, or more than {sizes.levels} levels deep")
