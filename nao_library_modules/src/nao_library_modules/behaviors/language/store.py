"""Behaviours as files: those of the user in a folder of theirs, and those that come with the library."""

from __future__ import annotations

import os
from pathlib import Path

from naoqi.errors import NaoError

from ...base.errors import BadGoal
from ...base.whole_file import give_name, tidy, write_whole
from .errors import BehaviorError, NoSuchBehavior, Problem
from .model import Behavior, Box
from .reader import read, require_name
from .structure import walk

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
