"""Where the data files of this package are: in it, beside the code that reads them."""

from __future__ import annotations

from pathlib import Path

_PACKAGE = Path(__file__).resolve().parents[1]


def config_file(name: str) -> Path:
    """Path of a file in `config`."""
    return _PACKAGE / "config" / name


def world_directory() -> Path:
    return _PACKAGE / "worlds"


def sounds_directory() -> Path:
    """Directory of the sounds that come with the package, a folder a sound set."""
    return _PACKAGE / "sounds"
