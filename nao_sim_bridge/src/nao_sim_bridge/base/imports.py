"""Code that is read when it is first needed: our own, and libraries that many a simulation never needs."""

from __future__ import annotations

from importlib import import_module
from typing import Any

PACKAGE = __name__.partition(".")[0]


def imported(where: str) -> Any:
    """What stands at `where`, "file:name", the file as in our package: "naoqi.system.knowledge:ALKnowledge"."""
    module, _, name = where.partition(":")
    return getattr(import_module(f"{PACKAGE}.{module}"), name)
