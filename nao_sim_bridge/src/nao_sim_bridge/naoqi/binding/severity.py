"""How bad something is, and what has it, as answers and events of NAOqi tell it."""

from __future__ import annotations

from typing import Sequence


def severity_value(severity: int, names: Sequence[str]) -> list:
    """[severity, [names]]."""
    return [severity, list(names)]
