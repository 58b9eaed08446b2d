"""The benchmarks are programs, not a package of the workspace: their folder goes on the search path here."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "benchmarks"))


@pytest.fixture(scope="module")
def program(request):
    """The program of the benchmarks that a file is about: NAME.py, for test_NAME.py."""
    from nao_benchmarks.places import PROGRAMS

    name = request.path.stem[len("test_") :]
    spec = importlib.util.spec_from_file_location(name, PROGRAMS / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module
