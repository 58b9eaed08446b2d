"""Pages of studies: a trial that runs, what was measured, and trials seen again."""

from __future__ import annotations

from typing import Any

from ...study.alone import studies_of
from ...study.files import StudyFiles
from . import replay_page, results_page, trial_page


def build(console: Any) -> None:
    """Add the pages to a console."""
    studies = console.studies = studies_of(StudyFiles(console.settings.studies), console.views)
    trial_page.build(console, studies)
    results_page.build(console, studies)
    replay_page.build(console, studies)
