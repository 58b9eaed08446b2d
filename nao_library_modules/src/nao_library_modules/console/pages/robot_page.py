"""The page "Robot": what it looks like, sees, feels and does, live; and a simulator's controls where there is one.

The live data have routes of their own, behind the guard: the robot's model, its meshes, WebSockets.
"""

from __future__ import annotations

import asyncio
import json
import math
import time
from collections import deque
from collections.abc import Awaitable, Callable
from functools import partial
from typing import Any, Deque

from fastapi import HTTPException, Request, WebSocket
from fastapi.responses import FileResponse, Response
from nicegui import ui

from naoqi.errors import NaoError

from ...core.errors import did_you_mean
from ...core.nao_facts import SENSORS
from ...studies.robot_events import ConsoleEvent
from ..access.guard import session_of
from ..robots.robot_goals import Run
from ..view.background import in_background
from ..view.live_view import CAMERA_VIEWS, MOST_TRACES, TRACE_NAMES, FrameInbox, RobotViews, watched_traces
from ..view.robot_model import RobotModel, mesh_path, read_model
from ..view.robot_state import ERROR, OK, BodyStatus
from ..view.simulator import CONTENTS, KINDS
from .frame import STATIC, PageContext, framed, page_at

DESCRIPTION = "robot_description"
LONGEST_REASON = 120
"""Bytes of the reason of a WebSocket's end, at most; 123 are allowed."""
LOOK_PERIOD = 5.0
"""s between two looks whether whoever has a WebSocket is still logged in."""
NOT_FOUND, LOGGED_OUT, WRONG = 4404, 4403, 4400
CACHED = {"cache-control": "max-age=3600"}


def build_live_routes(console: Any) -> None:
    """Register the routes.

    GET `/console/model?robot=NAME`: its description as JSON; `/console/meshes/PACKAGE/PATH`: meshes of descriptions
    that were asked for. WebSockets `/console/live?robot=NAME` and `/console/camera?robot=NAME&camera=top`: see
    `view/live_view.py`.
    """
    meshes: set[str] = set()

    def described(robot: str) -> tuple[RobotModel, str]:
        found = model_of(console, robot)
        return found, json.dumps(found.to_json())

    @console.app.get("/console/model")
    async def model(robot: str = "") -> Response:
        try:
            found, text = await in_background(described, robot)
        except NaoError as error:
            raise HTTPException(404, str(error)) from None
        meshes.update(found.meshes)
        return Response(text, media_type="application/json")

    @console.app.get("/console/meshes/{name:path}")
    async def mesh(name: str) -> FileResponse:
        import rospkg

        try:
            path = await in_background(lambda: mesh_path(name, frozenset(meshes), rospkg.RosPack().get_path))
        except (FileNotFoundError, rospkg.ResourceNotFound) as error:
            raise HTTPException(404, f"no mesh {name}") from error
        return FileResponse(path, media_type="model/stl", headers=CACHED)

    @console.app.websocket("/console/live")
    async def live(socket: WebSocket, robot: str = "") -> None:
        client = await _accepted(console, socket, robot)
        if client is None:
            return
        view = console.views.of(client).live
        inbox = await view.attach()

        async def read() -> None:
            while True:
                text = await socket.receive_text()
                await view.watch(inbox, watched_traces(json.loads(text)))

        try:
            await _serve(console, socket, inbox, read)
        finally:
            await view.detach(inbox)

    @console.app.websocket("/console/camera")
    async def camera(socket: WebSocket, robot: str = "", camera: str = "top") -> None:
        client = await _accepted(console, socket, robot)
        if client is None:
            return
        feed = console.views.of(client).cameras.get(camera)
        if feed is None:
            await _end(socket, NOT_FOUND, f"there is no camera {camera[:20]!r}{did_you_mean(camera, CAMERA_VIEWS)}")
            return
        inbox = await feed.attach()

        async def read() -> None:
            while True:
                await socket.receive_text()

        try:
            await _serve(console, socket, inbox, read)
        finally:
            await feed.detach(inbox)


def model_of(console: Any, name: str) -> RobotModel:
    """The description of a robot. Raises NaoError if there is none, or it will not do."""
    import rospy

    robot = console.robots.robot(name)
    for full in dict.fromkeys((robot.namespace + DESCRIPTION, f"/{DESCRIPTION}")):
        try:
            text = rospy.get_param(full, None)
        except OSError as error:
            raise NaoError(f"the ROS master does not answer: {error}") from error
        if text is not None:
            return read_model(str(text))
    raise NaoError(f"there is no parameter {robot.namespace}{DESCRIPTION}: does the driver run?")


async def _accepted(console: Any, socket: WebSocket, name: str) -> Any:
    """The robot that a WebSocket is about; None if there is none, which the browser was told."""
    await socket.accept()
    try:
        return await in_background(console.robots.robot, name)
    except NaoError as error:
        await _end(socket, NOT_FOUND, str(error))
        return None


async def _serve(console: Any, socket: WebSocket, inbox: FrameInbox, read: Callable[[], Awaitable[None]]) -> None:
    """Send frames and read messages until the browser goes, sends nonsense, or is logged out."""
    session = session_of(socket)

    async def send() -> None:
        while True:
            for frame in await inbox.take():
                await (socket.send_text(frame) if isinstance(frame, str) else socket.send_bytes(frame))

    async def look() -> None:
        while console.sessions.get(session.key) is session:
            await asyncio.sleep(LOOK_PERIOD)
        await _end(socket, LOGGED_OUT, "logged out")

    tasks = [asyncio.ensure_future(task) for task in (send(), read(), look())]
    try:
        done, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        for task in done:
            task.result()
    except (NaoError, ValueError) as error:
        await _end(socket, WRONG, str(error))
    finally:
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)


async def _end(socket: WebSocket, code: int, reason: str) -> None:
    await socket.close(code, reason.encode()[:LONGEST_REASON].decode(errors="ignore"))


SIMULATOR_PERIOD = 3.0
"""s between two looks whether there is a simulator."""
TOUCH, PUSH = 0.5, 0.2
"""s that a touch and a push last."""
FORCES = (10, 200)
"""N."""
SPEEDS = {0.5: "half", 1.0: "1 x", 2.0: "2 x", 4.0: "4 x", 0.0: "as fast as possible"}
WAYS = {"ahead": 0.0, "to its left": math.pi / 2, "back": math.pi, "to its right": -math.pi / 2}


class SimulatorPanel:
    """Buttons and fields on one page.

    Args:
        view: The element `nao-robot-view` of the page, whose sensors can be clicked while there is a simulator.
    """

    def __init__(self, page: PageContext, views: RobotViews, view: Any) -> None:
        self._page = page
        self._views = views
        self._simulator = views.simulator
        self._view = view
        view.on("nao-touch", lambda event: self._clicked(event.args), ["detail"])
        self._holder = ui.column().classes("w-full")
        self._holder.set_visibility(False)
        self._built = False
        page.every(SIMULATOR_PERIOD, self._look)

    async def _look(self) -> None:
        there = await in_background(lambda: self._simulator.there)
        if there and not self._built:
            self._built = True
            speed = await in_background(self._simulator.speed)
            with self._holder:
                self._build(speed)
        if there != self._holder.visible:
            self._holder.set_visibility(there)
            self._view.props["touchable"] = "true" if there else "false"
            self._view.update()

    def _build(self, speed: float | None) -> None:
        with ui.card().classes("w-full nao-card"):
            ui.label("The simulator").classes("text-h6").props('role="heading" aria-level="2"')
            with ui.row().classes("items-center"):
                self._button("Pause", self._simulator.pause)
                self._button("Go on", self._simulator.resume)
                self._button("Reset", self._simulator.reset)
                speeds = SPEEDS if speed is None else {**SPEEDS, speed: SPEEDS.get(speed, f"{speed:g} x")}
                ui.select(speeds, value=speed, label="Speed", on_change=lambda e: self._do(
                    partial(self._simulator.set_speed, e.value), f"speed {speeds[e.value]}"
                )).props("dense outlined").classes("nao-speed")  # fmt: skip
            with ui.expansion("Touch it", value=True).classes("w-full"):
                ui.label("Click a sensor here, or a yellow spot on the robot.").classes("text-caption")
                with ui.row().classes("nao-sensors"):
                    for sensor in SENSORS:
                        touch = partial(self._simulator.touch, sensor.devices[:1], TOUCH)
                        self._button(sensor.name, touch, f"touches {sensor.name}")
            with ui.expansion("Push it").classes("w-full"), ui.row().classes("items-center"):
                force = ui.number("Force in N", value=60, min=FORCES[0], max=FORCES[1]).props("dense outlined")
                for way, angle in WAYS.items():
                    ui.button(way, on_click=partial(self._push, force, way, angle)).props("dense no-caps outline")
            with ui.expansion("Somebody says").classes("w-full"):
                self._build_person()
            with ui.expansion("Place a thing").classes("w-full"):
                self._build_things()

    def _build_person(self) -> None:
        text = ui.input("Text").props("dense outlined").classes("w-full")
        with ui.row().classes("items-center"):
            x, y = _number("x in m", 1.0), _number("y in m", 0.0)

            async def say() -> None:
                words = (text.value or "").strip()
                await self._do(lambda: self._simulator.person_says(words, x.value, y.value), f"a person says {words!r}")

            ui.button("Say", on_click=say).props("dense no-caps outline")
            text.on("keydown.enter", say)

    def _build_things(self) -> None:
        with ui.row().classes("items-center"):
            kind = ui.select(list(KINDS), value="ball", label="Kind").props("dense outlined")
            name = ui.input("Name", value="thing1").props("dense outlined")
            content = ui.input("Content").props("dense outlined")
            content.bind_visibility_from(kind, "value", backward=lambda value: value in CONTENTS)
            kind.on_value_change(lambda event: content.set_value(CONTENTS.get(event.value, "")))
            x, y, z = _number("x in m", 0.6), _number("y in m", 0.0), _number("z in m", 0.05)

        async def place() -> None:
            await self._do(
                lambda: self._simulator.place(name.value, kind.value, content.value or "", x.value, y.value, z.value),
                f"places {kind.value} {name.value!r}",
            )

        with ui.row():
            ui.button("Place", on_click=place).props("dense no-caps outline")
            ui.button(
                "Remove",
                on_click=lambda: self._do(lambda: self._simulator.remove(name.value), f"removes {name.value!r}"),
            ).props("dense no-caps outline")

    def _button(self, text: str, action: Callable[[], None], note: str = "") -> None:
        ui.button(text, on_click=lambda: self._do(action, note or text.lower())).props("dense no-caps outline")

    async def _clicked(self, arguments: Any) -> None:
        """A sensor of the robot was clicked; what comes from a browser may be anything."""
        detail = arguments.get("detail") if isinstance(arguments, dict) else None
        device = detail.get("device") if isinstance(detail, dict) else None
        if any(device in sensor.devices for sensor in SENSORS):
            await self._do(lambda: self._simulator.touch([device], TOUCH), f"touches {device}")

    async def _push(self, force: Any, way: str, angle: float) -> None:
        strength, heading = float(force.value or 0.0), self._views.live.heading + angle
        await self._do(lambda: self._simulator.push(strength, heading, PUSH), f"pushes it {way}, {strength:g} N")

    async def _do(self, action: Callable[[], None], note: str) -> None:
        """Carry something out for who may move the robot, and tell what went wrong."""
        if not self._page.operate(note):
            return
        self._page.robot.events.add("simulator", note, self._page.visitor.name)
        try:
            await in_background(action)
        except NaoError as error:
            self._page.failed(note, str(error))


def _number(label: str, value: float) -> Any:
    return ui.number(label, value=value, step=0.1, format="%.2f").props("dense outlined").classes("nao-number")


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
    build_live_routes(console)

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
            model = await in_background(model_of, self._page.console, self._page.robot.name)
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
