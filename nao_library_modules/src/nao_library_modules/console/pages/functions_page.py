"""The page "Functions": every function of every server, with a form, what it answers, and copies for programs."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

from nicegui import ui
from starlette.requests import Request

from ...behaviors.strict_yaml import dump
from ...core.errors import closest
from ...studies.commands import RobotCommand
from ..robots.forms import as_command, as_python, as_yaml, form_of
from .field_inputs import FieldInputs
from .frame import PageContext, framed, page_at

MOST_SHOWN = 40
"""Functions in the list: who sees more looks for none."""
LOOK_PERIOD = 0.2
"""s between two looks at a goal that runs."""
ALL = "all servers"
LONGEST_ANSWER = 20_000
"""Characters of an answer that are shown."""


def build(console: Any) -> None:
    """Register the page."""

    @page_at(console, "/functions")
    def functions(request: Request) -> None:
        with framed(console, "Functions", request) as page:
            FunctionsView(page).build()


class FunctionsView:
    """The page of one visitor."""

    def __init__(self, page: PageContext) -> None:
        self._page = page
        self._described: dict[str, Any] = {}
        self._server = ""
        self._function: Any = None
        self._inputs: FieldInputs | None = None
        self._common: FieldInputs | None = None
        self._run: Any = None
        self._told: Any = None  # what is shown of the goal

    def build(self) -> None:
        with ui.row().classes("w-full items-start gap-4"):
            with ui.card().classes("w-full md:w-96 gap-2"):
                self._search = ui.input("Search functions", on_change=lambda: self._list()).classes("w-full")
                self._search.props("clearable autofocus debounce=150 type=search")
                self._servers = ui.select([ALL], value=ALL, label="Server", on_change=lambda: self._list())
                self._servers.classes("w-full")
                self._count = ui.label("asking the servers ...").classes("text-sm opacity-80").props("role=status")
                with ui.scroll_area().classes("w-full h-64 md:h-[calc(100vh-21rem)]"):
                    self._names = ui.list().props("dense").classes("w-full")
            with ui.column().classes("grow gap-4 min-w-80").style("flex-basis: 30rem"):
                self._form = ui.card().classes("w-full gap-3")
                self._answer = ui.card().classes("w-full gap-2")
        with self._form:
            ui.label("Choose a function.").classes("opacity-80")
        self._answer.set_visibility(False)
        ui.timer(0.05, self._ask, once=True)
        self._page.every(LOOK_PERIOD, self._look)

    # --- the list -----------------------------------------------------------------------------------------------------

    async def _ask(self) -> None:
        self._described = await self._page.ask(self._page.robot.describe_all)
        self._servers.set_options([ALL, *self._described], value=ALL)
        self._list()

    def _found(self) -> list[tuple[str, Any]]:
        chosen = self._servers.value
        every = [
            (server, function)
            for server, told in self._described.items()
            if chosen in (ALL, server)
            for function in told.functions
            if chosen != ALL or not function.shared or server == next(iter(self._described))
        ]
        words = str(self._search.value or "").lower().split()
        return [
            (server, function)
            for server, function in every
            if all(word in f"{server}.{function.name} {function.help}".lower() for word in words)
        ]

    def _list(self) -> None:
        found = self._found()
        words = str(self._search.value or "").lower()
        found.sort(key=lambda pair: (not pair[1].name.lower().startswith(words), pair[1].shared))
        self._names.clear()
        with self._names:
            for server, function in found[:MOST_SHOWN]:
                item = ui.item(on_click=lambda s=server, f=function: self._open(s, f)).classes("rounded")
                item.props["aria-label"] = f"{server}.{function.name}: {function.help}"
                with item, ui.item_section():
                    ui.item_label(function.name).classes("font-medium")
                    ui.item_label(f"{server} · {function.help}").props("caption")
        more = len(found) - MOST_SHOWN
        self._count.text = f"{len(found)} function{'s' * (len(found) != 1)}" + (
            f", the first {MOST_SHOWN} of them here" if more > 0 else ""
        )
        if not found and self._described:
            names = [function.name for told in self._described.values() for function in told.functions]
            near = closest(words, names)
            self._count.text = "none is called so" + (f": did you mean {', '.join(near)}?" if near else "")

    # --- the form -----------------------------------------------------------------------------------------------------

    def _open(self, server: str, function: Any) -> None:
        self._server, self._function = server, function
        told = self._described[server]
        self._form.clear()
        with self._form:
            ui.label(f"{server}.{function.name}").classes("text-lg font-medium").props("role=heading aria-level=2")
            ui.label(function.help)
            ui.label(f"Answers {function.answers}.").classes("text-sm opacity-80")
            self._inputs = FieldInputs(form_of(function), self._page.work)
            with ui.expansion("Wait afterwards, failures").classes("w-full"):
                self._common = FieldInputs(_common(told), self._page.work)
            with ui.row().classes("gap-2 items-center"):
                ui.button("Send", icon="send", on_click=self._send).props("no-caps")
                self._cancel = ui.button("Cancel", icon="cancel", on_click=self._cancel_run).props("outline no-caps")
                self._cancel.set_enabled(self._run is not None and not self._run.done)
                ui.space()
                ui.label("Copy as").classes("text-sm")
                ui.button("Python", on_click=lambda: self._copy("Python")).props("flat dense no-caps")
                ui.button("Command", on_click=lambda: self._copy("a command")).props("flat dense no-caps")
                ui.button("YAML", on_click=lambda: self._copy("YAML")).props("flat dense no-caps")

    async def _command(self) -> RobotCommand | None:
        """What the form says; None if something in it will not do, which is told."""
        if self._inputs is None or self._common is None:
            return None
        try:
            fields = {**await self._inputs.values(), **await self._common.values()}
        except ValueError as error:
            ui.notify(str(error), type="negative")
            return None
        return RobotCommand(self._server, ((self._function.name, fields),))

    async def _send(self) -> None:
        robot = self._page.robot
        stops, command = robot.stops, await self._command()
        if command is None or not self._page.operate(f"Send {command.server}.{command.label}"):
            return
        run = await self._page.send(f"Send {command.server}.{command.label}", command, stops=stops)
        if run is None:
            return
        self._run = run
        self._cancel.set_enabled(True)
        await self._show()

    def _cancel_run(self) -> None:
        if self._run is not None and self._page.operate("Cancel"):
            self._run.cancel()

    # --- the answer ---------------------------------------------------------------------------------------------------

    async def _look(self) -> None:
        goal = self._run
        if goal is None:
            return
        done = goal.done
        told = (goal.state, goal.progress, done)
        if told != self._told:
            self._told = told
            await self._show()
        if done and self._run is goal:
            self._cancel.set_enabled(False)
            self._run = None

    async def _show(self) -> None:
        goal = self._run
        answer = {name: value for name, value in goal.result.items() if value not in ("", [], {}, 0, 0.0, False)}
        text = await self._page.work(_answer_text, answer) if answer else ""
        self._answer.set_visibility(True)
        self._answer.clear()
        with self._answer:
            ui.label("Answer").classes("text-lg font-medium").props("role=heading aria-level=2")
            ui.label(f"{goal.server}: {goal.label} – {goal.state}").classes("nao-state").props("role=status")
            for text in dict.fromkeys(filter(None, (goal.progress if not goal.done else "", goal.text))):
                ui.label(text).classes("whitespace-pre-wrap break-words")
            if text:
                ui.label(text).classes("whitespace-pre-wrap break-all font-mono text-sm")
            elif goal.succeeded:
                ui.label("It answers nothing.").classes("opacity-80")

    # --- copies -------------------------------------------------------------------------------------------------------

    async def _copy(self, kind: str) -> None:
        command = await self._command()
        if command is None:
            return
        namespace = self._page.robot.namespace
        if kind == "Python":
            text = await self._page.work(as_python, command, namespace, self._described[self._server])
        elif kind == "a command":
            text = await self._page.work(as_command, command, namespace)
        else:
            text = await self._page.work(as_yaml, command)
        show_copy(kind, text)


def _answer_text(answer: Any) -> str:
    text = dump(answer)
    more = len(text) - LONGEST_ANSWER
    return text if more <= 0 else f"{text[:LONGEST_ANSWER]}\n... and {more} characters more"


def show_copy(kind: str, text: str) -> None:
    """A dialog with a text to be copied."""
    with ui.dialog() as dialog, ui.card().classes("w-full max-w-3xl gap-3"):
        ui.label(f"As {kind}").classes("text-lg").props("role=heading aria-level=2")
        area = ui.textarea(value=text).classes("w-full font-mono").props("readonly outlined autogrow")
        area.props["aria-label"] = f"As {kind}"
        with ui.row():

            def copy() -> None:
                ui.clipboard.write(text)
                ui.notify("copied")

            ui.button("Copy", icon="content_copy", on_click=copy).props("no-caps")
            ui.button("Close", on_click=dialog.close).props("flat no-caps")
    dialog.on("hide", dialog.delete)
    dialog.open()


def _common(told: Any) -> list[Any]:
    """The fields that every function of a server has. `told`: its DescribeFunctionsResponse."""
    return form_of(SimpleNamespace(arguments=told.common))
