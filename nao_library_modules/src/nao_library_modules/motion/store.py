"""Recorded motions as YAML files of one folder, and those that come with the library."""

from __future__ import annotations

from pathlib import Path

import yaml

from ..base.errors import BadGoal
from ..base.suggestion import did_you_mean
from ..base.whole_file import give_name, tidy, write_whole
from ..base.yaml_values import Budget, load_within
from .fields import require_name
from .recorded_motion import RecordedMotion, motion_of

SUFFIX = ".yaml"
MOST_VALUES, DEEPEST = 10_000_000, 10
"""Of a file: values, more than the longest recording of all joints has, and lists in each other."""


class MotionStore:
    """Recorded motions by name.

    `folder`: where they are; made when the first one is saved. `shipped`: where there are more that can only be
    replayed; those in `folder` stand before them.
    """

    def __init__(self, folder: Path, shipped: Path | None = None) -> None:
        self.folder = folder
        self._shipped = shipped
        tidy(folder)

    def names(self) -> list[str]:
        """Names of the motions in the folder, sorted."""
        return _names(self.folder)

    def load(self, name: str) -> RecordedMotion:
        """A motion. Raises BadGoal if there is none of that name, or its file is broken."""
        path: Path | None = self.path(name)
        if not path.is_file():
            path = self._shipped_file(name)
            if path is None:
                raise self._unknown(name)
        try:
            content = load_within(path.read_text(encoding="utf-8"), Budget(MOST_VALUES, DEEPEST))
        except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
            raise BadGoal("str_param", name, "a recorded motion", problem=f"motion {name!r}: {error}") from error
        return motion_of(content, name)

    def save(self, name: str, motion: RecordedMotion, numbered: bool = False) -> Path:
        """Write a motion; one of that name is replaced as a whole, never left half written.

        `motion`: what to write. `numbered`: whether, where there is one of that name, it becomes name-2, name-3, ...
        and replaces none. Raises BadGoal if the name will not do, FileTrouble if the file cannot be written.
        """
        path = self.path(name)
        text = yaml.safe_dump(motion.to_content(), default_flow_style=None, sort_keys=False, width=10**6)
        return write_whole(path, text, numbered)

    def rename(self, name: str, new_name: str) -> Path:
        """Give a motion another name; answers its file.

        Raises BadGoal if there is none of that name, it comes with the library, there is one of the new name already,
        or the file cannot be renamed.
        """
        path, target = self.require(name), self.require_free(new_name)
        try:
            given = give_name(path, target)
        except OSError as error:
            problem = f"{path} cannot be renamed to {target.name}: {error.strerror or error}"
            raise BadGoal("texts", new_name, "a folder to write to", problem) from error
        return target if given else self.rename(name, new_name)  # one of that name came a moment ago

    def delete(self, name: str) -> None:
        """Delete a motion.

        Raises BadGoal if there is none of that name, it comes with the library, or the file cannot be deleted.
        """
        path = self.require(name)
        try:
            path.unlink()
        except OSError as error:
            problem = f"{path} cannot be deleted: {error.strerror or error}"
            raise BadGoal("str_param", name, "a folder to write to", problem) from error

    def require_free(self, name: str, field: str = "texts") -> Path:
        """File of a new motion, whose name is in `field` of the message.

        Raises BadGoal if the name will not do, or there is a motion of that name already.
        """
        path = self.path(name, field)
        if path.exists():
            allowed = "a name that is free, or overwrite" if field == "str_param" else "a name that is free"
            raise BadGoal(field, name, allowed, problem=f"there is a motion {name!r} already: {path}")
        return path

    def path(self, name: str, field: str = "str_param") -> Path:
        """File of a motion of that name, whether it is there or not. Raises BadGoal if the name will not do."""
        require_name(field, name)
        return self.folder / f"{name}{SUFFIX}"

    def require(self, name: str) -> Path:
        """File of a motion that can be renamed and deleted.

        Raises BadGoal if there is none of that name, or it comes with the library.
        """
        path = self.path(name)
        if not path.is_file():
            if self._shipped_file(name) is not None:
                problem = f"motion {name!r} comes with the library"
                raise BadGoal("str_param", name, "one that was recorded", problem=problem)
            raise self._unknown(name)
        return path

    def _shipped_file(self, name: str) -> Path | None:
        path = self._shipped / f"{name}{SUFFIX}" if self._shipped is not None else None
        return path if path is not None and path.is_file() else None

    def _unknown(self, name: str) -> BadGoal:
        known = sorted({*self.names(), *(_names(self._shipped) if self._shipped is not None else ())})
        allowed = f"one of {', '.join(known)}" if known else f"none is recorded in {self.folder} yet"
        return BadGoal("str_param", name, allowed, problem=f"there is no motion {name!r}{did_you_mean(name, known)}")


def _names(folder: Path) -> list[str]:
    return sorted(path.stem for path in folder.glob(f"*{SUFFIX}")) if folder.is_dir() else []
