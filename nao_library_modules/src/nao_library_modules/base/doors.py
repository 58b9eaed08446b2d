"""What is loaded when it is asked for first: names of a package, and libraries that most processes never need."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from importlib import import_module
from typing import Any


def door(package: str, names: Mapping[str, str]) -> Callable[[str], Any]:
    """The `__getattr__` of a package.

    `package`: its `__name__`. `names`: name -> the module that has it, relative to the package; "module:other" where it
    is called so there.
    """

    def get(name: str) -> Any:
        if name not in names:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        module, _, there = names[name].partition(":")
        return getattr(import_module(f".{module}", package), there or name)

    return get


class Later:
    """A library that is imported with the first thing that is asked of it: `cv2 = Later("cv2")`.

    `name`: of the module.
    """

    def __init__(self, name: str) -> None:
        self._name = name

    def __getattr__(self, name: str) -> Any:
        return getattr(import_module(self._name), name)
