"""How many values a YAML text stands for: with aliases, a few lines can stand for more than any memory holds. Pure."""

from __future__ import annotations

from typing import Any

import yaml

MOST_BRACKETS = 100
"""In each other: with more, PyYAML takes a second for a few lines."""


class TooMuch(yaml.YAMLError):
    """A text stands for more than is read."""


class Budget:
    """Values that texts may stand for together, those of aliases counted each time; lists and mappings in each other.

    `values`: the most values. `levels`: the most levels.
    """

    def __init__(self, values: int, levels: int) -> None:
        self._text = f"more than {values} values, or more than {levels} levels deep"
        self._left = values
        self._levels = levels

    def take(self, node: yaml.Node, depth: int = 0) -> None:
        """Count a node and what is in it. Raises TooMuch if it is more than is left."""
        self._left -= 1
        if depth > self._levels or self._left < 0:
            raise TooMuch(self._text)
        inner: Any = node.value if isinstance(node, yaml.CollectionNode) else ()
        if isinstance(node, yaml.MappingNode):
            inner = (each for pair in inner for each in pair)
        for each in inner:
            self.take(each, depth + 1)


class ShallowLoader(yaml.SafeLoader):
    """Plain values only, and few brackets in each other."""

    def fetch_flow_collection_start(self, token: type) -> None:
        """Begin with a bracket."""
        if self.flow_level >= MOST_BRACKETS:
            raise TooMuch(f"more than {MOST_BRACKETS} brackets in each other")
        super().fetch_flow_collection_start(token)


def load_within(text: str, budget: Budget, loader: type[ShallowLoader] = ShallowLoader) -> Any:
    """The value of a text.

    `text`: YAML. `budget`: how much it may stand for. `loader`: what reads it. Raises yaml.YAMLError if it is no YAML,
    or stands for too much.
    """
    try:
        reader = loader(text)
        try:
            node = reader.get_single_node()
            if node is None:
                return None
            budget.take(node)
            return reader.construct_document(node)
        finally:
            reader.dispose()
    except (ValueError, OverflowError, RecursionError) as error:  # numbers and dates that there are not; [[[[...
        raise yaml.YAMLError(str(error)) from error
