"""Files that commands write for the user; none replaces another without --overwrite."""

from __future__ import annotations

import os
import time
from collections.abc import Sequence
from pathlib import Path

import click

from ..base.whole_file import FileTrouble, NoPlaceForFile, move_whole, require_new
from .errors import CommandFailed

overwrite_option = click.option("--overwrite", is_flag=True, help="Replace a file of that name.")


def wanted_file(file: str, overwrite: bool, kinds: Sequence[str] = ()) -> Path | None:
    """Absolute path of the target file or folder; None if the server decides.

    Checked before anything runs: a recording without a place would be lost.

    Args:
        overwrite: The file may exist.
        kinds: Allowed endings, without the dot; empty where the server decides.

    Raises:
        click.UsageError: The name has another ending.
        CommandFailed: The file exists, or its folder does not.
    """
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
    """Whether the answer of `wanted_file` is a file, not a folder in which the server chooses the name."""
    return target is not None and not target.is_dir()


def passing_name() -> str:
    """A unique file name, without its ending, for a file at a server until it is moved."""
    return f"nao-{os.getpid()}-{time.time_ns() // 1000}"


def bring(path: str, target: Path | None, overwrite: bool = False) -> str:
    """Move a file that a server has written to its target; return the path as text.

    Args:
        target: As `wanted_file` answers it.
        overwrite: Replace a file that exists by now; else the new one gets a number.

    Raises:
        CommandFailed: The file is on another computer, or cannot be moved.
    """
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
