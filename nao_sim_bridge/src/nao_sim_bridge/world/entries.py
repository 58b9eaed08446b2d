"""What all readers of world files share: kinds of things, and values with errors that tell the place."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Callable

from nao_sim_bridge.base.config import vector
from nao_sim_bridge.base.errors import BadValue, UnknownName, shortened
from nao_sim_bridge.base.limits import check_world
from nao_sim_bridge.model.shapes import Shape
from nao_sim_bridge.world.world import Color, Part, WorldError

if TYPE_CHECKING:
    from nao_sim_bridge.world.pictures import WorldPicture

GREY = (0.6, 0.6, 0.6)


def check_bounds(content: Any, where: str) -> None:
    """Refuse numbers that are out of the bounds of their keys.

    Raises:
        WorldError: One of them is.
    """
    try:
        check_world(content, where)
    except BadValue as error:
        raise WorldError(error.field, f"is {shortened(error.value)}, allowed is {error.allowed}") from error


def entries(content: Mapping, key: str, where: str) -> list[tuple[str, Any]]:
    """The entries of a list, each with its place for error texts."""
    listed = content.get(key) or []
    if not isinstance(listed, list):
        raise WorldError(f"{where}: {key}", f"is {listed!r}, not a list")
    return [(f"{where}: {key}[{i}]", entry) for i, entry in enumerate(listed)]


def number(
    entry: Mapping, key: str, where: str, default: float, lowest: float = 0.0, highest: float = math.inf
) -> float:
    """A number of an entry.

    Raises:
        WorldError: It is no number, or out of these limits.
    """
    value = float(vector([entry.get(key, default)], f"{where}.{key}", 1, WorldError)[0])
    if not lowest <= value <= highest:
        upper = f"..{highest:g}" if highest != math.inf else " or more"
        raise WorldError(f"{where}.{key}", f"is {value:g}, allowed is {lowest:g}{upper}")
    return value


def color(entry: Mapping, key: str, where: str, default: Color) -> Color:
    """A colour (r, g, b) of an entry, each 0..1."""
    value = vector(entry.get(key, default), f"{where}.{key}", 3, WorldError)
    if value.min() < 0.0 or value.max() > 1.0:
        raise WorldError(f"{where}.{key}", f"is {value.tolist()}, allowed is 0..1 each")
    return tuple(value.tolist())


def picture(kind: str, content: Any, where: str) -> WorldPicture:
    """A picture, if there is one of that kind and content."""
    from nao_sim_bridge.world.pictures import WorldPicture  # most worlds have none

    if not isinstance(content, str) and kind != "landmark":
        # YAML makes numbers of digits and forgets leading zeros.
        raise WorldError(where, f"is {content!r}, not a text: put it between quotes")
    try:
        return WorldPicture(kind, str(content))
    except (BadValue, UnknownName) as error:
        raise WorldError(where, str(error)) from error


def name_of(entry: Mapping, where: str) -> str:
    name = entry["name"]
    if not isinstance(name, str) or not name:
        raise WorldError(f"{where}.name", f"is {name!r}, not a name")
    return name


def truth(entry: Mapping, key: str, where: str) -> bool:
    """A switch of an entry, off unless it says otherwise."""
    value = entry.get(key, False)
    if not isinstance(value, bool):
        raise WorldError(f"{where}.{key}", f"is {value!r}, not true or false")
    return value


@dataclass(frozen=True)
class Made:
    """What an entry makes, in the frame at its `position`.

    Attributes:
        parts: What is to be seen.
        body: What is to be felt; None for the shapes of the parts.
        defaults: Mass, friction... when the entry does not say.
    """

    parts: tuple[Part, ...]
    body: tuple[Shape, ...] | None = None
    defaults: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Kind:
    """A kind of thing.

    Attributes:
        options: Keys that an entry may have besides those of all things.
        make: From an entry, its place for error texts and a way to find files to what it makes.
    """

    options: tuple[str, ...]
    make: Callable[[Mapping[str, Any], str, Callable[[str], Path]], Made]
