"""What is loaded when it is asked for first: names of a package, libraries, and modules under their former names."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping, Sequence
from importlib import import_module
from importlib.machinery import ModuleSpec
from types import ModuleType
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


class Former:
    """Finds a module by its former name: it is the same module then, with the same classes.

    `modules`: former full name -> full name.
    """

    def __init__(self, modules: Mapping[str, str]) -> None:
        self._modules = modules
        self._specs: dict[str, ModuleSpec | None] = {}

    @classmethod
    def install(cls, package: str, modules: Mapping[str, str]) -> None:
        """Have former names of modules of a package found; both names are relative to it."""
        # First: a module of a new package must not be found once more, under a former name of the package.
        sys.meta_path.insert(0, cls({f"{package}.{old}": f"{package}.{new}" for old, new in modules.items()}))

    def find_spec(self, name: str, _path: Sequence[str] | None, _target: ModuleType | None = None) -> ModuleSpec | None:
        return ModuleSpec(name, self) if name in self._modules else None

    def create_module(self, spec: ModuleSpec) -> Any:
        module = import_module(self._modules[spec.name])
        self._specs[spec.name] = module.__spec__
        return module

    def exec_module(self, module: ModuleType) -> None:
        """Give the module back its specification, in whose place the import system has put the former one."""
        assert module.__spec__ is not None
        module.__spec__ = self._specs.pop(module.__spec__.name)
