"""A note to the trial that runs on a robot, on a page that is not the one of the trial."""

from __future__ import annotations

from typing import Any

from nicegui import ui

from ..study.studies import Studies

PERIOD = 0.5
"""s between looks whether a trial runs."""


class TrialNote:
    """A field, and what writes it into the log as a note or a deviation; seen while a trial runs on the robot."""

    def __init__(self, page: Any, studies: Studies) -> None:
        self._page, self._studies = page, studies
        with ui.card().classes("w-full") as self._card:
            self._title = ui.label().classes("text-subtitle1").props("role=heading aria-level=2")
            with ui.row().classes("items-center w-full"):
                self._text = ui.input("Note to the trial").classes("flex-1").props("maxlength=2000")
                self._text.on("keydown.enter", lambda: self._write("note"))
                ui.button("Note", on_click=lambda: self._write("note")).props("no-caps outline")
                ui.button("Deviation", on_click=lambda: self._write("deviation")).props(
                    "no-caps outline color=negative"
                )
        self._look()
        page.every(PERIOD, self._look)

    def _look(self) -> None:
        runner = self._studies.running(self._page.robot.namespace)
        runs = runner is not None and not runner.state.over
        if runs:
            self._title.text = f"Trial {runner.id}"
        elif self._text.value:
            self._title.text = "The trial is over: this is not in its log"
        self._card.set_visibility(runs or bool(self._text.value))

    async def _write(self, kind: str) -> None:
        text = (self._text.value or "").strip()
        runner = self._studies.running(self._page.robot.namespace)
        if not text:
            ui.notify("Write what is to be noted", type="warning")
            return
        if runner is None or runner.state.over:
            ui.notify("No trial runs: the note stays here", type="warning")
            return
        if self._page.operate():
            await self._page.ask(runner.note if kind == "note" else runner.deviation, text, self._page.visitor.name)
            self._text.value = ""
