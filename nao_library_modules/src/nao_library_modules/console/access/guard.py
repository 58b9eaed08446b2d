"""The door of the console: nothing behind it is asked before a browser has shown who it is."""

from __future__ import annotations

import html
from collections.abc import Collection, Mapping
from contextlib import suppress
from http.cookies import CookieError, SimpleCookie
from typing import Any
from urllib.parse import parse_qs, quote, urlencode, urlsplit

from starlette.websockets import WebSocketDisconnect, WebSocketDisconnected

from .connections import Connections
from .sessions import Logins, Session, Sessions

COOKIE = "nao_console"
SESSION = "nao_session"
"""Key of the session in the scope of a connection."""
LEFT = (WebSocketDisconnect, WebSocketDisconnected)
"""What Starlette raises where a WebSocket is answered or read whose browser has left: that ends it, and is no error."""
LARGEST = 8 * 2**20
"""Bytes of a request."""
LOGIN, LOGOUT = "/login", "/logout"
CROWDED = "too many connections are open: close some pages"
DEVICE_AGE = 365 * 86400
"""s for which a browser remembers that somebody has logged in with it."""
HEADERS = [
    (b"x-content-type-options", b"nosniff"),
    (b"x-frame-options", b"DENY"),
    (b"referrer-policy", b"no-referrer"),
    (b"content-security-policy", b"frame-ancestors 'none'; object-src 'none'; base-uri 'self'; form-action 'self'"),
]
_PAGE = """<!doctype html><html lang="en"><meta charset="utf-8"><title>NAO console</title>
<meta name="viewport" content="width=device-width, initial-scale=1">
<style>body{{font:16px sans-serif;max-width:26em;margin:4em auto;padding:0 1em;color-scheme:light dark}}
input,button{{font:inherit;display:block;width:100%;margin:.3em 0 1em;padding:.5em;box-sizing:border-box}}</style>
<h1>NAO console</h1><p role="alert">{text}</p>{form}</html>"""
_FORM = """<form method="post" action="/login"><label>Name <input name="name" autocomplete="username" autofocus></label>
<label>Password <input name="password" type="password" autocomplete="current-password"></label>
<button>Log in</button></form>"""


def session_of(connection: Any) -> Session:
    """The session of a request or WebSocket that has passed the guard."""
    return connection.scope[SESSION]


class Guard:
    """ASGI application in front of another one.

    A request or WebSocket goes through if its Host is one of the console's, its Origin (if it says one) is the console
    itself, and its cookie belongs to a session. A token in the address, or a name and password, make a session.

    Args:
        app: What is behind.
        hosts: Names by which browsers may call the console, without ports; empty: any.
        secure: Whether it is reached by https, so that cookies never go without.
        cookie: Its name: browsers send those of a host to all of its ports.
        own: Path -> application that is asked in place of `app`, for who has a session.
        connections: Of the listener: told whose each is.
    """

    def __init__(
        self,
        app: Any,
        sessions: Sessions,
        hosts: Collection[str] = (),
        secure: bool = False,
        cookie: str = COOKIE,
        own: Mapping[str, Any] | None = None,
        connections: Connections | None = None,
    ) -> None:
        self.app = app
        self._own = own or {}
        self._connections = Connections() if connections is None else connections
        self._sessions = sessions
        self._hosts = frozenset(hosts)
        self._secure = secure
        self._cookie, self._device = cookie, f"{cookie}_device"
        self._logins = Logins(sessions)

    async def __call__(self, scope: Any, receive: Any, send: Any) -> None:
        """Answer one connection."""
        if scope["type"] not in ("http", "websocket"):
            await self.app(scope, receive, send)
            return
        headers = {name.decode("latin-1").lower(): value.decode("latin-1") for name, value in scope["headers"]}
        problem = self._foreign(headers, needs_origin=scope["type"] == "websocket")
        session = None if problem else self._sessions.get(_cookie(headers.get("cookie", ""), self._cookie))
        peer = tuple(scope.get("client") or ("", 0))
        crowded = session is not None and not self._connections.admit(peer, session.key)
        if session is None:
            self._connections.heard(peer)
        if scope["type"] == "websocket":
            if session is None or crowded:
                reason = CROWDED if crowded else problem or "not logged in"
                await send({"type": "websocket.close", "code": 4403, "reason": reason})
                return
            with suppress(*LEFT):
                await self._behind(scope)({**scope, SESSION: session}, receive, send)
            return
        if problem:
            await _answer(send, 403, problem)
        elif session is None or scope["path"] in (LOGIN, LOGOUT) or b"token=" in scope["query_string"]:
            await self._let_in(scope, receive, send, session)
        elif crowded:
            await _answer(send, 503, CROWDED)
        elif int(headers.get("content-length") or 0) > LARGEST:
            await _answer(send, 413, f"more than {LARGEST} bytes")
        else:
            await self._pass(scope, receive, send, session)

    def _behind(self, scope: Any) -> Any:
        return self._own.get(scope["path"], self.app)

    def _foreign(self, headers: dict[str, str], needs_origin: bool) -> str:
        """Why a connection is another page's doing; empty: it is not."""
        host = headers.get("host", "")
        if self._hosts and (urlsplit(f"//{host}").hostname or "") not in self._hosts:
            return f"this console is not {host!r}"
        origin = headers.get("origin")
        if origin is None:
            return "a WebSocket without an origin" if needs_origin else ""
        return "" if urlsplit(origin).netloc == host else f"a page of {origin} is not the console's"

    async def _let_in(self, scope: Any, receive: Any, send: Any, session: Session | None) -> None:
        query = parse_qs(scope["query_string"].decode("latin-1"))
        if scope["path"] == LOGOUT and session is not None:
            self._sessions.end(session)
            await self._enter(send, None, "/")
        elif scope["path"] == LOGIN and scope["method"] == "POST" and self._sessions.users is not None:
            fields = parse_qs((await _body(receive)).decode("utf-8", "replace"))
            device = _cookie(_header(scope, b"cookie"), self._device)
            made = await self._logins.by_password(
                _first(fields, "name"), _first(fields, "password"), _address(scope), device
            )
            if made is None:
                text = "This name and password are not known, or were wrong too often: wait a minute."
                await _answer(send, 403, text, _FORM)
            else:
                await self._enter(send, made, "/", self._sessions.device_of(made))
        elif "token" in query and (made := self._sessions.by_token(_first(query, "token"))) is not None:
            rest = urlencode({name: values for name, values in query.items() if name != "token"}, doseq=True)
            await self._enter(send, made, scope["path"] + (f"?{rest}" if rest else ""))
        elif self._sessions.users is not None:
            await _answer(send, 401, "Who are you?", _FORM)
        else:
            await _answer(send, 401, "Open the address that the console has printed: it has a token in it.")

    async def _enter(self, send: Any, session: Session | None, target: str, device: str = "") -> None:
        end = "; HttpOnly; SameSite=Strict" + ("; Secure" if self._secure else "")
        key, age = ("", "; Max-Age=0") if session is None else (session.key, "")
        cookies = [f"{self._device}={device}; Path={LOGIN}{end}; Max-Age={DEVICE_AGE}"] if device else []
        cookies.append(f"{self._cookie}={key}; Path=/{end}{age}")
        path, question, rest = target.partition("?")
        location = "/" + quote(path.lstrip("/")) + question + rest
        headers = [(b"location", location.encode()), *((b"set-cookie", each.encode()) for each in cookies)]
        await _respond(send, 303, headers, b"")

    async def _pass(self, scope: Any, receive: Any, send: Any, session: Session) -> None:
        left, gone, answered = LARGEST, False, False

        async def limited() -> Any:
            nonlocal left, gone
            message = await receive()
            gone = gone or message["type"] == "http.disconnect"
            left -= len(message.get("body", b""))
            return message if left >= 0 else {"type": "http.disconnect"}

        async def headed(message: Any) -> None:
            nonlocal answered
            if message["type"] == "http.response.start":
                answered = True
                message = {**message, "headers": [*message.get("headers", []), *HEADERS]}
            await send(message)

        try:
            await self._behind(scope)({**scope, SESSION: session}, limited, headed)
        except RuntimeError as error:
            # What is behind has no answer for a browser that has left meanwhile, and says so as an error.
            if not (gone or left < 0) or "No response returned" not in str(error):
                raise
        if left < 0 and not answered:
            await _answer(send, 413, f"more than {LARGEST} bytes")


def _address(scope: Any) -> str:
    return (scope.get("client") or ("",))[0]


def _header(scope: Any, name: bytes) -> str:
    return b"; ".join(value for each, value in scope["headers"] if each.lower() == name).decode("latin-1")


def _cookie(text: str, name: str) -> str:
    try:
        found = SimpleCookie(text).get(name)
    except CookieError:
        return ""
    return "" if found is None else found.value


def _first(fields: dict[str, list[str]], name: str) -> str:
    return fields.get(name, [""])[0]


async def _body(receive: Any, most: int = 4096) -> bytes:
    body, more = b"", True
    while more and len(body) <= most:
        message = await receive()
        body += message.get("body", b"")
        more = message.get("more_body", False)
    return body[:most]


async def _answer(send: Any, status: int, text: str, form: str = "") -> None:
    page = _PAGE.format(text=html.escape(text), form=form)
    await _respond(send, status, [(b"content-type", b"text/html; charset=utf-8")], page.encode())


async def _respond(send: Any, status: int, headers: list[tuple[bytes, bytes]], body: bytes) -> None:
    length = (b"content-length", str(len(body)).encode())
    await send({"type": "http.response.start", "status": status, "headers": [*headers, length, *HEADERS]})
    await send({"type": "http.response.body", "body": body})
