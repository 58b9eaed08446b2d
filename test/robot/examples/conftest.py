"""The examples, as modules of their own."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).parents[3] / "nao_library_modules" / "examples"


@pytest.fixture
def example():
    """Gives an example by name; nothing of it has run yet."""

    def load(name):
        spec = importlib.util.spec_from_file_location(f"example_{name}", EXAMPLES / f"{name}.py")
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        return module

    return load


@pytest.fixture
def run(example, monkeypatch, capsys):
    """Runs an example as from the command line; its exit status and what it printed."""

    def run(name, *arguments):
        monkeypatch.setattr(sys, "argv", [f"{name}.py", *map(str, arguments)])
        return example(name).main(), capsys.readouterr().out

    return run
