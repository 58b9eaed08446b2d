"""The stop's own way: beside the pages, in the loop that takes connections, with nothing else in it.

`POST /console/stop?robot=NAME&id=ID` answers {"stopped": NAME, "state": STATE} or {"error": TEXT}. The WebSocket of
that path, which pages hold open with `?robot=NAME`, takes {"robot": NAME, "id": ID} and answers the same with the id.
Pages send a stop on both, and one id is carried out once. Whoever has a session may stop a robot: observers, too.

Every `pulse.PERIOD` the WebSocket tells {"beat": TIME, "console": ID, "pages": BOOL, "state": STATE}: the console's
clock, which console it is, whether the loop of the pages answers, and how far the stop of the robot is.
"""

from __future__ import annotations

import asyncio
import json
import uuid
from collections import deque
from collections.abc import Callable
from typing import Any, Deque, Tuple
from urllib.parse import parse_qs

from naoqi.errors import NaoError

from .access.guard import SESSION
from .access.pulse import PERIOD, console_time
from .access.sessions import Session, Sessions
from .robots.robots import Robots
from .view.background import in_background

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
