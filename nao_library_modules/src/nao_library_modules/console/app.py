"""The console as a program and as a node: settings, robots, users and pages put together, and served.

Pages run in an event loop of their own (`PageLoop`). The stop (`StopLine`) runs beside them, in the loop that accepts
connections, with nothing else in it: `POST /console/stop?robot=NAME&id=ID` answers {"stopped": NAME, "state": STATE} or
{"error": TEXT}. The WebSocket of that path, which pages hold open with `?robot=NAME`, takes {"robot": NAME, "id": ID}
and answers the same with the id. Pages send a stop on both, and one id is carried out once. Whoever has a session may
stop a robot: observers, too.

Every `PERIOD` of `connections` the WebSocket sends {"beat": TIME, "console": ID, "pages": BOOL, "state": STATE}: the
console's clock, which console it is, whether the loop of the pages answers, and how far the stop of the robot is.
"""

from __future__ import annotations

import asyncio
import gc
import ipaddress
import json
import logging
import signal
import socket
import sys
import threading
import time
import uuid
from collections import deque
from collections.abc import Awaitable, Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Deque, Tuple
from urllib.parse import parse_qs

import rospy

from naoqi.errors import NaoError

from ..core.files import config_file, ros_home
from ..studies.study_files import StudyFiles
from .access.connections import BACKLOG, PERIOD, Connections, CountedListener, console_time
from .access.guard import COOKIE, SESSION, Guard
from .access.sessions import OBSERVER, OPERATOR, ROLES, Controls, Session, SessionFile, Sessions, read_users
from .robots.robot_client import Robots
from .robots.robot_goals import Presses
from .view.background import Lane, in_background
from .view.live_view import Views
from .watched_studies import studies_of

THREAD = "pages"
"""Of the thread."""
LOOK_PERIOD = 0.25
"""s between two signs of life of the loop."""
SILENT = 1.5
"""s without one, after which the pages do not answer."""


class PageLoop:
    """ASGI application that runs another one in an event loop of its own thread.

    `app`: the other one.
    """

    def __init__(self, app: Any) -> None:
        self.app = app
        self._loop = asyncio.new_event_loop()
        self._lived = time.monotonic()
        self._loop.call_soon(self._live)
        threading.Thread(target=self._loop.run_forever, name=THREAD, daemon=True).start()

    async def __call__(self, scope: Any, receive: Any, send: Any) -> None:
        """Have one connection answered."""
        here = asyncio.get_running_loop()
        await _in_loop(self._loop, self.app, scope, _called_in(here, receive), _called_in(here, send))

    def answers(self) -> bool:
        """Whether the loop takes its turns. Any thread."""
        return time.monotonic() - self._lived < SILENT

    def _live(self) -> None:
        self._lived = time.monotonic()
        self._loop.call_later(LOOK_PERIOD, self._live)

    def close(self) -> None:
        """End the loop, behind the last connection."""
        self._loop.call_soon_threadsafe(self._loop.stop)


def _called_in(loop: asyncio.AbstractEventLoop, call: Callable[..., Awaitable[Any]]) -> Callable[..., Awaitable[Any]]:
    return lambda *arguments: _in_loop(loop, call, *arguments)


async def _in_loop(loop: asyncio.AbstractEventLoop, call: Callable[..., Any], *arguments: Any) -> Any:
    """Wait in this loop for what is done in another one; a cancel ends it there."""
    return await asyncio.wrap_future(asyncio.run_coroutine_threadsafe(call(*arguments), loop))


PATH = "/console/stop"
LONGEST_MESSAGE = 500
"""Bytes."""
REMEMBERED = 256
"""Stops whose ids are known."""
WRONG = 4400


class StopLine:
    """ASGI application behind the guard. Waits for nothing but the stop itself, which has a thread of its own.

    `pages_answer`: whether the loop of the pages does.
    """

    def __init__(self, robots: Robots, sessions: Sessions, pages_answer: Callable[[], bool] = lambda: True) -> None:
        self._robots = robots
        self._sessions = sessions
        self._pages_answer = pages_answer
        self._id = uuid.uuid4().hex
        self._carried_out: Deque[Tuple[str, str]] = deque(maxlen=REMEMBERED)

    async def __call__(self, scope: Any, receive: Any, send: Any) -> None:
        """Answer a request or a WebSocket."""
        query = parse_qs(scope["query_string"].decode("latin-1"))
        robot, number = (query.get(key, [""])[0] for key in ("robot", "id"))
        if scope["type"] == "websocket":
            await self._serve(scope[SESSION], robot, receive, send)
            return
        if scope["method"] != "POST":
            await _respond(send, 405, {"error": "a stop is a POST"})
            return
        await _respond(send, *await self._stop(scope[SESSION], robot, number))

    async def _serve(self, session: Session, shown: str, receive: Any, send: Any) -> None:
        await receive()  # the wish to connect
        await send({"type": "websocket.accept"})
        tasks = [
            asyncio.ensure_future(each) for each in (self._beat(shown, send), self._take_stops(session, receive, send))
        ]
        try:
            done, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
            for task in done:
                task.result()
        except OSError:
            pass  # the page has gone: uvicorn says so to who still sends
        finally:
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)

    async def _beat(self, shown: str, send: Any) -> None:
        """Tell a page that the console lives; `shown`: the robot of the page."""
        while True:
            robot = self._robots.known(shown) if shown else None
            state = "" if robot is None else robot.stop_state
            beat = {"beat": console_time(), "console": self._id, "pages": self._pages_answer(), "state": state}
            await send({"type": "websocket.send", "text": json.dumps(beat)})
            await asyncio.sleep(PERIOD)

    async def _take_stops(self, session: Session, receive: Any, send: Any) -> None:
        while True:
            message = await receive()
            if message["type"] == "websocket.disconnect":
                return
            try:
                told = json.loads((message.get("text") or "")[:LONGEST_MESSAGE])
                robot, number = str(told["robot"]), str(told["id"])
            except (ValueError, TypeError, KeyError):
                await send({"type": "websocket.close", "code": WRONG, "reason": 'a page sends {"robot", "id"}'})
                return
            _, answer = await self._stop(session, robot, number)
            await send({"type": "websocket.send", "text": json.dumps({"id": number, **answer})})

    async def _stop(self, session: Session, name: str, number: str) -> tuple[int, dict[str, str]]:
        """Stop a robot, whoever holds its controls; status and answer."""
        if not self._sessions.known(session):
            return 403, {"error": "you are logged out: load the page again"}
        once = (session.key, number)
        if number and once in self._carried_out:
            known = self._robots.known(name)
            return 200, {"stopped": name, "state": "" if known is None else known.stop_state}
        self._carried_out.append(once)
        try:
            client = (self._robots.known(name) if name else None) or await in_background(self._robots.robot, name)
        except NaoError as error:
            return 404, {"error": str(error)}
        await in_background(client.stop, session.name)
        return 200, {"stopped": client.name, "state": client.stop_state}


async def _respond(send: Any, status: int, answer: dict[str, str]) -> None:
    headers = [(b"content-type", b"application/json")]
    await send({"type": "http.response.start", "status": status, "headers": headers})
    await send({"type": "http.response.body", "body": json.dumps(answer).encode()})


PORT = 8080
LOOPBACK = ("127.0.0.1", "localhost", "::1")
OLDEST_GENERATION = 500
"""Garbage collections of the middle generation before one of the oldest, which stops every thread."""
SWITCH_INTERVAL = 0.0005
"""s for which a thread that takes the processor keeps others waiting, a stop among them."""
STUDIES = "~/.ros/nao_studies"
SESSIONS = "nao_console_sessions_{port}.json"
"""In the folder of ROS: who is logged in at the console of a port."""
WHEELS = "scripts/setup installs it, where Python is 3.10 or newer"


@dataclass(frozen=True)
class ConsoleSettings:
    """What a console is started with. Raises NaoError if it would be open to others without need."""

    port: int = PORT  # 0: the system gives one
    listen: str = LOOPBACK[0]  # address of this computer
    users: Path | None = None  # file of people who log in; needed beyond loopback
    certificate: Path | None = None  # of TLS, PEM
    key: Path | None = None
    buttons: Path = field(default_factory=lambda: config_file("console") / "console.yaml")  # of the wizard's page
    studies: Path = field(default_factory=lambda: Path(STUDIES).expanduser())  # folder of trials

    def __post_init__(self) -> None:
        if not self.local and self.users is None:
            raise NaoError(f"on {self.listen} others can reach the console: name their passwords with --users FILE")
        if (self.certificate is None) != (self.key is None):
            raise NaoError("TLS takes both --cert FILE and --key FILE")
        for path in (self.users, self.certificate, self.key):
            if path is not None and not path.is_file():
                raise NaoError(f"there is no file {path}")

    @property
    def local(self) -> bool:
        """Whether only this computer can reach it."""
        try:
            return self.listen == LOOPBACK[1] or ipaddress.ip_address(self.listen).is_loopback
        except ValueError:
            raise NaoError(f"--listen {self.listen!r}: an address of this computer, such as 0.0.0.0") from None

    @property
    def url(self) -> str:
        """Address for a browser, with a slash at its end."""
        everywhere = not self.local and ipaddress.ip_address(self.listen).is_unspecified
        host = socket.gethostname() if everywhere else f"[{self.listen}]" if ":" in self.listen else self.listen
        return f"{'http' if self.certificate is None else 'https'}://{host}:{self.port}/"


class Console:
    """What all pages share.

    Attributes:
        app: FastAPI application, for routes and WebSockets beside the pages; all of them are behind the guard.
        presses: What users press, and what of it has failed.
        views: What pages and trials share of each robot: its senses, its body, its alarms, its pictures.
        lanes: Role -> where what takes the processor is done for pages.
        studies: Begins trials, and knows those that run.
    """

    def __init__(self, settings: ConsoleSettings) -> None:
        try:
            from fastapi import FastAPI
            from nicegui import ui
        except ImportError as error:
            raise NaoError(f"the console needs NiceGUI ({error}): {WHEELS}") from None
        from .pages import PAGES, frame

        self.settings = settings
        self.robots = Robots()
        self.views = Views(settings.studies)
        self.controls = Controls()
        self.presses = Presses()
        self.lanes = {role: Lane() for role in ROLES}  # observers never hold up the work of operators
        self.sessions = Sessions(None if settings.users is None else read_users(settings.users))
        self.sessions.on_end = self.controls.forget
        self.studies = studies_of(StudyFiles(settings.studies), self.views)
        self.app = FastAPI(docs_url=None, redoc_url=None, openapi_url=None)
        frame.build(self)
        for build in PAGES:
            build(self)
        ui.run_with(self.app, title="NAO console", dark=None, show_welcome_message=False, reconnect_timeout=10.0)

    def addresses(self) -> Sequence[str]:
        """What to open in a browser, for people."""
        tokens = self.sessions.tokens
        if not tokens:
            return [f"NAO console: {self.settings.url}"]
        return [
            f"NAO console: {self.settings.url}?token={tokens[OPERATOR]}",
            f"  to look on: {self.settings.url}?token={tokens[OBSERVER]}",
        ]

    def serve(self) -> None:
        """Serve pages until the process is told to end (SIGINT, SIGTERM). Raises NaoError if the port is taken."""
        import uvicorn

        connections = Connections()
        settings = self.settings
        try:
            listener = CountedListener.on(settings.listen, settings.port, connections)
        except OSError as error:
            text = f"port {settings.port} of {settings.listen}: {error.strerror}; --port takes another"
            raise NaoError(text) from None
        settings = self.settings = replace(self.settings, port=listener.getsockname()[1])
        self.sessions.keep_in(SessionFile(ros_home() / SESSIONS.format(port=settings.port)))
        pages = PageLoop(self.app)
        guard = Guard(
            pages,
            self.sessions,
            (*LOOPBACK, settings.listen) if settings.local else (),
            secure=settings.certificate is not None,
            cookie=f"{COOKIE}_{settings.port}",
            own={PATH: StopLine(self.robots, self.sessions, pages.answers)},
            connections=connections,
        )
        config: Any = uvicorn.Config(
            guard,
            log_level="warning",
            access_log=False,
            ssl_certfile=settings.certificate,
            ssl_keyfile=settings.key,
            timeout_graceful_shutdown=2,
            server_header=False,
            loop="asyncio",  # which asks the listener itself for each connection
            backlog=BACKLOG,
            proxy_headers=False,  # the address is that of the connection, whatever a header says
            ws_max_size=2**20,
            ws_per_message_deflate=False,  # pictures are compressed, and poses too short for it
        )
        gc.collect()
        gc.freeze()  # what is there by now stays: a look through all of it holds up every thread
        gc.set_threshold(*gc.get_threshold()[:2], OLDEST_GENERATION)
        sys.setswitchinterval(SWITCH_INTERVAL)
        for line in self.addresses():
            print(line, flush=True)
        signal.signal(signal.SIGTERM, lambda *_: sys.exit(0))  # uvicorn raises it again when it has ended
        with suppress(KeyboardInterrupt):
            uvicorn.Server(config).run(sockets=[listener])
        pages.close()


NAME = "nao_console"
PARAMETERS = {"port": PORT, "listen": LOOPBACK[0], "users": "", "cert": "", "key": "", "buttons": "", "studies": ""}
"""Private parameters of the launched node, with their defaults."""
_PATHS = {"users": "users", "cert": "certificate", "key": "key", "buttons": "buttons", "studies": "studies"}


def serve_console(**settings: Any) -> None:
    """Make this process a node and serve pages until it is told to end; `settings`: of `ConsoleSettings`.

    Raises NaoError if it cannot begin.
    """
    made = ConsoleSettings(**settings)
    if not rospy.core.is_initialized():
        start_node()
    try:
        Console(made).serve()
    finally:
        rospy.signal_shutdown("the console has ended")


def start_node() -> None:
    """Become a node that leaves signals alone. Raises NaoError if there is no ROS master."""
    logging.getLogger("rosout").setLevel(logging.ERROR)
    try:
        rospy.get_master().getPid()
        rospy.init_node(NAME, argv=[NAME], anonymous=True, disable_signals=True, disable_rosout=True)
    except (rospy.ROSException, OSError) as error:
        raise NaoError(f"there is no ROS master to be a node of ({error}): launch the robot's stack first") from None


def run_launched() -> int:
    """Run the launched node, whose parameters stand for the options of `nao console`; returns the exit status."""
    rospy.init_node(NAME, disable_signals=True)
    given = {name: rospy.get_param(f"~{name}", default) for name, default in PARAMETERS.items()}
    paths = {field: Path(given.pop(name)).expanduser() for name, field in _PATHS.items() if given[name]}
    plain = {name: given[name] for name in ("port", "listen")}
    try:
        serve_console(**plain, **paths)
    except NaoError as error:
        rospy.logfatal("%s", error)
        return 1
    return 0
