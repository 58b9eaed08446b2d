"""The stop's own way: beside the pages, in the loop that takes connections, with nothing else in it.

`POST /console/stop?robot=NAME&id=ID` answers {"stopped": NAME} or {"error": TEXT}. The WebSocket of that path, which
pages hold open, takes {"robot": NAME, "id": ID} and answers the same with the id. Pages send a stop on both, and one id
is carried out once.
"""

from __future__ import annotations

import json
from collections import deque
from typing import Any, Deque, Tuple
from urllib.parse import parse_qs

from naoqi.errors import NaoError

from .access.guard import SESSION
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
    """ASGI application behind the guard. Waits for nothing but the stop itself, which has a thread of its own."""

    def __init__(self, robots: Robots, sessions: Sessions) -> None:
        self._robots = robots
        self._sessions = sessions
        self._carried_out: Deque[Tuple[str, str]] = deque(maxlen=REMEMBERED)

    async def __call__(self, scope: Any, receive: Any, send: Any) -> None:
        """Answer a request or a WebSocket."""
        if scope["type"] == "websocket":
            await self._serve(scope[SESSION], receive, send)
            return
        if scope["method"] != "POST":
            await _respond(send, 405, {"error": "a stop is a POST"})
            return
        query = parse_qs(scope["query_string"].decode("latin-1"))
        robot, number = (query.get(key, [""])[0] for key in ("robot", "id"))
        await _respond(send, *await self._stop(scope[SESSION], robot, number))

    async def _serve(self, session: Session, receive: Any, send: Any) -> None:
        await receive()  # the wish to connect
        await send({"type": "websocket.accept"})
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
        if not session.operator:
            return 403, {"error": "observers look on"}
        once = (session.key, number)
        if number and once in self._carried_out:
            return 200, {"stopped": name}
        self._carried_out.append(once)
        try:
            client = (self._robots.known(name) if name else None) or await in_background(self._robots.robot, name)
        except NaoError as error:
            return 404, {"error": str(error)}
        await in_background(client.stop, session.name)
        return 200, {"stopped": client.name}


async def _respond(send: Any, status: int, answer: dict[str, str]) -> None:
    headers = [(b"content-type", b"application/json")]
    await send({"type": "http.response.start", "status": status, "headers": headers})
    await send({"type": "http.response.body", "body": json.dumps(answer).encode()})
