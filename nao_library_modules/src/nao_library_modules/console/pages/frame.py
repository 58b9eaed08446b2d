"""What all pages have: head line, choice of the robot, stop, users, light and dark, alarms, and presses that failed.

What a page could not send is reported later: see static/presses.js.
"""

from __future__ import annotations

import asyncio
import logging
import math
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any, Awaitable, Callable, Union

from fastapi import Depends, HTTPException, Request
from fastapi.staticfiles import StaticFiles
from nicegui import context, ui
from starlette.requests import ClientDisconnect

from naoqi.errors import NaoError

from ...core.files import config_file
from ...studies.commands import RobotCommand
from ...studies.robot_events import namespace_of
from ..access.connections import refusal_of_late
from ..access.guard import LOGOUT, session_of
from ..access.sessions import Session
from ..robots.robot_client import RobotClient
from ..robots.robot_goals import NOT_SENT, PATIENCE, FailedPress, Press, Presses, Run
from ..view.alarms import Alarm
from ..view.background import Subscriptions, in_background

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


log = logging.getLogger(__name__)

STATIC = "/console/static"
PATHS = {"/": "Robot", "/wizard": "Wizard", "/study": "Study", "/behaviors": "Behaviours", "/functions": "Functions"}
HOLDER_PERIOD = 1.0
MOST_WORK = 4
"""Pieces of work of one page that wait; what more is asked for is refused."""

Callback = Callable[[], Union[None, Awaitable[None]]]


def build(console: Any) -> None:
    """Register what all pages need: static files, and where they tell what they could not send."""
    console.app.mount(STATIC, StaticFiles(directory=config_file("console/static")), name="console_static")
    build_unsent(console)


class PageContext:
    """One open page: who looks at which robot.

    `gone`: whether it was left.
    """

    def __init__(self, console: Any, session: Session, robot: RobotClient) -> None:
        self.console = console
        self.visitor = session
        self.robot = robot
        self.gone = False
        self._path = context.client.request.url.path
        self._working = 0
        self._leave: list[Callable[[], None]] = []
        self._client = context.client
        self._client.on_delete(self._left)
        self._handle_event = self._client.handle_event
        self._client.handle_event = self._take_event  # type: ignore[method-assign]  # NiceGUI has no hook there

    async def ask(self, task: Callable[..., Any], *arguments: Any) -> Any:
        """What a function gives that waits for ROS, the disk or a lock. It is never called in the event loop.

        What waits for it ends where the page is gone meanwhile.
        """
        found = await in_background(task, *arguments)
        self._end_if_gone()
        return found

    async def work(self, task: Callable[..., Any], *arguments: Any) -> Any:
        """What a function gives that may take the processor for a while, as reading YAML does; see `Lane`.

        What waits for it ends where the page is gone meanwhile, and so does what has not begun. Raises NaoError where
        the page has MOST_WORK waiting already.
        """

        def wanted() -> Any:
            return None if self.gone else task(*arguments)

        if self._working >= MOST_WORK:
            raise NaoError("this page has asked for much already: wait for the answers")
        self._working += 1
        try:
            found = await self.console.lanes[self.visitor.role].do(wanted)
        finally:
            self._working -= 1
        self._end_if_gone()
        return found

    def operate(self, button: str = "") -> bool:
        """Whether this visitor may move the robot now; says why not, until the visitor has looked.

        `button`: what was pressed.
        """
        if not self.console.sessions.known(self.visitor):
            self.failed(button, "you are logged out: load the page again")
            return False
        if self.console.controls.may_move(self.robot.namespace, self.visitor):
            return True
        self.failed(button, self.console.controls.refusal(self.robot.namespace, self.visitor))
        return False

    async def press(self, button: str, send: Callable[..., Any], *arguments: Any) -> Run | None:
        """The goal that `send` returns; None where it raises NaoError.

        How it fails is told until the visitor has looked. `button`: what was pressed.
        """
        press = self._press(button)

        def sent() -> Run | None:
            try:
                run = send(*arguments)
            except NaoError as error:
                self.console.presses.report(press, NOT_SENT, str(error))
                return None
            except Exception as error:
                self.console.presses.report(press, NOT_SENT, f"unexpected error: {error!r}")
                raise
            self.console.presses.follow(press, run)
            return run

        return await self.ask(sent)

    async def send(self, button: str, command: RobotCommand, label: str = "", stops: int | None = None) -> Run | None:
        """Send a command in the name of this visitor, as `press` does. `stops`: of the robot when it was pressed."""
        stops = self.robot.stops if stops is None else stops
        return await self.press(button, self.robot.send, command, self.visitor.name, label, stops, PATIENCE)

    def failed(self, button: str, reason: str) -> None:
        """Tell that something pressed on this page was not done, until the visitor has looked."""
        self.console.presses.report(self._press(button), NOT_SENT, reason)

    def every(self, period: float, callback: Callback) -> Any:
        """Call something every so many s while the page is open. Returns ui.timer."""
        return ui.timer(period, callback)

    def on_leave(self, callback: Callable[[], None]) -> None:
        """Have something called when the page is gone."""
        self._leave.append(callback)

    def static(self, name: str) -> None:
        """Load a script of the static files, as a module."""
        ui.add_head_html(f'<script type="module" src="{STATIC}/{name}"></script>')

    def notify(self, text: str, kind: str = "info") -> None:
        """Tell this visitor something; `kind`: positive, negative, warning, info. In the event loop."""
        with self._client:
            ui.notify(text, type=kind)

    def _press(self, button: str) -> Press:
        streams = (self.robot.events,) if self.visitor.operator else ()  # what observers try is theirs to see
        return Press(button, self.visitor.name, self._path, self.robot.namespace, streams=streams)

    def _take_event(self, message: dict[str, Any]) -> None:
        """Pass on what the browser reports of an element, unless it comes late, or was told as not sent."""
        press_id = message.get("press_id")
        if press_id and not self.console.presses.is_new(str(press_id)):
            return
        refusal = refusal_of_late(message)
        if refusal:
            self.failed(str(message.get("label", ""))[:LONGEST_LABEL], refusal)
        else:
            self._handle_event(message)

    def _end_if_gone(self) -> None:
        if self.gone:
            raise asyncio.CancelledError  # nothing of the page can be shown any more

    def _left(self) -> None:
        self.gone = True
        for callback in self._leave:
            try:
                callback()
            except Exception:  # the others are called all the same
                log.exception("a page could not be left as it should")
        self._leave.clear()


def page_at(console: Any, path: str) -> Callable[[Any], Any]:
    """Decorator of a page, as `ui.page`: the robot of its address is looked for before, beside the event loop."""

    def look(name: str) -> tuple[RobotClient, list[str]]:
        return console.robots.robot(name), console.robots.names()

    async def find(request: Request) -> None:
        try:
            found = await in_background(look, request.query_params.get("robot", ""))
        except NaoError as error:  # never another robot in its place
            raise HTTPException(404, str(error)) from None
        request.state.robot, request.state.robots = found

    return ui.page(path, dependencies=[Depends(find)])


@contextmanager
def framed(console: Any, title: str, request: Request) -> Iterator[PageContext]:
    """A page with its frame; in the block is its content.

    The address says which robot: `?robot=nao1`, the first without. While it is open, goals of all programs are
    followed. `request`: of a page that is made by `page_at`.
    """
    session = session_of(request)
    robot = request.state.robot
    page = PageContext(console, session, robot)
    ui.page_title(f"{title}, {robot.name}: NAO console")
    ui.add_head_html(f'<link rel="stylesheet" href="{STATIC}/console.css">')
    for script in ("presses.js", "drafts.js", "frame.js"):
        page.static(script)
    following = Subscriptions(f"goals of {robot.name}")
    following.begin(lambda: console.robots.watch(robot))
    page.on_leave(following.end)
    page.on_leave(console.controls.enter(session, robot.namespace))
    dark = ui.dark_mode(session.dark)
    with ui.header().classes("nao-header").props(f'data-robot="{robot.name}"') as header:
        header.props(f'data-not-sent="{NOT_SENT.word}"')  # for presses.js
        _navigation(request.url.path, robot)
        with ui.row().classes("nao-who"):
            _choice_of_robot(request.url.path, robot, request.state.robots)
            _people(console, page)
            if console.sessions.users is not None:
                ui.button(icon="logout", on_click=lambda: ui.navigate.to(LOGOUT)).props(
                    'flat round color=white aria-label="Log out"'
                )
            ui.button(icon="contrast", on_click=lambda: _turn(session, dark)).props(
                'flat round color=white aria-label="Light or dark"'
            )
        # What static/frame.js tells of the console and of the stop; Vue leaves the content of both elements alone.
        ui.element("div").classes("nao-told").props("id=nao-told role=alert")
        # Pressed, it is a request of its own, as the key is: see static/frame.js.
        with (
            ui.button("Stop", icon="pan_tool")
            .classes("nao-stop")
            .props(
                'color=negative aria-label="Stop the robot" aria-keyshortcuts="Escape" aria-describedby=nao-told'
                ' title="Ends everything that the robot does (Escape)"'
            )
        ):
            ui.element("span").classes("nao-stop-state")
    with ui.footer(elevated=False).classes("nao-strip").props('role="region" aria-label="Reports" tabindex="0"'):
        AlarmBar(page)
        FailedLines(console.presses, page).build()
    with ui.column().classes("nao-main w-full"):
        yield page


def _navigation(here: str, robot: RobotClient) -> None:
    with ui.element("nav").props('aria-label="Pages"'):
        for path, name in PATHS.items():
            link = ui.link(name, f"{path}?robot={robot.name}").classes("nao-link")
            if path == here or (path != "/" and here.startswith(path)):
                link.props('aria-current="page"')


def _choice_of_robot(here: str, robot: RobotClient, names: list[str]) -> None:
    if len(names) > 1 or robot.name not in names:
        choices = sorted({*names, robot.name})
        ui.select(choices, value=robot.name, on_change=lambda e: ui.navigate.to(f"{here}?robot={e.value}")).props(
            'dense dark options-dense aria-label="Robot"'
        ).classes("nao-robot")


def _people(console: Any, page: PageContext) -> None:
    """Who holds the controls, and a way to take them or give them back."""
    robot, session = page.robot.namespace, page.visitor
    button = ui.button("").props("flat dense no-caps color=white").classes("nao-holder")

    def show() -> None:
        holder = console.controls.holder(robot)
        others = [each.name for each in console.controls.visitors(robot) if each is not session]
        mine = holder is session
        text = "You have the controls" if mine else f"{holder.name} has the controls" if holder else "Controls are free"
        button.text = text + (f" (also here: {', '.join(others)})" if others else "")
        button.set_enabled(session.operator)

    def turn() -> None:
        if not console.sessions.known(session):
            page.notify("you are logged out: load the page again", "warning")
        elif console.controls.holder(robot) is session:
            console.controls.release(robot, session)
        else:
            console.controls.take(robot, session)
        show()

    button.on_click(turn)
    show()
    page.every(HOLDER_PERIOD, show)


def _turn(session: Session, dark: Any) -> None:
    """Light to dark and back; the first time against what the computer has."""
    session.dark = not session.dark
    dark.set_value(session.dark)


async def sure(question: str, yes: str = "Yes", no: str = "No") -> bool:
    """Ask in a dialog. `yes`, `no`: its answers, in words that say what happens."""
    with ui.dialog() as dialog, ui.card():
        ui.label(question)
        with ui.row():
            ui.button(yes, on_click=lambda: dialog.submit(True)).props("no-caps")
            ui.button(no, on_click=lambda: dialog.submit(False)).props("no-caps outline")
    answer = await dialog
    remove_dialog(dialog)
    return bool(answer)


def remove_dialog(dialog: ui.dialog) -> None:
    """Close a dialog for good.

    Its page may be gone: NiceGUI would warn with the stack, whose lines it reads from files in the event loop.
    """
    if not dialog.client.is_deleted:
        dialog.close()
        dialog.delete()
