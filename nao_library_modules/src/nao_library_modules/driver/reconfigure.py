"""Parameters that can be changed while a node runs, described in Python: no .cfg file, no generated code."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any, Union

import rospy
from dynamic_reconfigure.server import Server

from naoqi.errors import NaoError

Value = Union[bool, int, float, str]

TYPES = {bool: "bool", int: "int", float: "double", str: "str"}
LOWEST: dict[type, Value] = {bool: False, int: -(2**31), float: float("-inf"), str: ""}
HIGHEST: dict[type, Value] = {bool: True, int: 2**31 - 1, float: float("inf"), str: ""}


@dataclass(frozen=True)
class Field:
    """One parameter.

    Attributes:
        name: Its name.
        default: Its value when nobody sets it; tells the type as well.
        description: What it does, for the tools that show it.
        lowest: Least value of a number.
        highest: Greatest value of a number.
        choices: Value -> what it means, when there are only some.
    """

    name: str
    default: Value
    description: str
    lowest: Value | None = None
    highest: Value | None = None
    choices: Mapping[Value, str] | None = None


def description_of(fields: Sequence[Field]) -> Any:
    """What `dynamic_reconfigure` wants to know about parameters, as it would be generated from a .cfg file."""
    parameters = [
        {
            "name": field.name,
            "type": TYPES[type(field.default)],
            "default": field.default,
            "level": 1 << place,
            "description": field.description,
            "min": _limit(field.lowest, field.default, LOWEST),
            "max": _limit(field.highest, field.default, HIGHEST),
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
    fields: Sequence[Field], changed: Callable[[Mapping[str, Any], Mapping[str, Any]], Mapping[str, Any]]
) -> Server:
    """Offer parameters of this node for changes.

    Args:
        fields: The parameters. Those that are set already keep their values.
        changed: Called with the values before and after each change, at once with an empty mapping before; gives the
            values that hold from then on. Called in the thread of the service. A NaoError refuses the change: who
            asked for it gets its text.

    Returns:
        The server; `update_configuration` changes values from within the node.

    ROS API:
        Service `~set_parameters`, topics `~parameter_descriptions`, `~parameter_updates` (dynamic_reconfigure).
    """
    names = [field.name for field in fields]
    last: dict[str, Any] = {}

    def callback(config: Any, _level: int) -> Any:
        try:
            values = changed(dict(last), {name: config[name] for name in names})
        except NaoError as error:
            raise rospy.ServiceException(str(error)) from error
        config.update(values)
        last.update(values)
        return config

    return Server(description_of(fields), callback)


def _limit(limit: Value | None, default: Value, limits: Mapping[type, Value]) -> Value:
    return limits[type(default)] if limit is None else limit


def _choices(field: Field) -> str:
    """The choices, in the form that the tools read."""
    if not field.choices:
        return ""
    kind = TYPES[type(field.default)]
    entries = [
        {"name": f"{field.name}_{value}", "type": kind, "value": value, "description": meaning}
        for value, meaning in field.choices.items()
    ]
    return str({"enum": entries, "enum_description": field.description})
