"""The page "Behaviours": stored behaviours as tracks on a timeline: edited, checked, projected, run, recorded."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

from nicegui import ui
from starlette.requests import Request

from naoqi.errors import NaoError

from ...behaviors.parameters import text_of
from ...studies.command_check import StoredBehaviors, problems_in
from ...studies.commands import RobotCommand, call
from ..robots.forms import form_of_behavior
from ..robots.robot_goals import Run, end_of
from ..timeline.document import BehaviorDocument
from ..timeline.projection import NotProjected, project_behavior
from ..timeline.tracks import RunView, StepLine, Tracks, tracks_of
from ..timeline.yaml_places import EditRefused
from ..view.background import Subscriptions
from .field_inputs import FieldInputs
from .frame import PageContext, framed, page_at, remove_dialog, sure
from .step_editor import BEHIND, INSIDE, KEYS, LAST, InsertDialog, StepForm, TimelineCanvas
from .text_editor import Draft, marks_of

SERVER = "NaoBehavior"
LOOK_PERIOD = 0.2
"""s between two looks at what runs."""
STORE_LIMIT = 10.0
"""s that the server may take to store a behaviour."""
MOST_SHOWN = 40
"""Behaviours in the list: who sees more looks for one."""
TREE_LINES, MOST_PROBLEMS = 200, 100
"""Steps of a run that are shown, the newest; mistakes that are shown."""
SIGNS = {
    "began": ("play_arrow", "runs"),
    "late": ("schedule", "late"),
    "told": ("play_arrow", "runs"),
    "retried": ("replay", "tried again"),
    "ended": ("check", "ended"),
    "failed": ("error", "failed"),
    "skipped": ("warning", "failed, skipped"),
    "preempted": ("cancel", "cut short"),
}
"""State of a step -> icon, and what it is called."""


def build(console: Any) -> None:
    """Register the page."""
    projecting = threading.Lock()  # a projection takes a stack of its own: one at a time

    @page_at(console, "/behaviors")
    def behaviors(request: Request) -> None:
        with framed(console, "Behaviours", request) as page:
            BehaviorsView(page, projecting, request.query_params.get("behavior", "")).build()


class BehaviorsView:
    """The page of one visitor. `wanted`: name of the behaviour that is open at first; empty: none."""

    def __init__(self, page: PageContext, projecting: threading.Lock, wanted: str) -> None:
        self._page = page
        self._wanted = wanted
        self._projecting = projecting
        self._cancelled = threading.Event()
        self._editing = asyncio.Lock()  # one change of the document at a time
        self._infos: dict[str, Any] = {}
        self._described: dict[str, Any] = {}
        self._document: BehaviorDocument | None = None
        self._tracks = Tracks()
        self._selected = ""
        self._given: dict[str, Any] = {}
        self._measured: dict[str, float] = {}
        self._problems: list[Any] = []
        self._goal: Any = None
        self._view = RunView()
        self._view_goal = ""
        self._zero = 0.0
        self._news = threading.Event()
        self._recording = ""
        self._typed: str | None = None
        self._tree_shown: list[Any] = []

    # --- the page -----------------------------------------------------------------------------------------------------

    def build(self) -> None:
        page, robot = self._page, self._page.robot
        self._stored = StoredBehaviors(partial(_ask, robot), robot.describe)
        with ui.row().classes("w-full items-start gap-4"):
            with ui.card().classes("w-full lg:w-72 gap-2"):
                self._build_list()
            with ui.column().classes("grow gap-3 min-w-80").style("flex-basis: 30rem"):
                self._build_editor()
            with ui.column().classes("w-full lg:w-96 gap-3"):
                self._form = StepForm(lambda: self._described, page.work, self._edit, lambda: self._infos)
                self._form.show(None, "")
        self._listen()
        self._page.on_leave(self._cancelled.set)
        self._page.every(LOOK_PERIOD, self._look)
        ui.timer(0.05, self._load_list, once=True)

    def _build_list(self) -> None:
        self._search = ui.input("Search behaviours", on_change=lambda: self._show_list()).classes("w-full")
        self._search.props("clearable type=search")
        with ui.row().classes("gap-2"):
            ui.button("New", icon="add", on_click=self._new).props("dense no-caps")
            self._record_button = ui.button("Record", icon="fiber_manual_record", on_click=self._record)
            self._record_button.props("dense no-caps outline")
        self._list_state = ui.label("asking ...").classes("text-sm opacity-80").props("role=status")
        with ui.scroll_area().classes("w-full h-56 lg:h-[calc(100vh-20rem)]"):
            self._names = ui.list().props("dense").classes("w-full")

    def _build_editor(self) -> None:
        with ui.row().classes("w-full items-center gap-2"):
            self._title = ui.label("No behaviour is open").classes("text-xl font-medium")
            self._title.props("role=heading aria-level=2")
            self._state = ui.label("").classes("text-sm opacity-80 nao-state").props("role=status")
        with ui.row().classes("w-full items-center gap-2"):
            self._run_button = ui.button("Run", icon="play_arrow", on_click=self._start).props("no-caps")
            self._stop_button = ui.button("Stop", icon="stop", on_click=self._stop).props("no-caps outline")
            self._check_button = ui.button("Check", icon="rule", on_click=self._check).props("no-caps outline")
            self._project_button = ui.button("Project", icon="update", on_click=self._project).props("no-caps outline")
            self._project_button.tooltip("Run it on a simulated robot of its own, and take its times from there")
            self._save_button = ui.button("Save", icon="save", on_click=self._save).props("no-caps outline")
            save_as = ui.button("Save as", on_click=self._save_as).props("no-caps flat")
        buttons = (self._run_button, self._check_button, self._project_button, self._save_button, save_as)
        self._of_an_open_one = buttons
        for button in self._of_an_open_one:
            button.set_enabled(False)
        offers = ui.column().classes("w-full")
        self._parameters = ui.expansion("Parameters").classes("w-full")
        with ui.tabs().props("dense align=left no-caps") as tabs:
            tracks_tab, text_tab = ui.tab("Timeline"), ui.tab("Text")
        tabs.on_value_change(self._take_typed)
        with ui.tab_panels(tabs, value=tracks_tab, keep_alive=True).classes("w-full bg-transparent"):
            with ui.tab_panel(tracks_tab).classes("p-0 gap-2"):
                self._build_tools()
                self._canvas = TimelineCanvas(self._choose, self._edited)
                ui.label(KEYS).classes("text-xs opacity-80")
            with ui.tab_panel(text_tab).classes("p-0"):
                self._text = ui.codemirror("", language="YAML", on_change=self._typing, line_wrapping=True)
                self._text.classes("w-full border rounded").style("height: 55vh")
                self._text.props["aria-label"] = "The behaviour as YAML"
        with offers:
            self._draft = Draft(self._page, self._text, "behavior", self._take_draft)
        self._problem_list = ui.column().classes("w-full gap-1")
        self._facts = ui.column().classes("w-full gap-0")
        self._tree = ui.column().classes("w-full gap-0")
        self._tree.props["aria-label"] = "Steps of the run"

    def _build_tools(self) -> None:
        with ui.row().classes("items-center gap-1"):
            ui.button("Put in", icon="add", on_click=self._insert).props("no-caps dense outline")
            for icon, name, done in (
                ("undo", "Undo", lambda: self._key("undo", "")),
                ("redo", "Redo", lambda: self._key("redo", "")),
                ("content_copy", "Double the step", lambda: self._key("duplicate", self._selected)),
                ("delete", "Remove the step", lambda: self._key("delete", self._selected)),
                ("arrow_upward", "Sooner", lambda: self._key("sooner", self._selected)),
                ("arrow_downward", "Later", lambda: self._key("later", self._selected)),
                ("logout", "Out of its group", self._out),
                ("zoom_in", "Zoom in", lambda: self._canvas.zoom(1.25)),
                ("zoom_out", "Zoom out", lambda: self._canvas.zoom(0.8)),
                ("fit_screen", "Show all", lambda: self._canvas.zoom(0)),
            ):
                button = ui.button(icon=icon, on_click=done).props("flat dense")
                button.props["aria-label"] = name
                button.tooltip(name)

    # --- the list -----------------------------------------------------------------------------------------------------

    async def _load_list(self) -> None:
        robot = self._page.robot
        try:
            infos = await self._page.work(self._stored.infos)
        except NaoError as error:
            self._list_state.text = str(error)
            return
        self._infos = {info.name: info for info in infos}
        self._described = await self._page.ask(robot.describe_all)
        self._show_list()
        if self._document is None and self._wanted in self._infos:
            await self._open(self._wanted)

    def _show_list(self) -> None:
        words = str(self._search.value or "").lower().split()
        shown = [
            info
            for info in self._infos.values()
            if all(word in f"{info.name} {info.help} {' '.join(info.tags)}".lower() for word in words)
        ]
        more = f", the first {MOST_SHOWN} of them here" if len(shown) > MOST_SHOWN else ""
        self._list_state.text = f"{len(shown)} of {len(self._infos)} behaviours{more}"
        self._names.clear()
        with self._names:
            for info in shown[:MOST_SHOWN]:
                item = ui.item(on_click=lambda name=info.name: self._open(name)).classes("rounded")
                item.props["aria-label"] = f"Open {info.name}: {info.help}"
                with item:
                    with ui.item_section():
                        ui.item_label(info.name).classes("font-medium")
                        ui.item_label(info.problem or info.help).props("caption lines=2")
                    with ui.item_section().props("side"):
                        ui.badge("library" if info.shipped else "yours").props("outline")

    async def _open(self, name: str) -> None:
        if self._document is not None and self._document.changed and not await sure("Leave the changes unsaved?"):
            return
        try:
            text, shipped = await self._page.ask(self._stored.text, name)
            document = await self._page.work(BehaviorDocument, name, text, shipped)
        except NaoError as error:
            ui.notify(str(error), type="negative", multi_line=True)
            return
        await self._take(document)

    async def _new(self) -> None:
        if self._document is not None and self._document.changed and not await sure("Leave the changes unsaved?"):
            return
        await self._take(await self._page.work(BehaviorDocument.new))

    async def _take(self, document: BehaviorDocument) -> None:
        """Show another behaviour."""
        self._document = document
        for button in self._of_an_open_one:
            button.set_enabled(True)
        self._selected, self._given, self._measured, self._problems = "", {}, {}, []
        self._facts.clear()
        self._tree.clear()
        if self._goal is None:
            self._view = RunView()
        self._parameters.clear()
        self._draft.of(document.name, document.stored_text)
        await self._refresh(whole=True)
        await self._show_parameters()

    # --- edits --------------------------------------------------------------------------------------------------------

    def _choose(self, path: str) -> None:
        self._selected = path
        self._show_step()

    async def _edited(self, name: str, told: Mapping[str, Any]) -> None:
        """What was done on the tracks, as the browser tells it."""
        document = self._document
        if document is None:
            return
        path = str(told["path"])
        if name == "shift":
            await self._edit(lambda: document.shift(path, float(told["seconds"])))
        elif name == "stretch":
            await self._edit(lambda: document.stretch(path, float(told["former"]), float(told["seconds"])))
        elif name == "move":
            target, inside, after = str(told["target"]), bool(told["inside"]), bool(told["after"])
            await self._edit(lambda: document.move(path, target, inside, after))
        elif name == "key":
            await self._key(str(told["key"]), path)

    async def _key(self, key: str, path: str) -> None:
        document = self._document
        if document is None:
            return
        if key in ("undo", "redo"):
            await self._edit(document.undo if key == "undo" else document.redo)
        elif not path:
            ui.notify("choose a step first")
        elif key == "delete":
            await self._edit(lambda: document.delete(path))
        elif key == "duplicate":
            await self._edit(lambda: self._select(document.duplicate(path)))
        elif key in ("sooner", "later"):
            await self._edit(lambda: self._select(document.reorder(path, 1 if key == "later" else -1)))
        elif key == "edit":
            self._form.focus()

    def _select(self, path: str) -> None:
        self._selected = path

    async def _out(self) -> None:
        document, path = self._document, self._selected
        if document is None or "." not in path:
            ui.notify("choose a step in a group first")
            return
        group = path.rpartition(".")[0]
        await self._edit(lambda: document.move(path, group))

    def _insert(self) -> None:
        document = self._document
        if document is None:
            ui.notify("open a behaviour first, or begin a new one")
            return
        places = [LAST]
        box = self._tracks.box(self._selected)
        if box is not None:
            places = [
                BEHIND,
                *([INSIDE] if box.kind in ("parallel", "race", "timeline", "repeat", "sequence") else []),
                LAST,
            ]

        async def put(step: Any, place: str) -> None:
            path = "" if place == LAST else self._selected
            group = box if place == INSIDE else self._tracks.box(path.rpartition(".")[0])
            begin = (box.end - group.begin) if box is not None and group is not None else 0.0
            await self._edit(lambda: self._select(document.insert(step, path, place == INSIDE, begin)))

        described = {server: told for server, told in self._described.items() if server != SERVER}
        InsertDialog(described, sorted(self._infos), places, put, self._page.work)

    async def _edit(self, edit: Callable[[], Any], text_too: bool = True) -> None:
        """Carry out an edit of the document, or tell why it is refused."""
        async with self._editing:
            try:
                await self._page.work(edit)
            except (EditRefused, NaoError) as error:
                ui.notify(str(error), type="warning", multi_line=True)
        self._problems = []
        self._facts.clear()  # they are of the text before
        await self._refresh(text_too)

    def _typing(self, event: Any) -> None:
        self._typed = event.value

    async def _take_draft(self, text: str, _revision: str) -> None:
        """A draft is wanted: it becomes the text, and the text before is a step back."""
        document = self._document
        if document is not None:
            self._typed = None
            await self._edit(lambda: document.set_text(text))
            await self._show_parameters()

    async def _take_typed(self) -> None:
        """Make what was typed as text the text of the behaviour."""
        typed, self._typed = self._typed, None
        if self._document is not None and typed is not None and typed != self._document.text:
            document = self._document
            await self._edit(lambda: document.set_text(typed), text_too=False)
            await self._show_parameters()

    async def _refresh(self, text_too: bool = True, whole: bool = False) -> None:
        """Show the document as it is now. `whole`: zoom such that all of it is seen."""
        document = self._document
        if document is None:
            return
        if not document.has(self._selected or "0"):
            self._selected = ""
        try:
            self._tracks = await self._page.work(
                tracks_of, document, self._stored.load, self._stored.tables, self._texts(), self._measured,
                self._problems,
            )  # fmt: skip
        except NaoError as error:
            self._tracks = Tracks()
            ui.notify(str(error), type="negative", multi_line=True)
        self._title.text = document.name or "A new behaviour"
        self._state.text = ", ".join(
            filter(None, ("of the library" if document.shipped else "", "changed" if document.changed else ""))
        )
        if text_too and self._text.value != document.text:
            self._text.value = document.text
        self._draft.keep(document.text)
        self._canvas.show(self._tracks, self._selected, whole)
        self._show_step()
        self._show_problems([*document.problems, *self._problems])

    def _show_step(self) -> None:
        box = self._tracks.box(self._selected)
        self._form.show(self._document, self._selected, box.problem if box is not None else "")

    async def _show_parameters(self) -> None:
        """Inputs for the values with which it runs here."""
        document = self._document
        behavior = document.behavior if document is not None else None
        if behavior is None:
            return
        fields = form_of_behavior(behavior)
        self._given = {name: value for name, value in self._given.items() if name in behavior.parameters}
        self._parameters.clear()
        self._parameters.set_visibility(bool(fields))
        with self._parameters:
            FieldInputs(fields, self._page.work, self._given, self._give, "parameter")

    async def _give(self, name: str, value: Any) -> None:
        if value is None:
            self._given.pop(name, None)
        else:
            self._given[name] = value
        await self._refresh()

    def _texts(self) -> list[str]:
        return [f"{name}={text_of(value)}" for name, value in self._given.items()]

    # --- check and projection -----------------------------------------------------------------------------------------

    async def _check(self) -> bool:
        """Have it checked, and show what comes of that; whether it can be run."""
        await self._take_typed()
        document = self._document
        if document is None:
            ui.notify("open a behaviour first")
            return False
        try:
            info = await self._page.work(self._stored.check, document.text, document.file, self._texts())
        except NaoError as error:
            ui.notify(f"not checked: {error}", type="negative", multi_line=True)
            return False
        self._problems = problems_in(info)
        await self._refresh()
        self._show_problems(self._problems)
        self._facts.clear()
        if not self._problems:
            self._show_facts(info)
        return not self._problems

    def _show_problems(self, problems: list[Any]) -> None:
        if self._document is not None:
            own = [each for each in problems if each.file in ("", self._document.file)]
            self._text.decorations = marks_of(self._document.text, own[:MOST_PROBLEMS])
        self._problem_list.clear()
        with self._problem_list:
            for problem in list(dict.fromkeys(map(str, problems)))[:MOST_PROBLEMS]:
                with ui.row().classes("items-start no-wrap gap-2").props("role=alert"):
                    ui.icon("error", color="negative")
                    ui.label(problem).classes("break-words")

    def _show_facts(self, info: Any) -> None:
        with self._facts:
            unvalidated = list(info.unvalidated)
            told = "Its text is right, but not all of its servers have checked it:" if unvalidated else "It can be run."
            ui.label(told).classes("font-medium")
            for text in unvalidated:
                ui.label(text).classes("text-sm")
            about = {"servers": ", ".join(info.servers), "boxes": ", ".join(info.boxes)}
            about["waits"] = f"{info.waits:g} s, beside what its goals take" if info.waits else ""
            for name, text in about.items():
                if text:
                    ui.label(f"{name}: {text}").classes("text-sm")
            if info.steps:
                with ui.expansion("What it would do").classes("w-full"):
                    ui.label("\n".join(info.steps)).classes("whitespace-pre-wrap font-mono text-xs break-words")
            if info.unchecked:
                with ui.expansion("Not known until it runs").classes("w-full"):
                    ui.label("\n".join(info.unchecked)).classes("whitespace-pre-wrap font-mono text-xs break-words")

    async def _project(self) -> None:
        await self._take_typed()
        document = self._document
        if document is None or not self._page.visitor.operator:
            ui.notify("open a behaviour first" if document is None else "observers look on: an operator may do this")
            return
        if not self._projecting.acquire(blocking=False):
            ui.notify("a projection goes on already: one at a time", type="warning")
            return
        self._cancelled.clear()
        with ui.dialog().props("persistent") as dialog, ui.card():
            ui.label("It runs on a simulated robot of its own, faster than real time. Nothing moves here.")
            with ui.row().classes("items-center"):
                ui.spinner()
                ui.button("Cancel", on_click=self._cancelled.set).props("outline").classes("nao-close")
        dialog.open()
        given = self._texts()
        try:
            done = await self._page.ask(self._projected, document.text, document.file, given)
        except NotProjected as error:
            ui.notify(f"No projection: {error}", type="negative", multi_line=True)
            return
        finally:
            remove_dialog(dialog)
        self._measured = {**self._measured, **done.lengths}
        await self._refresh()
        kind = "positive" if done.state == "succeeded" else "negative"
        told = [f"{done.state} after {done.duration:.1f} s of simulated time", done.text, *done.failures]
        ui.notify("\n".join(filter(None, told)), type=kind, multi_line=True, timeout=8000, close_button="Close")
        self._state.text = f"times of a projection: {done.duration:.1f} s, {done.state}"

    def _projected(self, text: str, file: str, given: list[str]) -> Any:
        try:
            return project_behavior(text, file, given, self._cancelled)
        finally:
            self._projecting.release()

    # --- runs ---------------------------------------------------------------------------------------------------------

    def _listen(self) -> None:
        from nao_library_actions.msg import NaoBehaviorActionFeedback

        topic = partial(self._page.robot.topic, f"{SERVER}/feedback", NaoBehaviorActionFeedback, self._told, 100)
        feedback = Subscriptions(f"behaviours of {self._page.robot.name}")
        feedback.begin(topic)
        self._page.on_leave(feedback.end)

    def _told(self, message: Any) -> None:
        """Feedback of a behaviour, whoever runs it. Called from a thread of the subscriber."""
        goal = message.status.goal_id.id
        if not message.feedback.path:
            return  # a function that runs no behaviour, or has not begun it
        if goal != self._view_goal:
            self._view_goal, self._view = goal, RunView()
        feedback = message.feedback
        self._zero = feedback.stamp.to_sec() - feedback.time
        self._view.told(feedback)
        self._news.set()

    async def _start(self) -> None:
        stops = self._page.robot.stops
        await self._take_typed()
        document = self._document
        if document is None:
            ui.notify("open a behaviour first")
            return
        if not self._page.operate("Run"):
            return
        fields = {"text": document.text, "file": document.file, "parameters": self._texts()}
        command = call(SERVER, "runBehavior", **fields)
        self._goal = await self._send(command, f"behaviour {document.name or 'new'}", stops)

    async def _send(self, command: RobotCommand, label: str, stops: int | None = None) -> Any:
        """Send a goal; its run, None if that cannot be, which is told. `stops`: of the robot when it was asked for."""
        return await self._page.send(label, command, label, stops)

    async def _done(self, goal: Run) -> bool:
        """Whether a goal that takes no time has succeeded; what has failed is told."""
        if not await self._page.ask(goal.wait, STORE_LIMIT):
            self._page.failed(goal.label, f"{goal.server} does not answer within {STORE_LIMIT:g} s")
        return goal.succeeded

    def _stop(self) -> None:
        """End the behaviour that runs, also one that another program has sent, whoever holds the controls."""
        if not self._page.visitor.operator:
            self._page.failed("Stop", "observers look on: an operator may do this")
            return
        for goal in self._page.robot.runs:
            if goal.server == SERVER:
                goal.cancel()

    def _look(self) -> None:
        """Show what runs."""
        goals = [goal for goal in self._page.robot.runs if goal.server == SERVER]
        self._stop_button.set_enabled(bool(goals))
        over = self._goal is not None and self._goal.done
        if over:
            self._view.end()
        elif not goals and self._goal is None and self._view.running:
            self._view.end()
            self._news.set()
        if self._news.is_set() or over or self._view.running:
            self._news.clear()
            self._show_run()
        if over:
            goal, self._goal = self._goal, None
            self._ended(goal)

    def _show_run(self) -> None:
        ours = self._document is not None and self._view.behavior in (self._document.name, "new", "text")
        if ours:
            now = self._page.robot.now() - self._zero
            at = self._view.cursor(self._tracks, now) if self._view.running else None
            self._canvas.mark(self._view.states(), at)
        lines = self._view.tree()
        shown = [(line.path, line.state, line.text) for line in lines]
        if shown == self._tree_shown:
            return
        self._tree_shown = shown
        self._tree.clear()
        with self._tree:
            if lines:
                ui.label(f"Run of {self._view.behavior}").classes("font-medium")
            for line in lines[-TREE_LINES:]:
                _tree_line(line)

    def _ended(self, goal: Any) -> None:
        """Tell how the behaviour went that was run here."""
        if goal.succeeded:
            self._measured = {**self._measured, **self._view.measured()}
        self._state.text = "it has run" if goal.succeeded else end_of(goal.state).word

    # --- storing ------------------------------------------------------------------------------------------------------

    async def _save(self) -> None:
        document = self._document
        if document is None:
            ui.notify("open a behaviour first, or begin a new one")
        elif document.shipped or not document.name:
            await self._save_as()
        else:
            await self._store(document.name, overwrite=True)

    async def _save_as(self) -> None:
        document = self._document
        if document is None:
            ui.notify("open a behaviour first, or begin a new one")
            return
        suggested = f"my_{document.name}" if document.name else ""
        name = await _ask_name("Save as", suggested, "letters, digits, '_' and '-'")
        if not name:
            return
        there = self._infos.get(name)
        if there is not None and there.shipped:
            ui.notify(f"{name!r} comes with the library and is not replaced: choose another name", type="negative")
            return
        if there is not None and not await sure(f"Replace your behaviour {name}?"):
            return
        await self._store(name, overwrite=there is not None)

    async def _store(self, name: str, overwrite: bool) -> None:
        await self._take_typed()
        document = self._document
        if document is None or not self._page.operate("Save"):
            return
        running = [goal for goal in self._page.robot.runs if goal.server == SERVER]
        if running:
            ui.notify(f"{running[0].label} runs, and storing would end it: stop it, or wait", type="warning")
            return
        fields = {"str_param": name, "text": document.text, "overwrite": overwrite}
        goal = await self._send(call(SERVER, "storeBehavior", **fields), f"store {name}")
        if goal is None:
            return
        if not await self._done(goal):
            return
        document.stored(name)
        self._draft.of(name, document.text)
        ui.notify(goal.text or f"stored as {name}", type="positive")
        await self._load_list()
        await self._refresh()

    # --- recording ----------------------------------------------------------------------------------------------------

    async def _record(self) -> None:
        if not self._page.operate("Record"):
            return
        if self._recording:
            await self._end_recording()
            return
        name = await _ask_name("Record as", "", "what is sent to the servers from now on is kept, with its times")
        if not name:
            return
        if name in self._infos and self._infos[name].shipped:
            ui.notify(f"{name!r} comes with the library: choose another name", type="negative")
            return
        goal = await self._send(call(SERVER, "recordBehavior", str_param=name), f"record {name}")
        if goal is None:
            return
        if not await self._done(goal):
            return
        self._recording = name
        self._record_button.text = f"End the recording {name}"
        self._record_button.props("color=negative")

    async def _end_recording(self) -> None:
        goal = await self._send(call(SERVER, "stopRecording"), f"end the recording {self._recording}")
        if goal is None:
            return
        done = await self._done(goal)
        name, self._recording = self._recording, ""
        self._record_button.text = "Record"
        self._record_button.props(remove="color=negative")
        if not done:
            return
        answer = list(goal.result.get("memList") or [name, "?"])
        ui.notify("; ".join([f"{answer[0]}: {answer[1]} goals", *answer[2:]]), type="positive", multi_line=True)
        await self._load_list()
        await self._open(answer[0])


def _ask(robot: Any, **fields: Any) -> Any:
    from nao_library_msgs.srv import ListBehaviors

    return robot.call(f"{SERVER}/list", ListBehaviors, **fields)


def _tree_line(line: StepLine) -> None:
    icon, state = SIGNS.get(line.state, ("radio_button_unchecked", line.state))
    wrong = line.state in ("failed", "skipped")
    with ui.row().classes("items-center no-wrap gap-2").style(f"padding-left: {1.2 * line.depth}rem"):
        ui.icon(icon, color="negative" if wrong else "primary" if line.running else "")
        took = f", {line.ended - line.began:.1f} s" if line.ended >= line.began >= 0.0 else ""
        label = f" ({line.label})" if line.label else ""
        ui.label(f"{line.path} {line.what}{label}: {state}{took}").classes("text-sm")
        if line.text:
            ui.label(line.text).classes("text-xs opacity-80 break-words")


async def _ask_name(title: str, suggested: str, hint: str) -> str:
    """A name that somebody types; empty: none."""
    with ui.dialog() as dialog, ui.card().classes("w-96"):
        ui.label(title).classes("text-lg font-medium")
        name = ui.input("Name", value=suggested).props("autofocus").classes("w-full")
        name.props["hint"] = hint
        name.on("keydown.enter", lambda: dialog.submit(name.value))
        with ui.row():
            ui.button("OK", on_click=lambda: dialog.submit(name.value))
            ui.button("Cancel", on_click=lambda: dialog.submit("")).props("flat")
    answer = await dialog
    remove_dialog(dialog)
    return str(answer or "").strip()
