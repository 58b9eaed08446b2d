"""Behaviours as files: those of the user in a folder of theirs, and those that are bundled with the library.

`PlannedStore` is the store as it will be when the functions of a chain before have been carried out. `from_goal` writes
a goal down as the text of a behaviour.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from naoqi.errors import NaoError

from ..core.errors import BadGoal
from ..core.fields import UNUSUAL
from ..core.files import give_name, tidy, write_whole
from .behavior_errors import BehaviorError, NoSuchBehavior, Problem
from .behavior_reader import read, require_name, walk
from .model import Behavior, Box
from .parameters import IDENTIFIER, escaped
from .server_functions import OWN, fields_of
from .strict_yaml import dump

SUFFIX = ".yaml"


class BehaviorStore:
    """Behaviours by name. One of the user's counts instead of one of the library's.

    `folder`: of the user; made when the first one is saved. `shipped`: of the library; never written to.
    """

    def __init__(self, folder: Path, shipped: Path) -> None:
        self.folder = folder
        self.shipped = shipped
        tidy(folder)

    def names(self) -> list[str]:
        """Names of all behaviours, sorted."""
        return sorted({*_names(self.folder), *_names(self.shipped)})

    def text(self, name: str) -> str:
        """The text of a file.

        Raises NoSuchBehavior if there is none of that name, BehaviorError if the file cannot be read.
        """
        return self._read(self._existing(name))

    def shipped_text(self, name: str) -> str:
        """The text of a file that comes with the library.

        Raises NoSuchBehavior if there is none of that name, BehaviorError if the file cannot be read.
        """
        if not self.is_shipped(name):
            raise NoSuchBehavior(name, self.names())
        return self._read(self.shipped / f"{name}{SUFFIX}")

    def load(self, name: str) -> Behavior:
        """A behaviour, as far as it can be read without knowing servers and boxes.

        Raises NoSuchBehavior if there is none of that name, BehaviorError if there is something wrong with it.
        """
        path = self._existing(name)
        return read(self._read(path), name, str(path))

    def exists(self, name: str) -> bool:
        return self.of_user(name) or self.is_shipped(name)

    def is_shipped(self, name: str) -> bool:
        """Whether one of that name comes with the library."""
        return (self.shipped / f"{require_name(name)}{SUFFIX}").is_file()

    def of_user(self, name: str) -> bool:
        return self.path(name).is_file()

    def users_of(self, name: str) -> list[str]:
        """Behaviours that have one as a box, as far as their files can be read."""
        users = []
        for other in self.names():
            try:
                steps = walk(self.load(other).body)
            except NaoError:
                continue
            if any(isinstance(step, Box) and step.name == name for step in steps):
                users.append(other)
        return users

    def save(self, name: str, text: str, overwrite: bool = False, numbered: bool = False) -> Path:
        """Write a behaviour; one of that name is replaced as a whole, never left half written.

        Returns its file. Raises BadGoal if the name will not do or is taken, FileTrouble if the file cannot be written.

        Args:
            name: A name that a behaviour may have.
            text: What to write; it is not looked at.
            overwrite: Whether one of the user's may be replaced.
            numbered: Whether, where it may not, it becomes name-2, name-3, ...
        """
        path = self.path(name)
        if not overwrite and not numbered:
            self.require_free(name)
        try:
            return write_whole(path, text, numbered and not overwrite)
        except UnicodeEncodeError as error:
            raise BadGoal(
                "str_param", name, "characters of UTF-8", problem=f"{path} cannot be written: {error}"
            ) from error

    def rename(self, name: str, new_name: str, overwrite: bool = False) -> Path:
        """Give one of the user's behaviours another name; answers its file.

        Raises NoSuchBehavior if there is none of that name; BadGoal if it is one of the library's, or the new name will
        not do.
        """
        path, target = self.require_of_user(name), self.path(new_name, "new_name")
        if not overwrite:
            self.require_free(new_name, "new_name")
        try:
            given = os.replace(path, target) is None if overwrite else give_name(path, target)
        except OSError as error:
            raise BadGoal("new_name", new_name, "a folder to write to", problem=str(error)) from error
        return target if given else self.rename(name, new_name)  # one of that name came a moment ago

    def delete(self, name: str) -> None:
        """Delete one of the user's behaviours.

        Raises NoSuchBehavior if there is none of that name, BadGoal if it is one of the library's.
        """
        try:
            self.require_of_user(name).unlink()
        except OSError as error:
            raise BadGoal("str_param", name, "a folder to write to", problem=str(error)) from error

    def require_free(self, name: str, field: str = "str_param") -> None:
        """See that no behaviour of the user has a name. One of the library may: it is not replaced, only put behind.

        Raises BadGoal if one has.
        """
        if self.path(name, field).is_file():
            problem = f"there is a behavior {name!r} already"
            raise BadGoal(field, name, "a name that is free, or overwrite", problem=problem)

    def require_of_user(self, name: str) -> Path:
        """File of one of the user's behaviours.

        Raises NoSuchBehavior if there is none of that name, BadGoal if it is one of the library's.
        """
        if self.of_user(name):
            return self.path(name)
        if self.exists(name):
            problem = f"{name!r} comes with the library and cannot be changed"
            raise BadGoal("str_param", name, "one of your own: copyBehavior makes one of it", problem=problem)
        raise NoSuchBehavior(name, self.names())

    def path(self, name: str, field: str = "str_param") -> Path:
        """File of a behaviour of the user, whether it is there or not. Raises BadGoal if the name will not do."""
        return self.folder / f"{require_name(name, field)}{SUFFIX}"

    def _existing(self, name: str) -> Path:
        for path in (self.path(name), self.shipped / f"{name}{SUFFIX}"):
            if path.is_file():
                return path
        raise NoSuchBehavior(name, self.names())

    @staticmethod
    def _read(path: Path) -> str:
        try:
            return path.read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise BehaviorError(path.stem, [Problem("", f"{path} cannot be read: {error}")]) from error


def _names(folder: Path) -> list[str]:
    return [path.stem for path in folder.glob(f"*{SUFFIX}") if path.is_file()] if folder.is_dir() else []


# --- the store during a check -----------------------------------------------------------------------------------------

KEY = "behaviors"
_UNKNOWN, _GONE = object(), object()


class UnknownYet(Exception):
    """A behaviour will be recorded by a function of the chain: nothing is known of it yet."""


class PlannedStore:
    """What checks ask instead of the store."""

    def __init__(self, store: BehaviorStore) -> None:
        self._store = store
        self._changes: dict[str, Any] = {}

    @classmethod
    def of(cls, store: BehaviorStore, context: dict[str, Any]) -> PlannedStore:
        """The one that belongs to the check of a chain. `context`: lives as long as the check."""
        return context.setdefault(KEY, cls(store))

    def load(self, name: str) -> Behavior:
        """A behaviour. Raises UnknownYet if it will be recorded, NaoError as `BehaviorStore.load`."""
        change = self._changes.get(name)
        if change is _UNKNOWN:
            raise UnknownYet(name)
        return self._store.load(name) if change is None else read(self.text(name) or "", name)

    def text(self, name: str) -> str | None:
        """The text of a behaviour; None if it will be recorded."""
        change = self._changes.get(name)
        if change is _UNKNOWN:
            return None
        if isinstance(change, str):
            return change
        if change is None:
            return self._store.text(name)
        if self._store.is_shipped(name):
            return self._store.shipped_text(name)
        raise self._unknown(name)

    def require_of_user(self, name: str) -> None:
        """See that one can be changed. Raises NaoError as `BehaviorStore.require_of_user`."""
        change = self._changes.get(name)
        if change is _GONE:
            raise self._unknown(name)
        if change is None:
            self._store.require_of_user(name)

    def require_free(self, name: str, overwrite: bool, field: str = "str_param") -> None:
        """See that a name can be given to a behaviour. Raises BadGoal if it will not do, or is taken."""
        self._store.path(name, field)
        change = self._changes.get(name)
        if overwrite or change is _GONE:
            return
        if change is not None:
            raise BadGoal(
                field, name, "a name that is free, or overwrite", f"the chain makes a behavior {name!r} before"
            )
        self._store.require_free(name, field)

    def put(self, name: str, text: str | None) -> None:
        """A behaviour will be there. `text`: None if it is recorded."""
        self._changes[name] = _UNKNOWN if text is None else text

    def remove(self, name: str) -> None:
        """The user's behaviour of a name will not be there any more."""
        self._changes[name] = _GONE

    def _unknown(self, name: str) -> NoSuchBehavior:
        gone = {each for each, change in self._changes.items() if change is _GONE and not self._store.is_shipped(each)}
        return NoSuchBehavior(name, {*self._store.names(), *self._changes} - gone)


# --- from goals to text -----------------------------------------------------------------------------------------------


def step_of(server: str, goal: Any, unusual: bool = False) -> dict[str, Any]:
    """A goal as a step of a file: a function, or a chain of them; `unusual`: with numbers that are not usual.

    Raises BadGoal if steps may not use the server.
    """
    meant = {UNUSUAL: True} if unusual else {}
    if server == OWN:
        raise BadGoal("server", server, "another one", "a behavior that sends goals to NaoBehavior would end itself")
    messages = getattr(goal, goal.__slots__[0])
    functions = [escaped(fields_of(message)) for message in messages]
    if len(functions) == 1 and IDENTIFIER.fullmatch(functions[0].get("function", "")):
        fields = dict(functions[0])
        return {f"{server}.{fields.pop('function')}": fields, **meant}
    return {"chain": {server: functions}, **meant}


def text_of(help_: str, steps: Sequence[Mapping[str, Any]], tags: Sequence[str] = ()) -> str:
    """The text of a behaviour without parameters."""
    content: dict[str, Any] = {"help": help_}
    if tags:
        content["tags"] = list(tags)
    return dump({**content, "do": [dict(step) for step in steps]})


def from_goal(server: str, goal: Any, help_: str = "", unusual: bool = False) -> str:
    """Write down one goal as a behaviour; what is returned can be stored: `store.save(name, text)`.

    `unusual`: as `step_of` takes it.

    Raises BadGoal if steps may not use the server.
    """
    return text_of(help_ or f"A goal of {server}.", [step_of(server, goal, unusual)])
