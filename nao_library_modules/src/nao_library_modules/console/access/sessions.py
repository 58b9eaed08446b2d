"""Browsers that have shown a token or a password."""

from __future__ import annotations

import hashlib
import hmac
import secrets
import threading
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from .connections import address_group
from .session_file import KeptSession, SessionFile
from .users import OBSERVER, OPERATOR, ConsoleUser

TRIES, TRY_PERIOD = 5, 60.0
"""Wrong passwords of one source within so many s, after which none of its is looked at."""
MOST_SOURCES = 10_000
"""Sources whose wrong passwords are counted: a flood of addresses takes no more memory, and forgets the oldest."""
LONGEST_NAME = 100
NOBODY = ConsoleUser("", OBSERVER, "scrypt$AAAA$AAAA")
"""Has no password."""


@dataclass(eq=False)
class Session:
    """One person at one browser.

    Attributes:
        dark: Whether pages are dark; None: as the computer is.
        began: s since 1970.
    """

    name: str
    role: str
    key: str = field(repr=False, default_factory=lambda: secrets.token_urlsafe(32))
    dark: bool | None = None
    began: float = field(default_factory=time.time)

    @property
    def operator(self) -> bool:
        """Whether this person may move the robot."""
        return self.role == OPERATOR


class Sessions:
    """Those of one console. Any thread.

    Args:
        users: Name -> person, where people log in; None: whoever has one of the tokens.
        clock: s.

    Attributes:
        on_end: Called with each session that has ended.
        tokens: Role -> token, for the printed addresses; empty where people log in.
    """

    def __init__(
        self, users: Mapping[str, ConsoleUser] | None = None, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self.users = users
        self.tokens = {role: secrets.token_urlsafe(24) for role in (OPERATOR, OBSERVER)} if users is None else {}
        self.on_end: Callable[[Session], None] = lambda _: None
        self._clock = clock
        self._lock = threading.Lock()
        self._sessions: dict[str, Session] = {}
        self._file: SessionFile | None = None
        self._failures: dict[str, list[float]] = {}
        self._count = 0

    def get(self, key: str) -> Session | None:
        """The session of a cookie."""
        with self._lock:
            return self._sessions.get(key)

    def keep_in(self, file: SessionFile) -> None:
        """Have the sessions of a file, which an earlier console has left, and keep all in it from now on.

        Left out are those of people whose password, or who themselves, are not in the file of people any more, and
        those that were got in the other way: with a token where people log in, or the reverse.
        """
        for kept in file.read():
            session = self._restored(kept)
            if session is not None:
                with self._lock:
                    self._sessions.setdefault(session.key, session)
        self._file = file

    def _restored(self, kept: KeptSession) -> Session | None:
        if self.users is None:
            return None if kept.proof else Session(kept.name, kept.role, kept.key, began=kept.began)
        user = self.users.get(kept.name)
        if user is None or not hmac.compare_digest(kept.proof.encode(), _signed(user, kept.key).encode()):
            return None
        return Session(user.name, user.role, kept.key, began=kept.began)

    def _write(self) -> None:
        """Have the sessions in the file, beside the event loop. Under the lock."""
        if self._file is not None:
            self._file.write(self._kept(each) for each in self._sessions.values())

    def _kept(self, session: Session) -> KeptSession:
        user = (self.users or {}).get(session.name)
        proof = "" if user is None else _signed(user, session.key)
        return KeptSession(session.key, session.name, session.role, proof, session.began)

    def by_token(self, token: str) -> Session | None:
        """A new session for whoever shows a token; None if it is none."""
        for role, known in self.tokens.items():
            if secrets.compare_digest(token.encode(), known.encode()):
                with self._lock:
                    name = self._new_name(role)
                return self._keep(Session(name, role))
        return None

    def _new_name(self, role: str) -> str:
        """Name of whoever comes with a token; nobody else has it. Under the lock."""
        taken = {each.name for each in self._sessions.values()}
        while True:
            self._count += 1
            name = role if self._count == 1 else f"{role} {self._count}"
            if name not in taken:
                return name

    def source_of(self, name: str, address: str, device: str) -> str:
        """Whose budget a try is counted on: that of a browser which this person has logged in with, or its address.

        So nobody can use up the tries of a person at another address, nor those of a browser that is known.
        `device`: what `device_of` gave that browser; empty: nothing.
        """
        user, nonce = (self.users or {}).get(name), device.partition(".")[0]
        if user is not None and device and hmac.compare_digest(device.encode(), _signed(user, nonce).encode()):
            return f"device {nonce}"
        return f"address {address_group(address)}"

    def device_of(self, session: Session) -> str:
        """What a browser keeps to be known again at the next login of the same person; no session comes of it."""
        user = (self.users or {}).get(session.name)
        return "" if user is None else _signed(user, secrets.token_hex(8))

    def by_password(self, name: str, password: str, source: str = "") -> Session | None:
        """A new session for whoever knows the password; None if it is wrong, or its source was wrong too often lately.

        Takes 40 ms of a processor: not for the event loop. `source`: as `source_of` gives it.
        """
        now = self._clock()
        with self._lock:
            recent = [when for when in self._failures.pop(source, []) if when > now - TRY_PERIOD]
            self._failures[source] = recent  # the newest source last
            while len(self._failures) > MOST_SOURCES:
                del self._failures[next(iter(self._failures))]
            if len(recent) >= TRIES:
                return None
            recent.append(now)  # taken back below: tries side by side count as well
        user = (self.users or {}).get(name[:LONGEST_NAME])
        right = (user or NOBODY).has_password(password)  # a name that there is not takes as long
        if user is None or not right:
            return None
        with self._lock:
            recent.remove(now)
        return self._keep(Session(user.name, user.role))

    def known(self, session: Session) -> bool:
        """Whether a session has not ended."""
        return self.get(session.key) is session

    def end(self, session: Session) -> None:
        """Forget a session; `on_end` is told."""
        with self._lock:
            self._sessions.pop(session.key, None)
            self._write()
        self.on_end(session)

    def _keep(self, session: Session) -> Session:
        with self._lock:
            self._sessions[session.key] = session
            self._write()
        return session


def _signed(user: ConsoleUser, nonce: str) -> str:
    """A text that only who has the file of people can make, for one person and until the password changes."""
    key = f"{user.name} {user.password}".encode()
    return f"{nonce}.{hmac.new(key, nonce.encode(), hashlib.sha256).hexdigest()}"
