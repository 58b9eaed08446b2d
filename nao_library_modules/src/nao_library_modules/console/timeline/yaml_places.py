"""Edits of a YAML text at places in it: all that is not meant stays as it is, comments and quotes included. Pure."""

from __future__ import annotations

import copy
import json
import re
from dataclasses import dataclass
from typing import Any, Tuple, Union

import yaml

from naoqi.errors import NaoError

from ...behaviors.behavior_errors import BehaviorError
from ...behaviors.strict_yaml import compose, dump_line, load

Place = Tuple[Union[str, int], ...]
"""Keys and positions, counted from 0, from the outermost value inwards."""


class EditRefused(NaoError):
    """A text cannot be edited so; it tells why, and what to do instead."""


@dataclass(frozen=True)
class _Cut:
    """Characters `start` to `end` of a text become `text`."""

    start: int
    end: int
    text: str


def value_at(content: Any, place: Place) -> Any:
    """A value inside another. Raises EditRefused if there is none at that place."""
    try:
        for part in place:
            content = content[part]
    except (KeyError, IndexError, TypeError):
        raise EditRefused(f"there is nothing at {'/'.join(map(str, place))}: the text has changed") from None
    return content


def set_value(text: str, place: Place, value: Any) -> str:
    """Give a place another value; a key that is not there is added behind the others."""
    content = _plain(load(text, "text"))
    if place and isinstance(place[-1], str) and value_at(content, place[:-1]) is None:
        _put(content, place[:-1], {place[-1]: value})
    else:
        value_at(content, place[:-1])[place[-1]] = value
    return _applied(text, _set_cuts(text, _root(text), place, value), content)


def delete_key(text: str, place: Place) -> str:
    """Remove a key from a mapping."""
    content = _plain(load(text, "text"))
    value_at(content, place)
    del value_at(content, place[:-1])[place[-1]]
    return _applied(text, _delete_key_cuts(text, _node(_root(text), place[:-1]), place[-1]), content)


def insert_item(text: str, place: Place, index: int, value: Any) -> str:
    """Put a value into a list, in front of the one at `index`, or behind all."""
    content = _plain(load(text, "text"))
    value_at(content, place).insert(index, value)
    written = _Written(_step_text(value), _scalar_text(value))
    return _applied(text, _insert_cuts(text, _sequence(text, place), index, written), content)


def delete_item(text: str, place: Place) -> str:
    """Remove a value from a list, which keeps others. Raises EditRefused if it is the only one."""
    content = _plain(load(text, "text"))
    items, index = value_at(content, place[:-1]), place[-1]
    value_at(content, place)
    if len(items) == 1:
        raise EditRefused("it is the only step of its group: delete the group, or put another step in before")
    del items[index]
    return _applied(text, _delete_item_cuts(text, _sequence(text, place[:-1]), int(index)), content)


def move_item(text: str, source: Place, target: Place, index: int) -> str:
    """Take a value out of a list and put it into one, in front of that which is at `index` now, or behind all.

    It keeps its text. Raises EditRefused if it would be inside of itself, or leave an empty list behind.
    """
    content = _plain(load(text, "text"))
    place, position = source[:-1], int(source[-1])
    if target[: len(source)] == source:
        raise EditRefused("a step cannot be moved into itself")
    here, there = value_at(content, place), value_at(content, target)
    moved = value_at(content, source)
    if place == target and index in (position, position + 1):
        return text
    if place != target and len(here) == 1:
        raise EditRefused("it is the only step of its group: delete the group, or put another step in before")
    there.insert(index, moved)
    del here[position + (place == target and index <= position)]
    root = _root(text)
    from_node, to_node = _node(root, place), _node(root, target)
    item = from_node.value[position]
    written = _Written(_raw_block(text, from_node, item), _scalar_text(moved))
    if to_node.flow_style and isinstance(item, yaml.CollectionNode) and item.flow_style:
        written = _Written(written.block, text[item.start_mark.index : item.end_mark.index])
    cuts = _insert_cuts(text, to_node, index, written) + _delete_item_cuts(text, from_node, position)
    return _applied(text, cuts, content)


# --- nodes ------------------------------------------------------------------------------------------------------------


def _root(text: str) -> yaml.Node:
    root = compose(text, "text")
    if root is None:
        raise EditRefused("the text is empty")
    return root


def _node(node: yaml.Node, place: Place) -> Any:
    for part in place:
        if isinstance(node, yaml.MappingNode):
            found = [value for key, value in node.value if key.value == part]
        else:
            found = node.value[part : part + 1] if isinstance(part, int) and node.value else []  # type: ignore[misc]
        if not found:
            raise EditRefused(f"there is nothing at {'/'.join(map(str, place))}: the text has changed")
        node = found[0]
    return node


def _sequence(text: str, place: Place) -> yaml.SequenceNode:
    node = _node(_root(text), place)
    if not isinstance(node, yaml.SequenceNode):
        raise EditRefused(f"{'/'.join(map(str, place))} is no list")
    return node


def _end(text: str, node: yaml.Node) -> int:
    """Where the last character of a node's own text ends: nodes of several lines end at what comes next."""
    if isinstance(node, yaml.CollectionNode) and not node.flow_style and node.value:
        last = node.value[-1]
        return _end(text, last[1] if isinstance(last, tuple) else last)
    start, end = node.start_mark.index, node.end_mark.index
    return max(start, len(text[:end].rstrip())) if isinstance(node, yaml.ScalarNode) and start < end else end


def _line_end(text: str, place: int) -> int:
    """Place of the end of a line, in front of its newline."""
    end = text.find("\n", place)
    return len(text) if end < 0 else end


def _line_start(text: str, place: int) -> int:
    return text.rfind("\n", 0, place) + 1


def _dashes(text: str, node: yaml.SequenceNode) -> list[int]:
    """Places of the dashes of a list in block style."""
    column = node.start_mark.column
    dashes = [node.start_mark.index]
    pattern = re.compile(rf"^ {{{column}}}-(?=\s)", re.M)
    for before, item in zip(node.value, node.value[1:]):
        found = pattern.search(text, _line_end(text, _end(text, before)), item.start_mark.index)
        if found is None:
            raise EditRefused("this list is written in a way that can only be edited as text")
        dashes.append(found.end() - 1)
    return dashes


def _begins_line(text: str, place: int) -> bool:
    return not text[_line_start(text, place) : place].strip()


# --- texts of values --------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class _Written:
    """A value as text, for a list in block style (further lines are indented from its first character) and in flow."""

    block: str
    flow: str


def _scalar_text(value: Any, style: str | None = None) -> str:
    """A value as it may stand anywhere, in one line. `style`: quotes of the value before."""
    if isinstance(value, str) and (style == '"' or "\n" in value):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, str):
        return dump_line([value])[1:-1]
    return dump_line(value)


def _step_text(value: Any) -> str:
    """A value for a list in block style: a mapping with one key, as most steps are, has no braces around it."""
    if isinstance(value, dict) and len(value) == 1:
        ((key, inner),) = value.items()
        return f"{_scalar_text(key)}: {_scalar_text(inner)}"
    if isinstance(value, dict) and any(isinstance(each, list) and each for each in value.values()):
        return "\n".join(_lines(value))
    return _scalar_text(value)


def _lines(value: dict[str, Any]) -> list[str]:
    lines = []
    for key, inner in value.items():
        if isinstance(inner, list) and inner and all(isinstance(each, dict) for each in inner):
            lines.append(f"{key}:")
            lines += [f"  - {_scalar_text(each)}" for each in inner]
        else:
            lines.append(f"{key}: {_scalar_text(inner)}")
    return lines


def _raw_block(text: str, sequence: yaml.SequenceNode, item: yaml.Node) -> str:
    """The text of an item, with its further lines indented from its first character."""
    start, end = item.start_mark.index, _end(text, item)
    column = item.start_mark.column
    first, *others = text[start:end].split("\n")
    return "\n".join([first, *(_dedented(line, column) for line in others)])


def _dedented(line: str, count: int) -> str:
    blanks = len(line) - len(line.lstrip(" "))
    return line[min(count, blanks) :]


def _indented(block: str, column: int) -> str:
    first, *others = block.split("\n")
    return "\n".join([first, *(" " * column + line if line.strip() else line for line in others)])


# --- cuts -------------------------------------------------------------------------------------------------------------


def _set_cuts(text: str, root: yaml.Node, place: Place, value: Any) -> list[_Cut]:
    parent = _node(root, place[:-1])
    key = place[-1]
    if isinstance(parent, yaml.ScalarNode):  # a mapping without anything in it
        start, end = parent.start_mark.index, parent.end_mark.index
        blank = " " if start == end else ""
        return [_Cut(start, end, f"{blank}{{{_scalar_text(key)}: {_scalar_text(value)}}}")]
    if isinstance(parent, yaml.SequenceNode):
        return [_replaced(text, None, parent.value[int(key)], value)]
    for name, node in parent.value:
        if name.value == key:
            return [_replaced(text, name, node, value)]
    entry = f"{_scalar_text(key)}: {_scalar_text(value)}"
    if parent.flow_style:
        if not parent.value:
            return [_Cut(parent.start_mark.index + 1, parent.end_mark.index - 1, entry)]
        end = _end(text, parent.value[-1][1])
        return [_Cut(end, end, f", {entry}")]
    end = _line_end(text, _end(text, parent))
    return [_Cut(end, end, f"\n{' ' * parent.value[0][0].start_mark.column}{entry}")]


def _replaced(text: str, key: yaml.Node | None, node: yaml.Node, value: Any) -> _Cut:
    start, end = node.start_mark.index, _end(text, node)
    style = node.style if isinstance(node, yaml.ScalarNode) else None
    written = _scalar_text(value, style)
    if key is not None and (start == end or (isinstance(node, yaml.CollectionNode) and not node.flow_style)):
        start = text.index(":", key.end_mark.index) + 1
        return _Cut(start, max(end, start), f" {written}")
    return _Cut(start, end, written)


def _delete_key_cuts(text: str, parent: yaml.MappingNode, key: Any) -> list[_Cut]:
    position = [name.value for name, _ in parent.value].index(key)
    name, node = parent.value[position]
    start, end = name.start_mark.index, _end(text, node)
    if len(parent.value) == 1:
        return [_Cut(parent.start_mark.index, _end(text, parent), "{}")]
    last = position == len(parent.value) - 1
    if parent.flow_style:
        if last:
            return [_Cut(_end(text, parent.value[position - 1][1]), end, "")]
        return [_Cut(start, parent.value[position + 1][0].start_mark.index, "")]
    if _begins_line(text, start):
        return [_whole_lines(text, start, end)]
    return [_Cut(start, parent.value[position + 1][0].start_mark.index, "")]


def _whole_lines(text: str, start: int, end: int) -> _Cut:
    after = _line_end(text, end)
    begin = _line_start(text, start)
    if after < len(text):
        return _Cut(begin, after + 1, "")
    return _Cut(max(begin - 1, 0), after, "")  # the last line, without a newline


def _insert_cuts(text: str, node: yaml.SequenceNode, index: int, written: _Written) -> list[_Cut]:
    items = node.value
    if node.flow_style:
        if not items:
            return [_Cut(node.start_mark.index + 1, node.end_mark.index - 1, written.flow)]
        if index < len(items):
            start = items[index].start_mark.index
            return [_Cut(start, start, f"{written.flow}, ")]
        end = _end(text, items[-1])
        return [_Cut(end, end, f", {written.flow}")]
    column = node.start_mark.column
    entry = f"- {_indented(written.block, column + 2)}"
    dashes = _dashes(text, node)
    if index >= len(items):
        end = _line_end(text, _end(text, items[-1]))
        return [_Cut(end, end, f"\n{' ' * column}{entry}")]
    place = dashes[index]
    if not _begins_line(text, place):
        return [_Cut(place, place, f"{entry}\n{' ' * column}")]
    place = _comments_above(text, _line_start(text, place), column)
    return [_Cut(place, place, f"{' ' * column}{entry}\n")]


def _comments_above(text: str, start: int, column: int) -> int:
    """Where the comments right above a line begin that are indented as it is: they are about it."""
    while start:
        above = _line_start(text, start - 1)
        line = text[above : start - 1]
        if not (line.strip().startswith("#") and len(line) - len(line.lstrip()) == column):
            break
        start = above
    return start


def _delete_item_cuts(text: str, node: yaml.SequenceNode, index: int) -> list[_Cut]:
    items = node.value
    item = items[index]
    last = index == len(items) - 1
    if node.flow_style:
        if last:
            return [_Cut(_end(text, items[index - 1]), _end(text, item), "")]
        return [_Cut(item.start_mark.index, items[index + 1].start_mark.index, "")]
    dashes = _dashes(text, node)
    if _begins_line(text, dashes[index]):
        return [_whole_lines(text, dashes[index], _end(text, item))]
    return [_Cut(dashes[index], dashes[index + 1], "")]


def _applied(text: str, cuts: list[_Cut], expected: Any) -> str:
    """The text with its cuts. Raises EditRefused if it does not have the values then that it is to have."""
    for cut in sorted(cuts, key=lambda cut: (cut.start, cut.end), reverse=True):
        text = text[: cut.start] + cut.text + text[cut.end :]
    try:
        same = _plain(load(text, "text")) == _plain(expected)
    except BehaviorError:
        same = False
    if not same:
        raise EditRefused("this place is written in a way that can only be edited as text")
    return text


def _plain(content: Any) -> Any:
    if isinstance(content, dict):
        return {key: _plain(each) for key, each in content.items()}
    if isinstance(content, list):
        return [_plain(each) for each in content]
    return copy.copy(content)


def _put(content: Any, place: Place, value: Any) -> None:
    value_at(content, place[:-1])[place[-1]] = value
