"""The alarms of the robot on every page: in the strip at the bottom."""

from __future__ import annotations

import time
from typing import Any

from nicegui import ui

from ..view.alarms import Alarm

PERIOD = 0.2
"""s between two looks for changes."""
NONE = "No alarms"


class AlarmBar:
    """The strip of one page. The line of an alarm is created once, so that a screen reader reads it once.

    `page`: its `PageContext`.
    """

    def __init__(self, page: Any) -> None:
        self._watch = page.console.views.of(page.robot).alarms
        page.on_leave(self._watch.acquire())
        self._lines: dict[tuple[str, str, float], ui.element] = {}
        with ui.element("div").classes("nao-alarms"):
            self._none = ui.label(NONE).classes("nao-no-alarm")
            self._list = ui.element("div").classes("nao-alarm-list")
            self._list.props('role="alert" aria-live="assertive" aria-atomic="false"')
        self._show()
        page.every(PERIOD, self._show)

    def _show(self) -> None:
        alarms = {(alarm.code, alarm.what, alarm.since): alarm for alarm in self._watch.alarms}
        for gone in self._lines.keys() - alarms.keys():
            self._lines.pop(gone).delete()
        with self._list:
            for key, alarm in alarms.items():
                if key not in self._lines:
                    self._lines[key] = _line(alarm)
        self._none.set_visibility(not alarms)


def since_text(alarm: Alarm) -> str:
    """Begin of an alarm as text."""
    clock = time.strftime("%H:%M:%S", time.localtime(alarm.since))
    return f"since {clock} or before" if alarm.found else f"since {clock}"


def _line(alarm: Alarm) -> ui.element:
    with ui.element("div").classes("nao-alarm").props(f'data-alarm="{alarm.code}"') as line:
        ui.icon("warning").props('aria-hidden="true"')
        ui.label(f"{alarm.what}, {since_text(alarm)}.").classes("nao-alarm-what")
        ui.label(alarm.action)
    return line
