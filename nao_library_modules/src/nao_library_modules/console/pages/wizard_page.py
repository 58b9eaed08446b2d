"""The wizard's page: buttons from a file, free text, walking by hand, the head by the camera picture.

The file is edited on the page as well; a note goes to the trial that runs.
"""

from __future__ import annotations

import asyncio
import sys
import threading
import uuid
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path
from typing import Any

from fastapi import Request, WebSocket
from nicegui import context, ui

from naoqi.errors import NaoError

from ...core.files import config_file
from ...studies.commands import ConsoleFileError, RobotCommand
from ...studies.studies import Studies
from ..access.guard import LEFT, session_of
from ..access.sessions import Session
from ..view.background import in_background
from ..wizard.desk import HEAD, PLANS, STOP, WALK, PageRights, WizardDesk, WizardSession, read_message
from ..wizard.layout import EditConflict, WizardLayout, layout_message, read_layout
from ..wizard.layout_file import CurrentLayout, LayoutFile, doubts, stored_behaviors
from .frame import PageContext, framed, page_at
from .text_editor import Draft, YamlEditor, mistakes, problems_of

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


OWN_FILE = "~/.ros/nao_console.yaml"
"""What is edited where the console was started without a file: the shipped one stays as it is."""
LOOK_PERIOD = 2.0
"""s between two looks whether the file has changed on the disk."""
HISTORY_SHOWN = 6
DRIVE = "drive"
"""Lane of walks and stops."""


class WizardParts:
    """What all pages of the wizard share."""

    def __init__(self, console: Any) -> None:
        """Read the console's file."""
        shipped = config_file("console") / "console.yaml"
        path = Path(console.settings.buttons)
        own = Path(OWN_FILE).expanduser() if path == shipped else path
        self.console = console
        self.file = LayoutFile(own, shipped)
        self.current = CurrentLayout(self.file)
        for problem in self.current.problems:
            print(f"{own}: {problem}", file=sys.stderr, flush=True)
        self.desk = WizardDesk(console.presses)

    def find_all(self, layout: WizardLayout) -> None:
        """In the background, have the robots of buttons known: a stop asks nobody for them."""

        def search() -> None:
            for name in sorted({button.robot for _, button in layout.buttons() if button.robot}):
                with suppress(NaoError):
                    self.console.robots.robot(name)

        threading.Thread(target=search, name="robots of buttons", daemon=True).start()


def build(console: Any) -> None:
    """Register the page and its WebSocket."""
    parts = WizardParts(console)

    @page_at(console, "/wizard")
    def wizard(request: Request) -> None:
        with framed(console, "Wizard", request) as page:
            _WizardPage(parts, page).draw()

    @console.app.websocket("/console/drive")
    async def drive(socket: WebSocket) -> None:
        await _DriveSocket(parts, socket).serve()


class _WizardPage:
    """The parts of one open page that are made of NiceGUI's elements."""

    def __init__(self, parts: WizardParts, page: PageContext) -> None:
        self._parts = parts
        self._desk = parts.desk
        self._page = page
        self._space = page.robot.namespace
        self._client = context.client
        self._place = -1  # in the history, of the text field

    def draw(self) -> None:
        """Make the page."""
        page = self._page
        page.static("camera.js")
        page.static("wizard.js")
        editor = WizardEditor(self._parts.file, self._parts.current, page)
        page.every(LOOK_PERIOD, self._look)
        self._follow(self._parts.current.subscribe, self._changed)
        self._follow(self._desk.subscribe, self._show_desk)
        page.robot.prepare(servers_of(self._parts.current.layout))
        with ui.element("div").classes("w-full grid gap-4 grid-cols-1 lg:grid-cols-3"):
            with ui.column().classes("lg:col-span-2 w-full gap-3"):
                self._talk()
                with ui.row().classes("w-full items-center"):
                    self._title = ui.label(self._parts.current.layout.title).classes("text-h6").props("role=heading")
                    ui.space()
                    ui.button("Arm again", icon="restart_alt", on_click=self._arm).props("flat no-caps").tooltip(
                        "Buttons that are for once can be pressed again"
                    )
                    ui.button("Edit", icon="edit", on_click=editor.open).props("flat no-caps").tooltip(
                        "Change the buttons"
                    )
                self._problems = ui.label().classes("text-negative").props("role=alert")
                ui.element("nao-wizard-buttons").props(f'robot="{self._space}"')
            with ui.column().classes("w-full gap-3"):
                TrialNote(page, self._parts.console.studies)
                self._names_card()
                with ui.card().classes("w-full"):
                    self._camera()
                with ui.card().classes("w-full"):
                    ui.label("Walk").classes("text-subtitle1").props("role=heading aria-level=2")
                    ui.element("nao-wizard-drive").props(f'robot="{self._space}"')
        self._show_problems()

    async def _look(self) -> None:
        await self._page.work(self._parts.current.look)

    # --- free text ----------------------------------------------------------------------------------------------------

    def _talk(self) -> None:
        with ui.card().classes("w-full"):
            with ui.row().classes("w-full items-center no-wrap"):
                self._text = ui.input("Say").classes("flex-grow").props("clearable maxlength=2000")
                self._text.on("keydown.enter", self._say)
                self._text.on("keydown.up", lambda: self._recall(1))
                self._text.on("keydown.down", lambda: self._recall(-1))
                self._animated = ui.checkbox("animated", value=True)
                ui.button("Say", icon="record_voice_over", on_click=self._say).props("no-caps")
            Draft(self._page, self._text, "say").of(self._space)
            with ui.row().classes("w-full items-center"):
                self._templates = ui.select(
                    list(self._parts.current.layout.templates), label="Templates", on_change=self._choose
                ).classes("min-w-64 flex-grow")
            self._history = ui.row().classes("w-full gap-1")
            self._draw_history()

    async def _say(self) -> None:
        text = self._text.value or ""
        if not self._page.operate("Say"):
            return
        self._desk.take_names(self._parts.current.layout, self._space)
        robot, by = self._page.robot, self._page.visitor.name
        run = await self._page.press("Say", self._desk.say, robot, text, self._animated.value, by, robot.stops)
        if run is None:
            return
        self._text.value = ""
        self._place = -1

    def _choose(self, event: Any) -> None:
        if event.value:
            self._text.value = event.value
            self._templates.value = None
            self._text.run_method("focus")

    def _recall(self, step: int) -> None:
        texts = self._desk.history(self._space)
        self._place = min(max(self._place + step, -1), len(texts) - 1)
        self._text.value = texts[self._place] if self._place >= 0 else ""

    def _draw_history(self) -> None:
        self._history.clear()
        with self._history:
            for text in self._desk.history(self._space)[:HISTORY_SHOWN]:
                ui.button(text[:60], icon="history", on_click=lambda _, text=text: self._take(text)).props(
                    "flat dense no-caps size=sm"
                ).tooltip("Say this again: it goes into the field")

    def _take(self, text: str) -> None:
        self._text.value = text
        self._text.run_method("focus")

    # --- names, camera, file ------------------------------------------------------------------------------------------

    def _names_card(self) -> None:
        self._names = ui.card().classes("w-full")
        self._draw_names()

    def _draw_names(self) -> None:
        self._names.clear()
        values = self._desk.values(self._parts.current.layout, self._space)
        self._names.set_visibility(bool(values))
        with self._names:
            ui.label("Names").classes("text-subtitle1").props("role=heading aria-level=2")
            self._fields = {
                name: ui.input(name, value=value, on_change=lambda event, name=name: self._name(name, event.value))
                .props("dense maxlength=100 debounce=200")
                .classes("w-full")
                for name, value in values.items()
            }
            for field in self._fields.values():
                field.set_enabled(self._page.visitor.operator)

    def _name(self, name: str, value: str | None) -> None:
        if self._page.visitor.operator:
            self._desk.set_values(self._space, {name: value or ""})

    def _camera(self) -> None:
        with ui.row().classes("w-full items-center"):
            ui.label("Head").classes("text-subtitle1").props("role=heading aria-level=2")
            ui.space()
            choice = ui.toggle({"top": "Top", "bottom": "Bottom"}, value="top").props("no-caps dense")
            shown = ui.switch("picture", value=True)
        holder = ui.element("div").classes("w-full")

        def show() -> None:
            holder.clear()
            if shown.value:
                with holder:
                    ui.element("nao-camera").props(f'robot="{self._space}" camera="{choice.value}"')

        choice.on_value_change(show)
        shown.on_value_change(show)
        show()
        ui.label("Click: the robot looks there. Drag: the head turns along.").classes("text-caption")

    def _arm(self) -> None:
        if self._page.operate("Arm again"):
            self._desk.arm(self._space)

    def _changed(self) -> None:
        """The file is another one."""
        layout = self._parts.current.layout
        self._title.text = layout.title
        self._templates.set_options(list(layout.templates))
        self._draw_names()
        self._show_problems()
        self._page.robot.prepare(servers_of(layout))

    def _show_desk(self) -> None:
        """Show what was typed and said on other pages, too."""
        for name, value in self._desk.values(self._parts.current.layout, self._space).items():
            field = self._fields.get(name)
            if field is not None and (field.value or "").split() != value.split():  # nobody's space is taken away
                field.value = value
        texts = tuple(self._desk.history(self._space)[:HISTORY_SHOWN])
        if texts != getattr(self, "_shown", ()):
            self._shown = texts
            self._draw_history()

    def _show_problems(self) -> None:
        problems = self._parts.current.problems
        more = f" (and {len(problems) - 1} more)" if len(problems) > 1 else ""
        self._problems.text = (
            f"The file has mistakes, the former buttons are shown: {problems[0]}{more}" if problems else ""
        )
        self._problems.set_visibility(bool(problems))

    def _follow(self, subscribe: Any, callback: Any) -> None:
        """Have something called in the event loop, on this page, whatever thread tells of it."""
        loop = asyncio.get_running_loop()

        def in_page() -> None:
            with self._client:
                callback()

        self._page.on_leave(subscribe(lambda: loop.call_soon_threadsafe(in_page)))


class _DriveSocket:
    """One WebSocket of a page. Walks and stops, presses, and the head each have a thread, which keeps their order."""

    def __init__(self, parts: WizardParts, socket: WebSocket) -> None:
        self._parts = parts
        self._socket = socket
        self._session = session_of(socket)
        self._wake = asyncio.Event()
        self._lanes: dict[str, ThreadPoolExecutor] = {}
        self._notices: list[dict[str, Any]] = []

    async def serve(self) -> None:
        """Answer until the page is gone."""
        socket, console = self._socket, self._parts.console
        try:
            robot = await in_background(self._parts.console.robots.robot, socket.query_params.get("robot", ""))
        except NaoError as error:
            await socket.close(4404, str(error)[:100])
            return
        await socket.accept()
        wizard = WizardSession(
            uuid.uuid4().hex,
            robot,
            self._parts.desk,
            lambda: self._parts.current.layout,
            _rights(console, self._session),
            self._parts.console.robots.robot,
            self._parts.console.robots.known,
            _head_pointer,
        )
        loop = asyncio.get_running_loop()
        wake = lambda: loop.call_soon_threadsafe(self._wake.set)  # noqa: E731
        followed = (self._parts.desk, self._parts.desk.presses, self._parts.current)
        ends = [each.subscribe(wake) for each in followed]
        teller = asyncio.create_task(self._tell(wizard))
        try:
            while True:
                self._take(wizard, await socket.receive_text())
        finally:
            teller.cancel()
            for end in ends:
                end()
            self._lane(DRIVE).submit(wizard.leave)
            if HEAD in self._lanes:
                self._lanes[HEAD].submit(wizard.close_pointer)
            for lane in self._lanes.values():
                lane.shutdown(wait=False)

    def _take(self, wizard: WizardSession, text: str) -> None:
        try:
            kind, message = read_message(text)
        except ValueError as error:
            self._notice(str(error))
            return
        drives = kind in (WALK, STOP)
        lane = self._lane(DRIVE if drives else kind)
        done = asyncio.get_running_loop().run_in_executor(lane, wizard.take, kind, message, wizard.stops())
        done.add_done_callback(lambda done: self._taken(done, drives and wizard.must_let_go))

    def _lane(self, name: str) -> ThreadPoolExecutor:
        if name not in self._lanes:
            self._lanes[name] = ThreadPoolExecutor(1, f"wizard {name}")
        return self._lanes[name]

    def _taken(self, done: Any, let_go: bool) -> None:
        if not done.cancelled():
            self._notice(done.result(), let_go)

    def _notice(self, text: str, let_go: bool = False) -> None:
        """Tell the page something; `let_go`: what it holds does not count any more."""
        if text:
            self._notices.append({"notice": text, "let_go": let_go})
            self._wake.set()

    async def _tell(self, wizard: WizardSession) -> None:
        """Tell the page its layout, the states of its buttons, and what was refused, as they change."""
        revision, states = None, None
        with suppress(*LEFT):
            while True:
                layout = self._parts.current.layout
                message: dict[str, Any] = {}
                if layout.revision != revision:
                    message, revision, states = layout_message(layout), layout.revision, None
                    self._parts.find_all(layout)
                now = wizard.states()
                if now != states:
                    message["states"], states = now, now
                if message:
                    await self._socket.send_json(message)
                notices, self._notices = self._notices, []
                for notice in notices:
                    await self._socket.send_json(notice)
                await self._wake.wait()
                self._wake.clear()


def _head_pointer(robot: Any) -> Any:
    from ..wizard.head_pointer import HeadPointer

    return HeadPointer(robot)


def _rights(console: Any, session: Session) -> PageRights:
    controls = console.controls

    def known() -> bool:
        return console.sessions.known(session)

    def refusal(namespace: str) -> str:
        if not known():
            return "you are logged out: log in again"
        return "" if controls.may_move(namespace, session) else controls.refusal(namespace, session)

    return PageRights(session.name, refusal, known, lambda: session.operator)


def servers_of(layout: WizardLayout) -> list[str]:
    """Servers that the buttons of a layout use, each once; that of plans is left out."""
    servers = {
        button.action.server
        for _, button in layout.buttons()
        if isinstance(button.action, RobotCommand) and not button.robot
    }
    return sorted(server for server in servers if server and server != PLANS)
