"""What a visitor has pressed and has failed, on every page, and what a page could not send: see static/presses.js."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Iterator, Mapping
from typing import Any, Callable

from fastapi import HTTPException, Request
from nicegui import context, ui
from starlette.requests import ClientDisconnect

from ..access.guard import session_of
from ..access.sessions import Session
from ..robots.events import namespace_of
from ..robots.presses import FailedPress, Press, Presses
from ..robots.runs import NOT_SENT

LONGEST_LABEL = 100
UNSENT = "the page had no connection to the console when it was pressed"
BROKEN = "the connection to the console broke before it arrived"
MOST_UNSENT = 50
"""Presses of which a page tells at once that it could not send them."""


def build_unsent(console: Any) -> None:
    """Register where a page tells what was pressed while it had no connection: POST `/console/unsent`."""

    @console.app.post("/console/unsent")
    async def unsent(request: Request) -> None:
        session = session_of(request)
        try:
            told = await request.json()
        except ValueError as error:
            raise HTTPException(400, f"presses are told as JSON: {error}") from None
        except ClientDisconnect:  # the page is left, and tells it again from the next one
            return
        for press, reason, more in unsent_presses(told, session, console.robots.known, console.presses.is_new):
            console.presses.report(press, NOT_SENT, reason, **more)


def unsent_presses(
    told: Any, session: Session, known: Callable[[str], Any], is_new: Callable[[str], bool] = lambda press_id: True
) -> Iterator[tuple[Press, str, Mapping[str, Any]]]:
    """Presses, the reason, and what else `Presses.report` takes, of what a browser tells, which may be anything.

    `known`: finds the robot of a name, or gives None. `is_new`: whether nothing was heard yet of the press of an id.
    """
    for each in told[:MOST_UNSENT] if isinstance(told, list) else ():
        if not isinstance(each, dict):
            continue
        label, group, page, via, name, of, press_id = (
            str(each.get(field) or "")[:LONGEST_LABEL]
            for field in ("label", "group", "page", "via", "robot", "of", "press_id")
        )
        if not is_new(press_id):
            continue
        robot, age = known(name), each.get("age")
        age = round(age, 1) if isinstance(age, (int, float)) and math.isfinite(age) else 0.0
        streams = (robot.events,) if robot is not None and session.operator else ()
        via = "key" if via == "key" else "click"
        press = Press(label, session.name, page, namespace_of(of or name), group, via, streams)
        yield press, BROKEN if each.get("doubt") else UNSENT, {"age": age, "keep": not each.get("seen")}


class FailedLines:
    """A line for each press of the visitor that has failed, with a button that takes it away."""

    def __init__(self, presses: Presses, page: Any) -> None:
        self._presses, self._page, self._user = presses, page, page.visitor.name
        self._shown: list[FailedPress] = []

    def build(self) -> None:
        """Make the lines, and follow what happens."""
        self._lines = ui.column().classes("nao-failed gap-1").props('role="alert" aria-label="What has failed"')
        # static/presses.js fills it; Vue leaves its content alone.
        ui.element("div").classes("nao-failed nao-unsent").props('role="alert" aria-label="What was not sent"')
        loop, client = asyncio.get_running_loop(), context.client

        def in_page() -> None:
            if not self._page.gone:
                with client:
                    self._show()

        self._page.on_leave(self._presses.subscribe(lambda: loop.call_soon_threadsafe(in_page)))
        self._show()

    def _show(self) -> None:
        failed = self._presses.unseen(self._user)
        if failed == self._shown:
            return
        self._shown = failed
        self._lines.clear()
        with self._lines:
            for each in failed:
                with ui.row().classes("w-full items-center no-wrap gap-2"):
                    ui.icon("error")
                    ui.label(each.text).classes("flex-1 break-words")
                    self._button("Seen", f"Seen: {each.text}", each.id)
            if len(failed) > 1:
                self._button("All seen", "All seen", None)

    def _button(self, text: str, label: str, number: int | None) -> None:
        button = ui.button(text, icon="done", on_click=lambda: self._presses.seen(self._user, number))
        button.props("no-caps dense outline color=black")
        button.props["aria-label"] = label
