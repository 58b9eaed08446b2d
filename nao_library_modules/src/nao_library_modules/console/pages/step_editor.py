"""Parts of the page "Behaviours": the timeline, the form of a step, and the dialog that inserts a step."""

from __future__ import annotations

import json
from collections.abc import Awaitable, Callable, Mapping
from types import SimpleNamespace
from typing import Any

from nicegui import ui

from ..robots.forms import FormField, form_of, form_of_parameters
from ..timeline.document import BehaviorDocument, functions_in, kind_of_step
from ..timeline.tracks import Tracks
from .field_inputs import FieldInputs, Work

FUNCTION, BOX = "a function of a server", "another behaviour"
KINDS: Mapping[str, Any] = {
    "wait": {"wait": 1.0},
    "parallel: steps at the same time": {"parallel": [{"wait": 1.0}]},
    "race: steps at the same time, until the first is over": {"race": [{"wait": 1.0}, {"wait": 2.0}]},
    "timeline: steps at given times": {"timeline": [{"wait": 1.0, "at": 0.0}]},
    "repeat: steps several times": {"repeat": 2, "do": [{"wait": 1.0}]},
    "do: steps one after the other": {"do": [{"wait": 1.0}]},
    "barrier: branches wait for each other": {"barrier": "all"},
}
BEHIND, INSIDE, LAST = "behind the chosen step", "inside of the chosen step", "at the end"


class InsertDialog:
    """Asks what is put in, and where.

    Args:
        described: DescribeFunctionsResponse of each server.
        behaviors: Names of behaviours.
        places: Those of BEHIND, INSIDE and LAST that there are.
        put: Called with the step and the place.
        work: As `FieldInputs` takes it.
    """

    def __init__(
        self,
        described: Mapping[str, Any],
        behaviors: list[str],
        places: list[str],
        put: Callable[[Any, str], Awaitable[None]],
        work: Work,
    ) -> None:
        self._described = described
        self._behaviors = behaviors
        self._put = put
        self._work = work
        self._inputs: FieldInputs | None = None
        with ui.dialog() as self._dialog, ui.card().classes("w-full max-w-xl gap-3"):
            ui.label("Put in a step").classes("text-lg font-medium").props("role=heading aria-level=2")
            self._place = ui.radio(places, value=places[0]).props("inline")
            self._place.props["aria-label"] = "Where"
            options = [FUNCTION, BOX, *KINDS]
            self._kind = ui.select(options, value=FUNCTION, label="What", on_change=self._ask).classes("w-full")
            self._more = ui.column().classes("w-full gap-2")
            with ui.row():
                ui.button("Put in", icon="add", on_click=self._done)
                ui.button("Cancel", on_click=self._dialog.close).props("flat")
        self._dialog.on("hide", self._dialog.delete)
        self._ask()
        self._dialog.open()

    def _ask(self) -> None:
        self._more.clear()
        self._inputs = None
        with self._more:
            if self._kind.value == FUNCTION:
                names = {
                    f"{server}.{function.name}": f"{server}.{function.name} – {function.help}"
                    for server, told in self._described.items()
                    for function in told.functions
                }
                self._which = ui.select(names, label="Function (type to search)", with_input=True).classes("w-full")
                self._which.on_value_change(self._ask_fields)
                self._fields = ui.column().classes("w-full")
            elif self._kind.value == BOX:
                self._which = ui.select(self._behaviors, label="Behaviour", with_input=True).classes("w-full")

    def _ask_fields(self) -> None:
        self._fields.clear()
        self._inputs = None
        server, _, name = str(self._which.value or "").partition(".")
        found = [each for each in self._described[server].functions if each.name == name] if name else []
        with self._fields:
            for function in found:
                self._inputs = FieldInputs(form_of(function), self._work)

    async def _done(self) -> None:
        try:
            step = await self._step()
        except ValueError as error:
            ui.notify(str(error), type="negative")
            return
        self._dialog.close()
        await self._put(step, self._place.value)

    async def _step(self) -> Any:
        if self._kind.value in KINDS:
            return KINDS[self._kind.value]
        if not self._which.value:
            raise ValueError(f"{self._kind.value} is not chosen yet")
        if self._kind.value == BOX:
            return {"behavior": self._which.value}
        return {self._which.value: await self._inputs.values() if self._inputs is not None else {}}


LABEL = FormField("label", "string", "a name, for times and for the result: letters, digits, '_' and '-'")
ON_ERROR = FormField("on_error", "string", "what a failure does", choices=("stop", "skip", "retry 2", "retry 2 skip"))
FOR = FormField("for", "number", "ends it after this time, as if it were done", "s", low=0.0)
AT = FormField("at", "string", "when it begins: s, LABEL, LABEL.end, or one of these with '+ seconds'")
WAIT = FormField("wait", "number", "lets time pass", "s", low=0.0)
REPEAT = FormField("repeat", "number", "how many rounds", low=0.0)
AS = FormField("as", "string", "parameter that has the number of the round; empty: none")
BARRIER = FormField("barrier", "string", "its name")
TIME = "time"


class StepForm:
    """Inputs for the chosen step, in a container of its own.

    Args:
        described: Gives the DescribeFunctionsResponse of the servers, by name, as far as they are known.
        work: As `FieldInputs` takes it.
        edit: Carries out an edit of the document and tells what is refused.
        infos: BehaviorInfo by name, for boxes.
    """

    def __init__(
        self,
        described: Callable[[], Mapping[str, Any]],
        work: Work,
        edit: Callable[[Callable[[], Any]], Any],
        infos: Callable[[], Mapping[str, Any]],
    ) -> None:
        self._described_servers = described
        self._work = work
        self._edit = edit
        self._infos = infos
        self._shown: tuple[str, Any] = ("", None)
        self._card = ui.card().classes("w-full gap-3")
        self._card.props["aria-label"] = "The chosen step"
        self._card.props["role"] = "region"

    def focus(self) -> None:
        """Put the focus into the first input."""
        ui.run_javascript(f"document.getElementById('{self._card.html_id}')?.querySelector('input')?.focus()")

    def show(self, document: BehaviorDocument | None, path: str, problem: str = "") -> None:
        """Show a step as it is now; nothing if there is none."""
        step = document.step(path) if document is not None and path and document.has(path) else None
        if step is None:
            self._shown = ("", None)
            self._card.clear()
            with self._card:
                ui.label("Choose a step on the tracks to edit it.").classes("opacity-80")
            return
        assert document is not None
        seen = (path, (step, problem))
        if seen == self._shown:
            return
        self._shown = seen
        self._card.clear()
        with self._card:
            kind = kind_of_step(step)
            ui.label(f"Step {path}: {kind}").classes("text-lg font-medium").props("role=heading aria-level=2")
            if problem:
                ui.label(problem).classes("text-negative break-words").props("role=alert")
            self._functions(document, path, step)
            self._own(document, path, step, kind)
            if isinstance(step, dict):
                self._general(document, path, step, kind)

    def _functions(self, document: BehaviorDocument, path: str, step: Any) -> None:
        for number, (server, function, given, _) in enumerate(functions_in(step)):
            told = self._described(server, function)
            if told is None:
                ui.label(f"{server}.{function} is not described: edit it as text.").classes("text-sm")
                continue
            described, common = told
            fields = [*form_of(described), *(each for each in common if each.name == TIME)]
            known = {field.name for field in fields}
            fields += [FormField(name, "any") for name in given if name not in known and name != "function"]
            if len(functions_in(step)) > 1:
                ui.label(f"{number + 1}. {function}").classes("font-medium")
            ui.label(described.help).classes("text-sm opacity-80")
            FieldInputs(
                fields,
                self._work,
                given,
                lambda name, value, n=number: self._edit(lambda: document.set_field(path, n, name, value)),
                f"step {path}",
            )

    def _described(self, server: str, function: str) -> tuple[Any, list[FormField]] | None:
        told = self._described_servers().get(server)
        if told is None:
            return None
        found = [each for each in told.functions if each.name == function]
        return (found[0], form_of(SimpleNamespace(arguments=told.common))) if found else None

    def _own(self, document: BehaviorDocument, path: str, step: Any, kind: str) -> None:
        fields = {"wait": [WAIT], "repeat": [REPEAT, AS], "barrier": [BARRIER]}.get(kind, [])
        if kind == "behavior":
            fields = [FormField("behavior", "string", "the behaviour that runs here", choices=tuple(self._infos()))]
        if fields:
            self._keys(document, path, step, fields)
        if kind == "behavior" and step["behavior"] in self._infos():
            parameters = form_of_parameters(self._infos()[step["behavior"]].parameters)
            ui.label("Parameters").classes("font-medium")
            FieldInputs(
                parameters,
                self._work,
                step.get("parameters") or {},
                lambda name, value: self._edit(lambda: document.set_parameter(path, name, value)),
                f"step {path}",
            )

    def _general(self, document: BehaviorDocument, path: str, step: Any, kind: str) -> None:
        fields = [LABEL, ON_ERROR, FOR] if kind != "barrier" else [FOR]
        if document.in_timeline(path) and kind != "barrier":
            fields.insert(0, AT)
        if not fields:
            return
        ui.separator()
        self._keys(document, path, step, fields)

    def _keys(self, document: BehaviorDocument, path: str, step: Any, fields: list[FormField]) -> None:
        FieldInputs(
            fields,
            self._work,
            {field.name: step[field.name] for field in fields if field.name in step},
            lambda name, value: self._edit(lambda: document.set_key(path, name, _time(name, value))),
            f"step {path}",
        )


def _time(name: str, value: Any) -> Any:
    """A value of `at` as a number where it is one."""
    if name != AT.name or not isinstance(value, str):
        return value
    try:
        return float(value)
    except ValueError:
        return value


MODULE = "/console/static/timeline.js"
KEYS = (
    "Arrow keys choose a step; Shift+Left and Shift+Right move it; [ and ] make it shorter and longer, { and } by 1 s; "
    "D doubles it, Delete removes it, Enter edits it; + and - zoom, 0 shows all; Ctrl+Z and Ctrl+Y undo and redo."
)


class TimelineCanvas:
    """Tracks in the container that is open.

    Args:
        chosen: Called with the path of a step that was chosen.
        edited: Called with the name of an edit (shift, stretch, move, key) and what belongs to it.
    """

    def __init__(self, chosen: Callable[[str], Any], edited: Callable[[str, Mapping[str, Any]], Any]) -> None:
        self._element = ui.element("div").classes("nao-timeline w-full").style("max-height: 48vh; min-height: 7rem")
        self._element.props["role"] = "group"
        self._element.props["aria-label"] = f"Tracks of the behaviour. {KEYS}"
        self._servers = ui.row().classes("gap-3 items-center")
        emit = "(event) => emit(event.detail)"
        self._element.on("tlselect", lambda event: chosen(str(event.args["path"])), js_handler=emit)
        self._shown: list[str] = []
        for name in ("shift", "stretch", "move", "key"):
            self._element.on(f"tl{name}", lambda event, name=name: edited(name, event.args), js_handler=emit)

    def show(self, tracks: Tracks, selected: str, whole: bool = False) -> None:
        """Draw tracks. `whole`: zoom such that all of them are seen."""
        self._call("show", tracks.to_json(), selected, whole)
        servers = sorted({box.server for box in tracks.boxes if box.server}, key=str.lower)
        if servers != self._shown:
            self._shown = servers
            self._servers.clear()
            with self._servers:
                for server in servers:
                    with ui.row().classes("items-center gap-1 no-wrap"):
                        ui.element("span").classes("tl-colour").props["data-server"] = server
                        ui.label(server).classes("text-xs")

    def mark(self, states: Mapping[str, str], at: float | None) -> None:
        """Show states of steps by path, and a cursor. `at`: s from the beginning; None: no cursor."""
        self._call("mark", dict(states), at)

    def zoom(self, factor: float) -> None:
        """Zoom; 0: to the whole."""
        self._call("zoom", factor)

    def _call(self, name: str, *arguments: Any) -> None:
        given = ", ".join(map(json.dumps, (self._element.html_id, *arguments)))
        with self._element:
            ui.run_javascript(f"import({json.dumps(MODULE)}).then((timeline) => timeline.{name}({given}))")
