"""The form of one step of a behaviour: its fields as the servers declare them, and what every step may have."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import SimpleNamespace
from typing import Any

from nicegui import ui

from ..robots.forms import FormField, form_of, form_of_parameters
from ..timeline.document import BehaviorDocument
from ..timeline.steps import functions_in, kind_of_step
from .field_inputs import FieldInputs, Work

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
