"""Users and their sessions: the file of hashed passwords, roles, tokens, logins, limits of wrong passwords, controls.

`SessionFile` keeps sessions over a restart. `Controls` knows which operator holds the controls of which robot.
"""

from __future__ import annotations

import asyncio
import base64
import hashlib
import hmac
import json
import logging
import os
import re
import secrets
import stat
import threading
import time
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass, field, fields
from pathlib import Path

from naoqi.errors import NaoError

from ...behaviors.behavior_errors import Problem
from ...behaviors.strict_yaml import dump, line_in
from ...core.files import draft_in, put_aside, write_whole
from ...studies.commands import ConsoleFileError, FileReader
from .connections import address_group

OPERATOR, OBSERVER = "operator", "observer"
ROLES = (OPERATOR, OBSERVER)
COST, BLOCK, LANES = 2**14, 8, 1
"""Of scrypt: 16 MiB and some 40 ms for one password."""
SHORTEST = 8
_NAME = re.compile(r"[\w.@-]{1,40}")


HASHED = re.compile(r"scrypt(\$(?=[^$])(?:[A-Za-z0-9+/]{4})*(?:[A-Za-z0-9+/]{2}==|[A-Za-z0-9+/]{3}=)?){2}")


@dataclass(frozen=True)
class ConsoleUser:
    """A person who may log in. `password`: scrypt$SALT$HASH, both base64."""

    name: str
    role: str
    password: str

    def has_password(self, password: str) -> bool:
        """Whether it is theirs; takes as long for a wrong one."""
        _, salt, wanted = self.password.split("$")
        return hmac.compare_digest(_hash(password, base64.b64decode(salt)), base64.b64decode(wanted))


def hashed(password: str) -> str:
    """A password as the file has it. Raises NaoError if it is too short."""
    if len(password) < SHORTEST:
        raise NaoError(f"a password has {SHORTEST} characters at least")
    salt = secrets.token_bytes(16)
    return "$".join(("scrypt", *(base64.b64encode(part).decode() for part in (salt, _hash(password, salt)))))


def read_users(path: Path) -> Mapping[str, ConsoleUser]:
    """The people of a file. Raises ConsoleFileError with all that is wrong with it; without them nobody is let in."""
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise ConsoleFileError(str(path), [Problem("", f"cannot be read: {error}")]) from error
    reader = FileReader(text, path.name)
    users = {}
    for name, entry in reader.mapping(
        reader.content, "", reader.content if isinstance(reader.content, dict) else ()
    ).items():
        fields = reader.mapping(entry, str(name), ("role", "password"), ("role", "password"))
        role = reader.choice(fields, "role", str(name), ROLES, OBSERVER)
        password = reader.text(fields, "password", str(name))
        if not HASHED.fullmatch(password):
            reader.note(
                f"{name}.password",
                "no hash: `nao console --users FILE --add-user NAME` writes one",
                line_in(fields, "password"),
            )
        users[str(name)] = ConsoleUser(str(name), role, password)
    reader.finish()
    return users


def add_user(path: Path, name: str, role: str, password: str) -> None:
    """Write a person into a file, which only its owner can read then; one of that name is replaced. Raises NaoError."""
    if not _NAME.fullmatch(name):
        raise NaoError(f"{name!r} is no name: up to 40 letters, digits and . _ @ -")
    users = dict(read_users(path)) if path.exists() else {}
    users[name] = ConsoleUser(name, role, hashed(password))
    text = dump({each.name: {"role": each.role, "password": each.password} for each in users.values()})
    before = os.umask(0o077)
    try:
        write_whole(path, text)
    finally:
        os.umask(before)


def _hash(password: str, salt: bytes) -> bytes:
    return hashlib.scrypt(password.encode(), salt=salt, n=COST, r=BLOCK, p=LANES)


log = logging.getLogger(__name__)

LONGEST = 86400.0
"""s since a session began, after which a restarted console does not know it."""
MODE = 0o600


@dataclass(frozen=True)
class KeptSession:
    """A session in the file. `proof`: of a person who logged in, made with the hash of the password; else empty."""

    key: str
    name: str
    role: str
    proof: str
    began: float  # s since 1970


class SessionFile:
    """The file of one console, which only its owner can read. Any thread; writes are made in one of their own.

    `clock`: s since 1970.
    """

    def __init__(self, path: Path, clock: Callable[[], float] = time.time) -> None:
        self.path = path
        self._clock = clock
        self._wanted = threading.Condition()
        self._next: str | None = None
        self._writing = False

    def read(self) -> list[KeptSession]:
        """Sessions that are not too old. What others may have written or read is not believed, and put aside."""
        try:
            with self.path.open("rb") as file:
                about = os.fstat(file.fileno())
                content = file.read()
        except FileNotFoundError:
            return []
        except OSError as error:
            log.error("%s cannot be read: %s; who was logged in logs in again", self.path, error)
            return []
        if about.st_uid != os.geteuid() or stat.S_IMODE(about.st_mode) & 0o077:
            put_aside(self.path, "others may read or write it: its mode should be 0600", _WITHOUT)
            return []
        try:
            kept = [_read_one(each) for each in json.loads(content)]
        except (ValueError, TypeError, RecursionError) as error:
            put_aside(self.path, error, _WITHOUT)
            return []
        now = self._clock()
        return [each for each in kept if now - LONGEST < each.began <= now]

    def write(self, sessions: Iterable[KeptSession]) -> None:
        """Have these in the file, soon; the newest call counts."""
        text = json.dumps([asdict(each) for each in sessions])
        with self._wanted:
            self._next = text
            if self._writing:
                return
            self._writing = True
        threading.Thread(target=self._write, name="sessions", daemon=True).start()

    def wait(self, timeout: float | None = None) -> bool:
        """Wait until all is written; whether it is."""
        with self._wanted:
            return self._wanted.wait_for(lambda: not self._writing, timeout)

    def _write(self) -> None:
        while True:
            with self._wanted:
                text, self._next = self._next, None
                if text is None:
                    self._writing = False
                    self._wanted.notify_all()
                    return
            try:
                self._replace(text)
            except OSError as error:
                log.error("%s cannot be written: %s; after a restart everybody logs in again", self.path, error)

    def _replace(self, text: str) -> None:
        self.path.parent.mkdir(parents=True, exist_ok=True)
        with draft_in(self.path.parent) as draft:
            draft.chmod(MODE)  # before there is anything in it
            draft.write_text(text, encoding="utf-8")
            os.replace(draft, self.path)


_WITHOUT = "who was logged in logs in again"


def _read_one(entry: object) -> KeptSession:
    """Raises ValueError, TypeError if it is none."""
    if not isinstance(entry, dict):
        raise ValueError("an entry that is no session")
    kept = KeptSession(**entry)
    for each in fields(KeptSession):
        value, kind = getattr(kept, each.name), float if each.name == "began" else str
        if not isinstance(value, kind):
            raise ValueError(f"{each.name} of a session: {value!r}")
    if kept.role not in ROLES:
        raise ValueError(f"role of a session: {kept.role!r}; {' or '.join(ROLES)} would be right")
    return kept


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


WORKERS = 2
"""Passwords that are looked at side by side: each takes 16 MiB."""
MOST_WAITING = 5
"""Tries of one source that wait for their turn; more are refused at once."""


class Logins:
    """Takes the tries of each source one after the other, so that a source with many waits for itself. Event loop."""

    def __init__(self, sessions: Sessions) -> None:
        self._sessions = sessions
        self._threads = ThreadPoolExecutor(WORKERS, "login")
        self._turns: dict[str, asyncio.Lock] = {}
        self._waiting: dict[str, int] = {}

    async def by_password(self, name: str, password: str, address: str, device: str) -> Session | None:
        """A new session, or None; see `Sessions.by_password`."""
        source = self._sessions.source_of(name, address, device)
        if self._waiting.get(source, 0) >= MOST_WAITING:
            return None
        self._waiting[source] = self._waiting.get(source, 0) + 1
        try:
            async with self._turns.setdefault(source, asyncio.Lock()):
                return await asyncio.get_running_loop().run_in_executor(
                    self._threads, self._sessions.by_password, name, password, source
                )
        finally:
            self._waiting[source] -= 1
            if not self._waiting[source]:
                del self._waiting[source], self._turns[source]


class Controls:
    """Of all robots. Any thread.

    One operator at a time holds the controls of a robot: the first who does something, until another takes them or the
    last page of the holder is gone.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._pages: dict[object, tuple[Session, str]] = {}
        self._holders: dict[str, Session] = {}

    def enter(self, session: Session, robot: str) -> Callable[[], None]:
        """A page was opened; what comes back is to be called when it is gone."""
        key = object()
        with self._lock:
            self._pages[key] = (session, robot)
        return lambda: self._leave(key)

    def visitors(self, robot: str) -> list[Session]:
        """Who has a page of a robot open, each once."""
        with self._lock:
            return list(dict.fromkeys(session for session, where in self._pages.values() if where == robot))

    def holder(self, robot: str) -> Session | None:
        with self._lock:
            return self._holders.get(robot)

    def take(self, robot: str, session: Session) -> bool:
        """Hold the controls from now on, whoever did before; whether that is allowed."""
        if not session.operator:
            return False
        with self._lock:
            self._holders[robot] = session
        return True

    def release(self, robot: str, session: Session) -> None:
        with self._lock:
            if self._holders.get(robot) is session:
                del self._holders[robot]

    def may_move(self, robot: str, session: Session) -> bool:
        """Whether somebody may move a robot now: who holds its controls, or an operator where nobody does."""
        if not session.operator:
            return False
        with self._lock:
            return self._holders.setdefault(robot, session) is session

    def refusal(self, robot: str, session: Session) -> str:
        """Why somebody may not move a robot."""
        if not session.operator:
            return "observers look on; only operators move the robot"
        holder = self.holder(robot)
        return f"{holder.name if holder else 'nobody'} holds the controls of {robot}: take them over first"

    def forget(self, session: Session) -> None:
        """Somebody has logged out."""
        with self._lock:
            self._holders = {robot: holder for robot, holder in self._holders.items() if holder is not session}

    def _leave(self, key: object) -> None:
        with self._lock:
            self._pages.pop(key, None)
            there = {session for session, _ in self._pages.values()}
            self._holders = {robot: holder for robot, holder in self._holders.items() if holder in there}
