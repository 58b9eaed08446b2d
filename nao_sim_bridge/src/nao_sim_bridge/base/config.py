"""Where the data files of this package are, and strict reading of them: an error names the key and what is allowed."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import is_dataclass
from pathlib import Path
from typing import Any, TypeVar, get_origin, get_type_hints

import numpy as np

from nao_sim_bridge.base.errors import ConfigError, did_you_mean

T = TypeVar("T")
_PACKAGE = Path(__file__).resolve().parents[1]
LARGEST_FILE = 20_000_000
"""Bytes of a data file; clients bring some, too."""


def config_file(name: str) -> Path:
    """Path of a file in `config`."""
    return _PACKAGE / "config" / name


def world_directory() -> Path:
    return _PACKAGE / "worlds"


def sounds_directory() -> Path:
    """Directory of the sounds that come with the package, a folder a sound set."""
    return _PACKAGE / "sounds"


def robot_files_directory() -> Path:
    """Directory that is the root of those files of the robot that come with the package."""
    return _PACKAGE / "robot_files"


class TooLarge(ValueError):
    """A file that is larger than what is allowed; the text says what is."""


def read_bounded(path: Path, largest: int) -> bytes:
    """All of a file that others bring: counted while reading, whatever its folder says.

    Raises:
        TooLarge: It has more than `largest` bytes.
        OSError: It cannot be read.
    """
    with open(path, "rb") as file:
        content = file.read(largest + 1)
    if len(content) > largest:
        raise TooLarge(f"has more than {largest} bytes")
    return content


def read_json(path: Path) -> dict:
    """Content of a JSON file whose top level is an object."""
    try:
        content = json.loads(read_bounded(path, LARGEST_FILE))
    except (OSError, ValueError, RecursionError) as error:
        raise ConfigError(path.name, f"cannot be read: {error}") from error
    if not isinstance(content, dict):
        raise ConfigError(path.name, f"top level is a {type(content).__name__}, not an object")
    return content


def check_keys(
    entry: Any,
    where: str,
    required: Iterable[str],
    optional: Iterable[str] = (),
    error: type[ConfigError] = ConfigError,
) -> Mapping[str, Any]:
    """Return `entry` if it is a mapping that has every required key and none that is unknown.

    Args:
        where: File and path of the entry, for the error text.

    Raises:
        ConfigError: Naming the offending keys and the closest allowed ones.
    """
    if not isinstance(entry, Mapping):
        raise error(where, f"is {entry!r}, not a mapping")
    required, optional = list(required), list(optional)
    allowed = required + optional
    for key in entry:
        if key not in allowed:
            raise error(where, f"unknown key {key!r}{did_you_mean(key, allowed)} (allowed: {', '.join(allowed)})")
    missing = [key for key in required if key not in entry]
    if missing:
        raise error(where, f"missing {', '.join(map(repr, missing))}")
    return entry


def read_settings(cls: type[T], path: Path, notes: Sequence[str] = ("_meta",)) -> T:
    """All of a settings file, as a dataclass.

    Raises:
        ConfigError: As `read_json` and `section`.
    """
    return section(cls, read_json(path), path.name, notes)


def section(cls: type[T], entry: Any, where: str, notes: Sequence[str] = ()) -> T:
    """A dataclass from an entry with a key for each of its fields.

    Args:
        cls: The dataclass; a field that is one itself is a section of the entry, one that is a tuple is a list there.
        where: File and path of the entry, for the error text.
        notes: Key that the entry may have for its readers only, then that of its sections.

    Raises:
        ConfigError: As `check_keys`, or there is something else where a number or a list belongs.
    """
    kinds = get_type_hints(cls)
    check_keys(entry, where, kinds, notes[:1])
    return cls(**{name: _value(kind, entry[name], f"{where}: {name}", notes[1:]) for name, kind in kinds.items()})


def _value(kind: Any, value: Any, where: str, notes: Sequence[str]) -> Any:
    if is_dataclass(kind):
        return section(kind, value, where, notes)
    if get_origin(kind) is tuple:
        if not isinstance(value, list):
            raise ConfigError(where, f"is {value!r}, not a list")
        return tuple(value)
    return number(value, where) if kind in (int, float) else value


def number(value: Any, where: str) -> float:
    """A number, and no truth value.

    Raises:
        ConfigError: It is none.
    """
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise ConfigError(where, f"is {value!r}, not a number")
    return value


def vector(value: Any, where: str, size: int = 3, error: type[ConfigError] = ConfigError) -> np.ndarray:
    """A read-only `(size,)` array from a list of finite numbers."""
    return array(value, where, (size,), error)


def array(value: Any, where: str, shape: tuple, error: type[ConfigError] = ConfigError) -> np.ndarray:
    """A read-only float array of a shape (-1 matches any length) from nested lists of finite numbers."""
    try:
        result = np.array(value, dtype=float)
    except (TypeError, ValueError) as cause:
        raise error(where, f"is {value!r}, not numbers") from cause
    fits = result.ndim == len(shape) and all(want in (-1, have) for want, have in zip(shape, result.shape))
    if not fits or not np.isfinite(result).all():
        wanted = " x ".join("any" if n == -1 else str(n) for n in shape)
        raise error(where, f"is {value!r}, not {wanted} finite numbers")
    result.flags.writeable = False
    return result
