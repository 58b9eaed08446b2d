"""The editor of the wizard's file: the text, what is wrong with it by line, and saving."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from nicegui import ui

from naoqi.errors import NaoError

from ...behaviors.language.errors import Problem
from ..files.yaml_file import ConsoleFileError
from ..wizard.check import doubts, stored_behaviors
from ..wizard.errors import EditConflict
from ..wizard.layout_file import CurrentLayout, LayoutFile
from ..wizard.reader import read_layout
from .frame import PageContext

MOST_PROBLEMS = 100
"""Mistakes that are shown."""


class WizardEditor:
    """A dialog of one page. Its text is checked as a file, and against what the robot's servers tell of themselves."""

    def __init__(self, file: LayoutFile, current: CurrentLayout, page: PageContext) -> None:
        """Make the dialog, closed and empty."""
        self._file = file
        self._current = current
        self._page = page
        self._revision: str | None = None
        self._code: Any = None
        with ui.dialog().props('maximized persistent aria-label="Edit the buttons"') as self._dialog, ui.card().classes(
            "no-wrap"
        ):
            with ui.row().classes("w-full items-center"):
                ui.label(str(file.path)).classes("text-subtitle1")
                ui.space()
                ui.button("Check", icon="rule", on_click=self._check).props("no-caps outline")
                ui.button("Save", icon="save", on_click=self._save).props("no-caps")
                self._over = ui.button("Save over it", icon="warning", on_click=self._save_over)
                self._over.props("no-caps color=negative")
                ui.button("Load again", icon="refresh", on_click=self._load).props("no-caps outline")
                ui.button("Close", icon="close", on_click=self._dialog.close).props("no-caps flat").classes("nao-close")
            self._told = ui.label().props("role=status")
            self._list = ui.column().classes("w-full gap-0 max-h-40 shrink-0 overflow-auto no-wrap")
            self._place = ui.column().classes("w-full flex-grow min-h-0")
            ui.label("Tab indents; Escape leaves the text, and once more closes it.").classes("text-caption")

    async def open(self) -> None:
        """Show the text of the file as it is now."""
        self._dialog.open()
        await self._load()

    async def _load(self) -> None:
        try:
            saved = await self._page.ask(self._file.text)
        except ConsoleFileError as error:
            self._show(error.problems, "The file cannot be read")
            return
        self._revision = saved.revision
        self._over.set_visibility(False)
        self._place.clear()
        dark = bool(self._page.visitor.dark)
        with self._place:
            self._code = (
                ui.codemirror(saved.text, language="YAML", theme="vscodeDark" if dark else "vscodeLight", indent="  ")
                .classes("w-full h-full")
                .props('aria-label="Text of the file"')
            )
        await self._check()

    async def _check(self) -> bool:
        """Whether the text can be saved; tells what is wrong with it."""
        if self._code is None:  # the file could not be read, which stands there
            return False
        text = self._code.value
        try:
            layout = await self._page.work(read_layout, text, self._file.path.name)
        except ConsoleFileError as error:
            self._show(error.problems, f"{_count(error.problems)}: it cannot be saved so")
            return False
        except NaoError as error:
            self._told.text = str(error)
            return False
        robot = self._page.robot
        found = await self._page.work(lambda: doubts(layout, robot, stored_behaviors(robot)))
        right = f"It can be saved: {sum(1 for _ in layout.buttons())} buttons"
        self._show(found, f"{right}; the robot that runs would refuse some" if found else right)
        return True

    async def _save(self) -> None:
        await self._store(self._revision)

    async def _save_over(self) -> None:
        await self._store(None)

    async def _store(self, revision: str | None) -> None:
        if not self._page.operate() or not await self._check():
            return
        try:
            saved = await self._page.work(self._file.save, self._code.value, revision)
        except EditConflict as error:
            self._told.text = str(error)
            self._over.set_visibility(True)
            return
        except NaoError as error:
            self._told.text = str(error)
            return
        self._revision = saved.revision
        self._over.set_visibility(False)
        await self._page.work(self._current.look)
        self._page.notify(f"Saved: {self._file.path}", "positive")

    def _show(self, problems: Sequence[Problem], told: str) -> None:
        self._told.text = told
        self._list.clear()
        with self._list:
            for problem in problems[:MOST_PROBLEMS]:
                ui.button(str(problem), on_click=lambda _, line=problem.line: self._go_to(line)).props(
                    "flat dense no-caps align=left color=negative"
                )
        if self._code is not None:
            self._code.line_tooltips = {each.line: each.text for each in problems if each.line}

    def _go_to(self, line: int) -> None:
        if line and self._code is not None:
            self._code.reveal_line(line)


def _count(problems: Sequence[Problem]) -> str:
    return "1 mistake" if len(problems) == 1 else f"{len(problems)} mistakes"
