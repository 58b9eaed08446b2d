"""Inputs for the fields of a function, or for the parameters of a behaviour, with what there is to say about each."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Mapping, Sequence
from typing import Any

from nicegui import ui

from ...behaviors.strict_yaml import dump_line
from ..robots.forms import EXPRESSION, FormField, text_of_value, typed_value, value_of

UNITLESS = ("", "no unit")
LONGEST = 20_000
"""Characters of one input; longer values belong into a behaviour's text."""
SHORT = 200
"""Characters that are read in the event loop; longer ones, which may be YAML, are read beside it."""
Work = Callable[..., Awaitable[Any]]
"""Calls a function beside the event loop."""


class FieldInputs:
    """The inputs of a form, in the container that is open.

    Args:
        fields: What is asked for.
        work: Reads what takes a while, as `PageContext.work` does.
        given: Values of some of them.
        changed: Called with name and value, None for the default, when somebody has entered another one.
        prefix: What accessible names begin with.
    """

    def __init__(
        self,
        fields: Sequence[FormField],
        work: Work,
        given: Mapping[str, Any] | None = None,
        changed: Callable[[str, Any], Any] | None = None,
        prefix: str = "",
    ) -> None:
        self._fields = {field.name: field for field in fields}
        self._work = work
        self._given = dict(given or {})
        self._changed = changed
        self._prefix = prefix
        self._inputs: dict[str, Any] = {}
        self._entered: dict[str, Any] = {}
        with ui.column().classes("w-full gap-2"):
            for field in fields:
                self._inputs[field.name] = self._input(field)
            if not fields:
                ui.label("It takes nothing.").classes("text-sm opacity-80")

    async def values(self) -> dict[str, Any]:
        """Name -> value of all that is filled in. Raises ValueError with what is wrong with one."""
        values = {}
        for name, field in self._fields.items():
            value = await self._value(field)
            if value is not None:
                values[name] = value
        return values

    # --- one field ----------------------------------------------------------------------------------------------------

    def _input(self, field: FormField) -> Any:
        given = self._given.get(field.name)
        calculated = EXPRESSION in (given if isinstance(given, str) else dump_line(given) if given is not None else "")
        if field.type == "bool" and not field.repeated and not calculated:
            return self._switch(field, given)
        if field.choices and not calculated:
            return self._select(field, given)
        return self._text(field, given)

    def _switch(self, field: FormField, given: Any) -> Any:
        shown = bool(field.default) if given is None else bool(given)
        with ui.column().classes("w-full gap-0"):
            switch = ui.switch(field.name, value=shown)
            self._name(switch, field)
            if field.hint:
                ui.label(field.hint).classes("text-xs opacity-80 pl-2")
        switch.on_value_change(lambda: self._enter(field))
        return switch

    def _select(self, field: FormField, given: Any) -> Any:
        values = _listed(given) if field.repeated else given
        extra = [each for each in _listed(values) if each not in field.choices and each != ""]
        select = ui.select(
            [*field.choices, *extra],
            label=_label(field),
            value=values if field.repeated else values or None,
            multiple=field.repeated,
            with_input=True,
            new_value_mode="add-unique",
            clearable=True,
        ).classes("w-full")
        select.props("use-chips" if field.repeated else "")
        select.props["hint"] = field.hint
        self._name(select, field)
        select.on_value_change(lambda: self._enter(field))
        return select

    def _text(self, field: FormField, given: Any) -> Any:
        async def wrong(text: str | None) -> str | None:
            try:
                await self._typed(field, text or "")
            except ValueError as error:
                return str(error)
            return None

        shown = "" if given is None else text_of_value(field, given)
        default = "" if field.default in (None, "", [], False) else text_of_value(field, field.default)
        entry = ui.input(_label(field), value=shown, placeholder=default or None, validation=wrong).classes("w-full")
        entry.props["hint"] = field.hint
        if field.unit not in UNITLESS and len(field.unit) <= 8:
            entry.props["suffix"] = field.unit
        if self._prefix:
            entry.props["aria-label"] = f"{self._prefix} {field.name}"
        entry.on("blur", lambda: self._enter(field))
        entry.on("keydown.enter", lambda: self._enter(field))
        self._entered[field.name] = shown
        return entry

    def _name(self, element: Any, field: FormField) -> None:
        element.props["aria-label"] = f"{self._prefix} {field.name}: {field.hint}".strip()

    async def _value(self, field: FormField) -> Any:
        shown = self._inputs[field.name].value
        if isinstance(shown, bool):
            return shown if shown != bool(field.default) or field.name in self._given else None
        if isinstance(shown, list):
            return [value_of(_single(field), str(each)) for each in shown] or None
        return await self._typed(field, str(shown or ""))

    async def _typed(self, field: FormField, text: str) -> Any:
        """The value of a text; None if it is empty. Raises ValueError."""
        if len(text) > LONGEST:
            raise ValueError(f"{field.name}: {len(text)} characters; at most {LONGEST} are read here")
        if not text.strip():
            return None
        return typed_value(field, text) if len(text) <= SHORT else await self._work(typed_value, field, text)

    async def _enter(self, field: FormField) -> None:
        """Tell of a value that is another one than before, if it will do."""
        if self._changed is None:
            return
        shown = self._inputs[field.name].value
        kept = list(shown) if isinstance(shown, list) else shown
        if self._entered.get(field.name, self._given.get(field.name)) == kept:
            return
        try:
            value = await self._value(field)
        except ValueError:
            return  # the input tells it
        self._entered[field.name] = kept
        told = self._changed(field.name, value)
        if isinstance(told, Awaitable):
            await told


def _single(field: FormField) -> FormField:
    return FormField(field.name, field.type, low=field.low, high=field.high, unit=field.unit, allowed=field.allowed)


def _listed(value: Any) -> list[Any]:
    if value is None:
        return []
    return [str(each) for each in value] if isinstance(value, list) else [value]


def _label(field: FormField) -> str:
    return f"{field.name} (list)" if field.repeated else field.name
