"""The participants of a study on the page of trials: a mistyped pseudonym is corrected, or taken back."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from typing import Any

from nicegui import ui

from naoqi.errors import NaoError

from ...study.participants import Participant, participants_of
from ...study.protocol import StudyProtocol
from ...study.studies import Studies
from ..frame import sure

MOST_SHOWN = 100
"""Participants in the list, the newest."""


class ParticipantsCard:
    """The list of them. `changed`: called when a pseudonym is another one."""

    def __init__(self, page: Any, studies: Studies, changed: Callable[[], Awaitable[None]]) -> None:
        self._page, self._studies, self._changed = page, studies, changed
        self._protocol: StudyProtocol | None = None
        self._shown: tuple[StudyProtocol, list[Participant]] | None = None
        with ui.card().classes("w-full max-h-[40vh] overflow-auto") as self._box:
            ui.label("Participants").classes("text-h6")
            ui.label("A mistyped pseudonym can be corrected; while nothing was played, it can be taken back.")
            self._rows = ui.column().classes("w-full gap-1")
        self._box.set_visibility(False)

    async def show(self, protocol: StudyProtocol) -> None:
        """Show those of a study."""
        self._protocol = protocol
        try:
            found = await self._page.work(participants_of, self._studies.files, protocol.name)
        except (NaoError, OSError) as error:
            ui.notify(str(error), type="negative")
            return
        if self._rows.is_deleted or protocol is not self._protocol or self._shown == (protocol, found):
            return  # what somebody types beside a name stays
        self._shown = (protocol, found)
        self._rows.clear()
        self._box.set_visibility(bool(found))
        with self._rows:
            for each in found[-MOST_SHOWN:]:
                self._row(each, protocol)

    def _row(self, each: Participant, protocol: StudyProtocol) -> None:
        number = "" if protocol.blind else f"number {each.number}, "
        with ui.row().classes("items-center"):
            ui.label(f"{each.pseudonym}: {number}{each.trials} trial{'' if each.trials == 1 else 's'}")
            field = ui.input("Right pseudonym").props(
                f'dense maxlength=64 aria-label="Right pseudonym of {each.pseudonym}"'
            )
            ui.button("Correct", on_click=lambda: self._correct(each.pseudonym, field.value or "")).props(
                f'no-caps outline aria-label="Correct {each.pseudonym}"'
            )
            if not each.played:
                ui.button("Take back", on_click=lambda: self._take_back(each.pseudonym)).props(
                    f'no-caps outline aria-label="Take {each.pseudonym} back"'
                )

    async def _correct(self, old: str, new: str) -> None:
        if not new.strip():
            ui.notify("Write the right pseudonym beside it", type="warning")
            return
        question = f"Call {old} {new.strip()} from now on, in all trials?"
        if self._page.operate() and await sure(question, "Correct", "Leave it"):
            await self._do(self._studies.correct_pseudonym, old, new.strip())

    async def _take_back(self, pseudonym: str) -> None:
        question = f"Take {pseudonym} back? The number is free again, and trials without a step stay as aborted."
        if self._page.operate() and await sure(question, "Take back", "Leave it"):
            await self._do(self._studies.take_back, pseudonym)

    async def _do(self, act: Callable[..., int], *names: str) -> None:
        assert self._protocol is not None
        try:
            await self._page.work(act, self._protocol.name, *names, self._page.visitor.name, self._page.robot)
        except (NaoError, OSError) as error:
            ui.notify(str(error), type="negative", multi_line=True)
        await self.show(self._protocol)
        await self._changed()
