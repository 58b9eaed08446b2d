"""Files that commands leave where the user is: never over another one, unless that is asked for."""

from __future__ import annotations

import os
import time
from collections.abc import Sequence
from pathlib import Path

import click

from .errors import CommandFailed

overwrite_option = click.option("--overwrite", is_flag=True, help="Replace a file of that name.")


def wanted_file(file: str, overwrite: bool, kinds: Sequence[str] = ()) -> Path | None:
    """Where a file is to go, absolute, or the folder for it; None if that was left to the server.

    Asked for before anything is done: a recording that finds no place is lost. Raises click.UsageError if it ends in
    something else; CommandFailed if there is one already, or no folder for it. `overwrite`: whether it may be there
    already. `kinds`: what its name may end in, without the dot; empty where the server decides.
    """
    from ..base.whole_file import NoPlaceForFile, require_new

    if not file:
        return None
    if Path(file).expanduser().is_dir():
        return Path(file).expanduser().absolute()
    if file.endswith(os.sep):
        raise CommandFailed(f"there is no folder {file}")
    if kinds and Path(file).suffix.lower().lstrip(".") not in kinds:
        raise click.UsageError(f"{file}: the name of the file ends in {' or '.join(f'.{kind}' for kind in kinds)}")
    try:
        return require_new(file, overwrite)
    except NoPlaceForFile as error:
        raise CommandFailed(str(error)) from None


def names_file(target: Path | None) -> bool:
    """Whether what `wanted_file` answers is a file, not a folder in which it has the name that the server gives it."""
    return target is not None and not target.is_dir()


def passing_name() -> str:
    """Name, without its end, that a file has at a server until it is brought: no other one has it, nor had it."""
    return f"nao-{os.getpid()}-{time.time_ns() // 1000}"


def bring(path: str, target: Path | None, overwrite: bool = False) -> str:
    """Move a file that a server has written to where it is wanted; where that is, as a text.

    `target`: as `wanted_file` answers it. `overwrite`: whether it replaces a file that is there by now; else it gets a
    number. Raises CommandFailed if it is on another computer, or cannot be moved.
    """
    from ..base.whole_file import FileTrouble, move_whole

    if target is None:
        return path
    if not os.path.exists(path):
        raise CommandFailed(f"the file is on the computer of the server: {path}")
    if target.is_dir():
        target = target / Path(path).name
    try:
        return str(move_whole(Path(path), target, overwrite))
    except FileTrouble as error:
        raise CommandFailed(f"{error}; the file is {path}") from None
