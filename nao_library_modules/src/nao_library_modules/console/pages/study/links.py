"""What all pages of studies have at their top."""

from __future__ import annotations

from typing import Any

from nicegui import ui

PAGES = {"Trial": "/study", "Results": "/study/results"}


def study_links(page: Any) -> None:
    """Links between the pages of studies, for the same robot."""
    with ui.row().classes("gap-4"):
        for name, path in PAGES.items():
            ui.link(name, f"{path}?robot={page.robot.name}")
