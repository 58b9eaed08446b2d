"""Pages of studies: a trial that runs, what was measured, and trials seen again."""

from __future__ import annotations

from typing import Any

from . import replay_page, results_page, trial_page


def build(console: Any) -> None:
    """Add the pages to a console."""
    for page in (trial_page, results_page, replay_page):
        page.build(console, console.studies)
