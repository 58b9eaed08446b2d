"""Behaviours as files: the user's in a folder of their own, and those shipped with the library."""

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
    """Behaviours by name. The user's hides the library's of the same name.

    Args:
        folder: The user's; created on the first save.
        shipped: The library's; read only.
    """

    def __init__(self, folder: Path, shipped: Path) -> None:
        self.folder = folder
        self.shipped = shipped
        tidy(folder)

    def names(self) -> list[str]:
        """Names of all behaviours, sorted."""
        return sorted({*_names(self.folder), *_names(self.shipped)})

    def text(self, name: str) -> str:
        """The text of a behaviour's file.

        Raises:
            NoSuchBehavior: There is none of that name.
            BehaviorError: The file cannot be read.
        """
        return self._read(self._existing(name))

    def shipped_text(self, name: str) -> str:
        """As `text`, of a behaviour shipped with the library."""
        if not self.is_shipped(name):
            raise NoSuchBehavior(name, self.names())
        return self._read(self.shipped / f"{name}{SUFFIX}")

    def load(self, name: str) -> Behavior:
        """A behaviour, read without knowledge of servers and boxes.

        Raises:
            NoSuchBehavior: There is none of that name.
            BehaviorError: It has a problem.
        """
        path = self._existing(name)
        return read(self._read(path), name, str(path))

    def exists(self, name: str) -> bool:
        return self.of_user(name) or self.is_shipped(name)

    def is_shipped(self, name: str) -> bool:
        return (self.shipped / f"{require_name(name)}{SUFFIX}").is_file()

    def of_user(self, name: str) -> bool:
        return self.path(name).is_file()

    def users_of(self, name: str) -> list[str]:
        """Behaviours that use this one as a box, as far as their files can be read."""
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
        """Write a behaviour atomically, and return its file.

        Args:
            text: Written unchecked.
            overwrite: Replace one of the user's.
            numbered: If the name is taken and must not be replaced, use name-2, name-3, ...

        Raises:
            BadGoal: The name is not allowed or taken.
            FileTrouble: The file cannot be written.
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
        """Rename one of the user's behaviours, and return its file.

        Raises:
            NoSuchBehavior: There is none of that name.
            BadGoal: It is one of the library's, or the new name is not allowed.
        """
        path, target = self.require_of_user(name), self.path(new_name, "new_name")
        if not overwrite:
            self.require_free(new_name, "new_name")
        try:
            given = os.replace(path, target) is None if overwrite else give_name(path, target)
        except OSError as error:
            raise BadGoal("new_name", new_name, "a folder to write to", problem=str(error)) from error
        return target if given else self.rename(name, new_name)  # else the new name was taken a moment ago

    def delete(self, name: str) -> None:
        """Delete one of the user's behaviours.

        Raises:
            NoSuchBehavior: There is none of that name.
            BadGoal: It is one of the library's.
        """
        try:
            self.require_of_user(name).unlink()
        except OSError as error:
            raise BadGoal("str_param", name, "a folder to write to", problem=str(error)) from error

    def require_free(self, name: str, field: str = "str_param") -> None:
        """Check that the user has no behaviour of this name. One of the library's may: it is hidden, not replaced.

        Raises:
            BadGoal: The user has one.
        """
        if self.path(name, field).is_file():
            problem = f"there is a behavior {name!r} already"
            raise BadGoal(field, name, "a name that is free, or overwrite", problem=problem)

    def require_of_user(self, name: str) -> Path:
        """File of one of the user's behaviours.

        Raises:
            NoSuchBehavior: There is none of that name.
            BadGoal: It is one of the library's.
        """
        if self.of_user(name):
            return self.path(name)
        if self.exists(name):
            problem = f"{name!r} comes with the library and cannot be changed"
            raise BadGoal("str_param", name, "one of your own: copyBehavior makes one of it", problem=problem)
        raise NoSuchBehavior(name, self.names())

    def path(self, name: str, field: str = "str_param") -> Path:
        """File of a user's behaviour, whether it exists or not.

        Raises:
            BadGoal: The name is not allowed.
        """
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
