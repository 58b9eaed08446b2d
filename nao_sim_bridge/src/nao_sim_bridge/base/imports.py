"""Code that is read when it is first needed: our own, and libraries that many a simulation never needs."""

from __future__ import annotations

from importlib import import_module
from typing import Any

PACKAGE = __name__.partition(".")[0]


def imported(where: str) -> Any:
    """What stands at `where`, "file:name", the file as in our package: "naoqi.system.knowledge:ALKnowledge"."""
    module, _, name = where.partition(":")
    return getattr(import_module(f"{PACKAGE}.{module}"), name)


class Library:
    """A library that is imported with the first thing that is asked of it: `cv2 = Library("cv2")`."""

    def __init__(self, name: str) -> None:
        self._name = name

    def __getattr__(self, name: str) -> Any:
        return getattr(import_module(self._name), name)
