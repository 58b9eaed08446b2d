"""Messages and services. Each is loaded when it is asked for."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from types import ModuleType
from typing import Any


def load_when_asked(package: str, kind: str, prefix: str = "") -> ModuleType:
    """The module `package.kind` that genpy has generated; what it has is loaded name by name.

    genpy's own `__init__` loads all, which costs a node 9 MB and 50 ms: it needs a few of them.

    Args:
        package: Its name; it is just being imported.
        kind: "msg" or "srv".
        prefix: What names have that are known without it as well.

    Raises:
        ImportError: It was not generated.
    """
    spec = importlib.util.find_spec(f"{package}.{kind}")
    if spec is None:
        raise ImportError(f"{package}.{kind} is not there: build {package} with catkin, and source its workspace")
    module = importlib.util.module_from_spec(spec)
    files = [file.stem[1:] for folder in spec.submodule_search_locations for file in Path(folder).glob("_[A-Za-z]*.py")]
    ends = ("", "Request", "Response") if kind == "srv" else ("",)
    where = {file + end: (file, file + end) for file in files for end in ends}
    where.update({n[len(prefix) :]: place for n, place in where.items() if prefix and n.startswith(prefix)})

    def load(name: str) -> Any:
        if name not in where:
            raise AttributeError(f"module {spec.name!r} has no attribute {name!r}")
        file, full_name = where[name]
        found = getattr(importlib.import_module(f"{spec.name}._{file}"), full_name)
        setattr(module, name, found)
        return found

    module.__getattr__, module.__dir__, module.__all__ = load, lambda: sorted(where), sorted(where)
    sys.modules[spec.name] = module
    return module


msg, srv = (load_when_asked(__name__, kind) for kind in ("msg", "srv"))
