"""The page "Robot": what it looks like, sees, feels and does, live; and a simulator's controls where there is one."""

from __future__ import annotations

import math
import time
from collections import deque
from typing import Any, Deque

from fastapi import Request
from nicegui import ui

from naoqi.errors import NaoError

from ..robots.events import ConsoleEvent
from ..robots.runs import Run
from ..view.background import in_background
from ..view.body_status import ERROR, OK, BodyStatus
from ..view.camera_feed import CAMERA_VIEWS
from ..view.traces import MOST_TRACES, TRACE_NAMES
from ..view.views import RobotViews
from . import live_routes
from .frame import STATIC, PageContext, framed, page_at
from .simulator_panel import SimulatorPanel

PERIOD, SLOW_PERIOD = 0.4, 1.0
"""s between two looks at events and goals, and at the body."""
SHOWN = 150
"""Events on the page, at most."""
EVENT_KINDS = {
    "": "everything",
    "touched": "touches",
    "heard": "what it hears",
    "seen": "what it sees",
    "said": "what it says",
    "alarm": "alarms",
}
LEVEL_COLOURS = {OK: "positive", ERROR: "negative"}
STATE_COLOURS = {
    "connected": "positive",
    "connecting": "warning",
    "silent": "warning",
    "lost": "negative",
    "closed": "negative",
}
OLD_COLOUR = "blue-grey-8"
JOINT = "joint"
SENSOR_TRACES = tuple(f"{kind}:{name}" for kind, names in TRACE_NAMES.items() for name in names)


def build(console: Any) -> None:
    """Register the page, at the root, and the routes behind it."""
    live_routes.build_live_routes(console)

    @page_at(console, "/")
    def robot_page(request: Request) -> None:
        with framed(console, "Robot", request) as page:
            RobotPage(page, console.views.of(page.robot))


class RobotPage:
    """One open page of one robot."""

    def __init__(self, page: PageContext, views: RobotViews) -> None:
        self._page = page
        self._views = views
        self._robot = page.robot
        for script in ("robot_view.js", "camera.js", "plot.js"):
            page.static(script)
        ui.add_head_html(f'<link rel="stylesheet" href="{STATIC}/robot_page.css">')
        with ui.element("div").classes("nao-robot-page w-full"):
            with ui.column().classes("nao-robot-wide"):
                self._build_view()
                self._build_cameras()
                self._plots = PlotPanel(page)
            with ui.column().classes("nao-robot-narrow"):
                self._status = StatusPanel(page, views)
                self._runs = RunPanel(page)
                self._events = EventPanel(page, views)
                SimulatorPanel(page, views, self._view)

    def _build_view(self) -> None:
        with _card("The robot"):
            self._view = ui.element("nao-robot-view").classes("w-full")
            self._view.props["robot"] = self._robot.name

    def _build_cameras(self) -> None:
        with _card("What it sees"), ui.row().classes("w-full nao-cameras"):
            for name in CAMERA_VIEWS:
                with ui.column().classes("nao-camera"):
                    camera = ui.element("nao-camera").classes("w-full")
                    camera.props["robot"], camera.props["camera"] = self._robot.name, name
                    ui.label(f"{name} camera").classes("text-caption")


class StatusPanel:
    """Connection, battery, heat, stiffness and posture."""

    ROWS = ("Connection", "Battery", "Heat", "Stiffness", "Posture")

    def __init__(self, page: PageContext, views: RobotViews) -> None:
        self._views = views
        page.on_leave(views.body.acquire())
        with _card("How it is"), ui.element("dl").classes("nao-facts"):
            self._badges = {name: self._row(name) for name in self.ROWS}
        self._show()
        page.every(SLOW_PERIOD, self._show)

    @staticmethod
    def _row(name: str) -> ui.badge:
        with ui.element("dt"):
            ui.label(name)
        with ui.element("dd"):
            return ui.badge("", color="grey-7").classes("nao-fact nao-state")

    def _show(self) -> None:
        body, status = self._views.body, self._views.body.status
        state = body.connection or "no driver tells"
        text = f"{state} {body.address}".strip() + (
            f": {body.problem}" if body.problem and state != "connected" else ""
        )
        self._set("Connection", text, STATE_COLOURS.get(state, "grey-7"), body.unheard)
        battery, old = status.battery_text or "unknown", body.old
        self._set("Battery", battery, _colour(status.battery_level, status.battery), old)
        self._set("Heat", heat_text(status), _colour(status.heat_level, 0.0 if status.hottest else math.nan), old)
        self._set("Stiffness", status.stiffness_text, "grey-7", old)
        # The memory tells of a posture once: it holds as long as the robot is there.
        self._set("Posture", body.posture or "unknown", "grey-7", body.unheard)

    def _set(self, name: str, text: str, colour: str, age: float | None) -> None:
        """Show a state; grey and with its age, s, if it is old."""
        badge = self._badges[name]
        badge.set_text(aged(text, age))
        if age is not None:
            colour = OLD_COLOUR
        if badge.props.get("color") != colour:
            badge.props["color"] = colour
            badge.update()


class RunPanel:
    """What runs on every server, with its progress, and a way to end it."""

    def __init__(self, page: PageContext) -> None:
        self._page = page
        self._rows: dict[str, dict[str, Any]] = {}
        with _card("What it does"):
            self._list = ui.column().classes("w-full nao-runs")
            self._idle = ui.label("").classes("text-caption nao-state")
        self._show()
        page.every(PERIOD, self._show)

    def _show(self) -> None:
        runs = {run.id: run for run in self._page.robot.runs}
        for gone in self._rows.keys() - runs.keys():
            self._rows.pop(gone)["row"].delete()
        for run in runs.values():
            row = self._rows.get(run.id) or self._add(run)
            row["state"].set_text(run.state)
            row["progress"].set_text(run.progress)
        busy = {run.server for run in runs.values()}
        idle = [server for server in self._page.robot.seen_servers if server not in busy]
        self._idle.set_text(f"At rest: {', '.join(idle)}" if idle else "No server runs" if not busy else "")

    def _add(self, run: Run) -> dict[str, Any]:
        with self._list, ui.row().classes("w-full items-center nao-run") as row:
            with ui.column().classes("nao-run-text"):
                ui.label(f"{run.server}: {run.label}")
                progress = ui.label("").classes("text-caption")
            state = ui.badge(run.state, color="primary").classes("nao-state")
            ui.label(run.by or "another program").classes("text-caption")
            button = ui.button("Cancel", on_click=lambda: self._cancel(run)).props(
                "dense outline no-caps color=negative"
            )
            button.props["aria-label"] = f"Cancel {run.server}: {run.label}"
        self._rows[run.id] = {"row": row, "state": state, "progress": progress}
        return self._rows[run.id]

    async def _cancel(self, run: Run) -> None:
        if self._page.operate(f"Cancel {run.server}: {run.label}"):
            await in_background(run.cancel)
            self._page.robot.events.add("cancelled", f"{run.server}: {run.label}", self._page.visitor.name, goal=run.id)


class EventPanel:
    """What happens to the robot and what is done with it, the newest first."""

    def __init__(self, page: PageContext, views: RobotViews) -> None:
        self._page = page
        self._fresh: Deque[ConsoleEvent] = deque(maxlen=SHOWN)  # events come in any thread
        self._rows: Deque[ui.label] = deque()
        with _card("What happens"):
            self._kind = ui.select(EVENT_KINDS, value="", on_change=self._reload, label="Show").props("dense outlined")
            self._list = ui.column().classes("w-full nao-events").props('role="log" tabindex="0" aria-label="Events"')
        page.on_leave(page.robot.events.subscribe(self._fresh.append))
        page.on_leave(views.senses.acquire())
        self._reload()
        page.every(PERIOD, self._show)

    def _reload(self) -> None:
        self._list.clear()
        self._rows.clear()
        self._fresh.clear()
        self._fresh.extend(self._page.robot.events.last(SHOWN))
        self._show()

    def _show(self) -> None:
        while self._fresh:
            event = self._fresh.popleft()
            if self._kind.value and event.kind != self._kind.value:
                continue
            with self._list:
                label = ui.label(event_text(event)).classes(f"nao-event nao-event-{event.kind}")
            label.move(target_index=0)
            self._rows.append(label)
            if len(self._rows) > SHOWN:
                self._rows.popleft().delete()


class PlotPanel:
    """The last minute of joints, sensors and keys of the robot's memory."""

    def __init__(self, page: PageContext) -> None:
        self._page = page
        self._plots: dict[str, Any] = {}
        with _card("The last minute"):
            with ui.row().classes("w-full items-end"):
                self._choice = ui.select(list(SENSOR_TRACES), label="Joint or sensor", with_input=True).props(
                    "dense outlined"
                )
                self._choice.classes("nao-trace")
                ui.button("Plot", on_click=lambda: self._add(self._choice.value)).props("no-caps")
                self._key = ui.input("Key of its memory", placeholder="ALMotion/...").props("dense outlined")
                self._key.on("keydown.enter", self._add_key)
                ui.button("Plot key", on_click=self._add_key).props("no-caps")
            self._list = ui.element("div").classes("w-full nao-plots")
        self._timer = page.every(SLOW_PERIOD, self._find_joints)
        self._add("joint:HeadYaw")

    async def _find_joints(self) -> None:
        """Offer the joints of the robot's description, once there is one."""
        try:
            model = await in_background(live_routes.model_of, self._page.console, self._page.robot.name)
        except NaoError:
            return
        self._timer.cancel()
        joints = [joint.name for joint in model.joints if joint.kind != "fixed" and joint.mimic is None]
        kinds = (JOINT, "velocity", "effort", "stiffness")
        self._choice.set_options([*(f"{kind}:{joint}" for kind in kinds for joint in joints), *SENSOR_TRACES])

    def _add_key(self) -> None:
        key = (self._key.value or "").strip()
        if key:
            self._add(f"memory:{key}")

    def _add(self, trace: str | None) -> None:
        if not trace or trace in self._plots:
            return
        if len(self._plots) >= MOST_TRACES:
            self._page.notify(f"{MOST_TRACES} plots at most: close one", "warning")
            return
        with self._list, ui.element("div").classes("nao-plot") as holder:
            plot = ui.element("nao-plot")
            plot.props["robot"], plot.props["trace"] = self._page.robot.name, trace
            close = ui.button(icon="close", on_click=lambda: self._remove(trace)).props("flat round dense size=sm")
            close.props["aria-label"] = f"Close {trace}"
        self._plots[trace] = holder

    def _remove(self, trace: str) -> None:
        self._plots.pop(trace).delete()


def heat_text(status: BodyStatus) -> str:
    """The warmest motors and the head, for people."""
    parts = [f"{name} {temperature:.0f} °C" for name, temperature in status.hottest]
    if math.isfinite(status.head):
        parts.append(f"head {status.head:.0f} °C")
    return ", ".join(parts) or "unknown"


def event_text(event: ConsoleEvent) -> str:
    """A line of an event: time of day, kind, text and who did it."""
    clock = time.strftime("%H:%M:%S", time.localtime(event.stamp)) if event.stamp > 1e9 else f"{event.stamp:.1f} s"
    return f"{clock}  {event.kind}  {event.text}" + (f"  ({event.by})" if event.by else "")


def aged(text: str, age: float | None) -> str:
    """A state for people. `age`: s, of one that is old; None: it is as it is now."""
    return text if age is None else f"{text}, {age:.0f} s ago"


def _colour(level: int, value: float) -> str:
    return "grey-7" if not math.isfinite(value) else LEVEL_COLOURS.get(level, "warning")


def _card(title: str) -> Any:
    card = ui.card().classes("w-full nao-card")
    with card:
        ui.label(title).classes("text-h6").props('role="heading" aria-level="2"')
    return card
