"""The dialog that puts a step into a behaviour: any function of any server, or one of the kinds of steps."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Mapping
from typing import Any

from nicegui import ui

from ..robots.forms import form_of
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
