"""The console as a program: settings, robots, people and pages put together, and served."""

from __future__ import annotations

import gc
import ipaddress
import signal
import socket
import sys
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from naoqi.errors import NaoError

from ..base.paths import config_file, ros_home
from .access.connections import BACKLOG, Connections, CountedListener
from .access.controls import Controls
from .access.guard import COOKIE, Guard
from .access.session_file import SessionFile
from .access.sessions import Sessions
from .access.users import OBSERVER, OPERATOR, ROLES, read_users
from .page_loop import PageLoop
from .robots.presses import Presses
from .robots.robots import Robots
from .stop_line import PATH, StopLine
from .study.alone import studies_of
from .study.files import StudyFiles
from .view.background import Lane
from .view.views import Views

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
