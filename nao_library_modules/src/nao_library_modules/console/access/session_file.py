"""Sessions in a file, so that browsers are known again after a restart of the console."""

from __future__ import annotations

import json
import logging
import os
import stat
import threading
import time
from collections.abc import Callable, Iterable
from dataclasses import asdict, dataclass, fields
from pathlib import Path

from ...base.whole_file import draft_in, put_aside
from .users import ROLES

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
