"""Parameters that can be changed while a node runs, described in Python: no .cfg file, no generated code."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any, Union

import rospy
from dynamic_reconfigure.server import Server

from naoqi.errors import NaoError

from ...ros.node_interface import NodeInterface

Value = Union[bool, int, float, str]

TYPES = {bool: "bool", int: "int", float: "double", str: "str"}
KINDS = {bool: "true or false", int: "a whole number", float: "a number", str: "a text"}
LOWEST: dict[type, Value] = {bool: False, int: -(2**31), float: float("-inf"), str: ""}
HIGHEST: dict[type, Value] = {bool: True, int: 2**31 - 1, float: float("inf"), str: ""}


@dataclass(frozen=True)
class ReconfigureField:
    """One parameter; its default has its type."""

    name: str
    default: Value
    description: str  # for the tools that show it
    lowest: Value | None = None  # of a number
    highest: Value | None = None
    choices: Mapping[Value, str] | None = None  # value -> its meaning, when there are only some


def description_of(fields: Sequence[ReconfigureField]) -> Any:
    """The description of parameters for `dynamic_reconfigure`, as it would be generated from a .cfg file."""
    parameters = [
        {
            "name": field.name,
            "type": TYPES[type(field.default)],
            "default": field.default,
            "level": 1 << place,
            "description": field.description,
            "min": LOWEST[type(field.default)] if field.lowest is None else field.lowest,
            "max": HIGHEST[type(field.default)] if field.highest is None else field.highest,
            "edit_method": _choices(field),
        }
        for place, field in enumerate(fields)
    ]
    group = {"name": "Default", "id": 0, "parent": 0, "type": "", "state": True, "groups": [], "parameters": parameters}
    columns = {key: {each["name"]: each[key] for each in parameters} for key in ("default", "min", "max")}
    return SimpleNamespace(
        config_description=group, defaults=columns["default"], min=columns["min"], max=columns["max"]
    )


def serve(
    node: NodeInterface,
    fields: Sequence[ReconfigureField],
    changed: Callable[[Mapping[str, Any], Mapping[str, Any]], Mapping[str, Any]],
    part: str = "",
) -> Server:
    """Offer parameters of a node for changes.

    Returns the server; `update` changes values from within the node.

    Args:
        fields: The parameters. Those that are set already keep their values.
        changed: Called with the values before and after each change, at once with an empty mapping before; gives the
            values that hold from then on. Called in the thread of the service. A NaoError refuses the change, and the
            client gets its text.
        part: Part of the node that they belong to: it comes before their names. With a slash before it, the full
            name of something else that they belong to, such as a topic.

    Raises:
        NaoError: If a parameter is set to something that it cannot be. The server would change it without a word.

    ROS API:
        Service `~set_parameters`, topics `~parameter_descriptions`, `~parameter_updates` (dynamic_reconfigure); with
        a part `~PART/set_parameters` and so on.
    """
    owner = node.resolve(part if part.startswith("/") else f"~{part}").rstrip("/")
    prefix = f"~{part}/" if part else "~"
    for field in fields:
        name = f"{part}/{field.name}" if part.startswith("/") else f"{prefix}{field.name}"
        _check(name, field, node.param(name, field.default))
    names = [field.name for field in fields]
    last: dict[str, Any] = {}

    def callback(config: Any, _level: int) -> Any:
        try:
            for field in fields:
                _check(field.name, field, config[field.name])  # the server keeps numbers in their ranges, but NaN
            values = changed(dict(last), {name: config[name] for name in names})
        except NaoError as error:
            if last:  # the client of dynamic_reconfigure keeps the text of the error to itself
                rospy.logwarn("%s is refused: %s", owner, error)
            raise rospy.ServiceException(str(error)) from error
        config.update(values)
        last.update(values)
        return config

    with _own_errors():
        server = Server(description_of(fields), callback, owner)
    for end in (server.set_service.shutdown, server.descr_topic.unregister, server.update_topic.unregister):
        node.if_it_fails(end)
    return server


def update(server: Server, changes: Mapping[str, Any]) -> None:
    """Change parameters from within the node. Raises NaoError if the change was refused."""
    with _own_errors():
        server.update_configuration(changes)


@contextmanager
def _own_errors() -> Iterator[None]:
    """Raise the NaoError that the server passes on as an error of a service."""
    try:
        yield
    except rospy.ServiceException as error:
        if isinstance(error.__cause__, NaoError):
            raise error.__cause__ from None
        raise NaoError(str(error)) from error


def _check(name: str, field: ReconfigureField, value: Any) -> None:
    kind = type(field.default)
    right = isinstance(value, (int, float) if kind is float else kind) and isinstance(value, bool) == (kind is bool)
    low = right and field.lowest is not None and value < field.lowest
    high = right and field.highest is not None and value > field.highest
    if not right or low or high or value != value or (field.choices and value not in field.choices):
        raise NaoError(f"{name} is {value!r}: {_allowed(field)}")


def _allowed(field: ReconfigureField) -> str:
    if field.choices:
        return " or ".join(f"{value} ({meaning})" for value, meaning in field.choices.items())
    ends = [f"from {field.lowest}"] if field.lowest is not None else []
    ends += [f"to {field.highest}"] if field.highest is not None else []
    return " ".join([KINDS[type(field.default)], *ends])


def _choices(field: ReconfigureField) -> str:
    if not field.choices:
        return ""
    kind = TYPES[type(field.default)]
    entries = [
        {"name": f"{field.name}_{value}", "type": kind, "value": value, "description": meaning}
        for value, meaning in field.choices.items()
    ]
    return str({"enum": entries, "enum_description": field.description})
