"""Recorded motions as YAML files of one folder."""

from __future__ import annotations

import os
import re
import tempfile
from pathlib import Path

import yaml

from .errors import BadGoal
from .recorded_motion import RecordedMotion, motion_of
from .suggestion import did_you_mean

SUFFIX = ".yaml"
MODE = 0o644
# No separators and no dot in front: a name stays in the folder.
NAME = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_. -]*")


class MotionStore:
    """Recorded motions by name.

    Args:
        folder: Where they are; made when the first one is saved.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def names(self) -> list[str]:
        """Names of all motions, sorted."""
        return sorted(path.stem for path in self.folder.glob(f"*{SUFFIX}")) if self.folder.is_dir() else []

    def load(self, name: str) -> RecordedMotion:
        """A motion.

        Raises:
            BadGoal: If there is none of that name, or its file is broken.
        """
        path = self._existing(name)
        try:
            content = yaml.safe_load(path.read_text(encoding="utf-8"))
        except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
            raise BadGoal("str_param", name, "a recorded motion", problem=f"motion {name!r}: {error}") from error
        return motion_of(content, name)

    def save(self, name: str, motion: RecordedMotion) -> None:
        """Write a motion; one of that name is replaced as a whole, never left half written.

        Raises:
            BadGoal: If the name will not do, or the file cannot be written.
        """
        path = self.path(name)
        text = yaml.safe_dump(motion.to_content(), default_flow_style=None, sort_keys=False, width=10**6)
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            descriptor, draft = tempfile.mkstemp(dir=self.folder, suffix=".draft")
            try:
                with os.fdopen(descriptor, "w", encoding="utf-8") as file:
                    file.write(text)
                os.chmod(draft, MODE)  # drafts are made for their owner alone
                os.replace(draft, path)
            except BaseException:
                os.unlink(draft)
                raise
        except OSError as error:
            raise BadGoal(
                "str_param", name, "a folder to write to", problem=f"{path} cannot be written: {error}"
            ) from error

    def rename(self, name: str, new_name: str) -> None:
        """Give a motion another name.

        Raises:
            BadGoal: If there is none of that name, or one of the new name already.
        """
        path, target = self._existing(name), self.require_free(new_name)
        path.rename(target)

    def delete(self, name: str) -> None:
        """Delete a motion.

        Raises:
            BadGoal: If there is none of that name.
        """
        self._existing(name).unlink()

    def require(self, name: str) -> None:
        """See that there is a motion.

        Raises:
            BadGoal: If there is none of that name.
        """
        self._existing(name)

    def require_free(self, name: str) -> Path:
        """File of a new motion, for a message that has its name in `texts`.

        Raises:
            BadGoal: If the name will not do, or there is a motion of that name already.
        """
        path = self.path(name, "texts")
        if path.exists():
            raise BadGoal("texts", name, "a name that is free", problem=f"there is a motion {name!r} already")
        return path

    def path(self, name: str, field: str = "str_param") -> Path:
        """File of a motion of that name, whether it is there or not.

        Raises:
            BadGoal: If the name will not do.
        """
        if not NAME.fullmatch(name):
            allowed = "letters, digits, '_', '-', '.' and blanks, the first a letter, a digit or '_'"
            raise BadGoal(field, name, allowed, problem=f"{name!r} is no name for a motion")
        return self.folder / f"{name}{SUFFIX}"

    def _existing(self, name: str) -> Path:
        path = self.path(name)
        if not path.is_file():
            known = self.names()
            raise BadGoal(
                "str_param",
                name,
                f"one of {', '.join(known)}" if known else f"none is recorded in {self.folder} yet",
                problem=f"there is no motion {name!r}{did_you_mean(name, known)}",
            )
        return path
