"""Pages of the console, on NiceGUI. Each module has a `build`, which registers what it serves."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import Any

MODULES = ("robot_page", "wizard_page", "trial_page", "results_page", "behaviors_page", "functions_page")


def _builder(module: str) -> Callable[[Any], None]:
    return lambda console: import_module(f".{module}", __package__).build(console)


PAGES = tuple(map(_builder, MODULES))
"""Takes the console, each; what a page imports is loaded when a console is made."""
