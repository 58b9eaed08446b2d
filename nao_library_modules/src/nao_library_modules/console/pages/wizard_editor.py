"""The editor of the wizard's file: the text, what is wrong with it by line, and saving."""

from __future__ import annotations

from nicegui import ui

from naoqi.errors import NaoError

from ..files.yaml_file import ConsoleFileError
from ..wizard.check import doubts, stored_behaviors
from ..wizard.errors import EditConflict
from ..wizard.layout_file import CurrentLayout, LayoutFile
from ..wizard.reader import read_layout
from .frame import PageContext
from .text_editor import YamlEditor, mistakes, problems_of

HEIGHT = "calc(100vh - var(--nao-bar) - var(--nao-strip) - 14rem)"
"""Of the text, in CSS: what the dialog has beside its buttons and notes."""


class WizardEditor:
    """A dialog of one page. Its text is checked as a file, and against what the robot's servers tell of themselves."""

    def __init__(self, file: LayoutFile, current: CurrentLayout, page: PageContext) -> None:
        """Make the dialog, closed and empty."""
        self._file = file
        self._current = current
        self._page = page
        self._revision: str | None = None
        self._editor: YamlEditor | None = None
        with ui.dialog().props('maximized persistent aria-label="Edit the buttons"') as self._dialog, ui.card().classes(
            "no-wrap"
        ):
            with ui.row().classes("nao-editor-bar w-full items-center"):
                ui.label(str(file.path)).classes("text-subtitle1")
                ui.space()
                ui.button("Check", icon="rule", on_click=self._check).props("no-caps outline")
                ui.button("Save", icon="save", on_click=self._save).props("no-caps")
                self._over = ui.button("Save over it", icon="warning", on_click=self._save_over)
                self._over.props("no-caps color=negative")
                ui.button("Load again", icon="refresh", on_click=self._load).props("no-caps outline")
                ui.button("Close", icon="close", on_click=self._dialog.close).props("no-caps flat").classes("nao-close")
            self._told = ui.label().props("role=status")
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
            self._told.text = f"The file cannot be read: {error}"
            return
        self._revision = saved.revision
        self._told.text = ""
        self._over.set_visibility(False)
        self._place.clear()
        with self._place:
            self._editor = YamlEditor(self._page, "Text of the file", "buttons", self._taken, HEIGHT)
        self._editor.open(str(self._file.path), saved.text)
        await self._check()

    async def _taken(self, _text: str, revision: str) -> None:
        """A draft is shown; it is of the file as it was then."""
        self._revision = revision
        await self._check()

    async def _check(self) -> bool:
        """Whether the text can be saved; tells what is wrong with it."""
        if self._editor is None:  # the file could not be read, which stands there
            return False
        editor, text = self._editor, self._editor.text
        try:
            layout = await self._page.work(read_layout, text, self._file.path.name)
        except NaoError as error:
            problems = problems_of(error)
            editor.mark(problems)
            editor.tell(f"{mistakes(len(problems))}: it cannot be saved so")
            return False
        robot = self._page.robot
        found = await self._page.work(lambda: doubts(layout, robot, stored_behaviors(robot)))
        right = f"It can be saved: {sum(1 for _ in layout.buttons())} buttons"
        editor.mark(found)
        editor.tell(f"{right}; the robot that runs would refuse some" if found else right)
        return True

    async def _save(self) -> None:
        await self._store(self._revision)

    async def _save_over(self) -> None:
        await self._store(None)

    async def _store(self, revision: str | None) -> None:
        if not self._page.operate("Save") or not await self._check():
            return
        assert self._editor is not None
        try:
            saved = await self._page.work(self._file.save, self._editor.text, revision)
        except EditConflict as error:
            self._told.text = str(error)
            self._over.set_visibility(True)
            return
        except NaoError as error:
            self._told.text = str(error)
            return
        self._revision = saved.revision
        self._told.text = ""
        self._editor.draft.of(str(self._file.path), saved.text)
        self._over.set_visibility(False)
        await self._page.work(self._current.look)
        self._page.notify(f"Saved: {self._file.path}", "positive")
