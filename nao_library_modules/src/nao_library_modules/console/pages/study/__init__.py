"""Pages of studies: a trial that runs, what was measured, and trials seen again."""

from __future__ import annotations

from typing import Any

from ...study.files import StudyFiles
from ...study.studies import Studies
from . import replay_page, results_page, trial_page


def build(console: Any) -> None:
    """Add the pages to a console."""
    views = console.views
    files = StudyFiles(console.settings.studies)
    studies = Studies(files, lambda robot: views.of(robot).senses.acquire(), lambda robot: views.of(robot).alarms)
    trial_page.build(console, studies)
    results_page.build(console, studies)
    replay_page.build(console, studies)
