"""People of the console: names, roles and passwords in a file, hashed."""

from __future__ import annotations

import base64
import hashlib
import hmac
import os
import re
import secrets
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from naoqi.errors import NaoError

from ...base.whole_file import write_whole
from ...behaviors.language.errors import Problem
from ...behaviors.language.yaml_text import dump, line_in
from ..files.yaml_file import ConsoleFileError, FileReader

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
