"""How a kind of thing that world files know by name is made."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Callable

from nao_sim_bridge.model.shapes import Shape
from nao_sim_bridge.world.world import Part


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
