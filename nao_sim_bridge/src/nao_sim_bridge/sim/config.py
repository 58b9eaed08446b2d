"""Strict reading of data files: an unknown or missing key is an error that names what is allowed."""

from __future__ import annotations

import difflib
import json
from collections.abc import Iterable, Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from nao_sim_bridge.sim.errors import ConfigError

T = TypeVar("T")


def read_json(path: Path) -> dict:
    """Content of a JSON file whose top level is an object."""
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
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
        entry: What the file holds at this place.
        where: File and path of the entry, for the error text.
        required: Keys that must be there.
        optional: Keys that may be there.
        error: Class of the error raised.

    Raises:
        ConfigError: Naming the offending keys and the closest allowed ones.
    """
    if not isinstance(entry, Mapping):
        raise error(where, f"is {entry!r}, not a mapping")
    required, optional = list(required), list(optional)
    allowed = required + optional
    for key in entry:
        if key not in allowed:
            near = difflib.get_close_matches(str(key), allowed, n=1)
            hint = f", did you mean {near[0]!r}?" if near else ""
            raise error(where, f"unknown key {key!r}{hint} (allowed: {', '.join(allowed)})")
    missing = [key for key in required if key not in entry]
    if missing:
        raise error(where, f"missing {', '.join(map(repr, missing))}")
    return entry


def section(cls: type[T], entry: Any, where: str, optional: Iterable[str] = ()) -> T:
    """A dataclass from an entry with a key for each of its fields; lists become tuples.

    Args:
        cls: The dataclass.
        entry: What the file holds at this place.
        where: File and path of the entry, for the error text.
        optional: Keys that may be there and are no fields.

    Raises:
        ConfigError: As `check_keys`.
    """
    names = [field.name for field in fields(cls)]  # type: ignore[arg-type]
    check_keys(entry, where, names, optional)
    return cls(**{name: tuple(entry[name]) if isinstance(entry[name], list) else entry[name] for name in names})


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
    if not fits or not np.all(np.isfinite(result)):
        wanted = " x ".join("any" if n == -1 else str(n) for n in shape)
        raise error(where, f"is {value!r}, not {wanted} finite numbers")
    result.flags.writeable = False
    return result
