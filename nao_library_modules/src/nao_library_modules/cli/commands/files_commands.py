"""`nao files`: list, get and put the robot's files, of a simulated robot and of a real one."""

from __future__ import annotations

import posixpath
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import click

from ...base.whole_file import NoPlaceForFile, draft_in, move_whole, require_new
from ...nao.robot_files import HOME, full_path
from ..address import address_of, url_option
from ..errors import CommandFailed
from ..files import overwrite_option, wanted_file
from ..output import say_json, say_lines, table
from ..robot_files import RobotFiles, files_of
from ..robot_link import DirectRobot
from ..settings import CliSettings, NaoGroup, settings_of


@click.group(cls=NaoGroup, name="files")
def files_command() -> None:
    """The robot's files: list them, get one, put one.

    Paths are the robot's: ~ and relative ones are in /home/nao. A real robot is reached by ssh and scp as its user nao,
    who may be asked for a password. A simulated one has /home/nao, /tmp and /usr/share/naoqi.
    """


@contextmanager
def _files(settings: CliSettings, url: str | None) -> Iterator[RobotFiles]:
    address = address_of(settings, url)
    with DirectRobot(address) as robot:
        yield files_of(robot, address[0], settings.timeout, settings.json)


@files_command.command("list")
@click.argument("folder", default="~")
@url_option
@click.pass_context
def list_files(context: click.Context, folder: str, url: str | None) -> None:
    """What is in FOLDER of the robot, with bytes; without, in /home/nao."""
    settings = settings_of(context)
    with _files(settings, url) as files:
        found = files.listed(full_path(folder))
    if settings.json:
        entries = [{"name": entry.name, "size": entry.size, "folder": entry.folder} for entry in found]
        say_json({"folder": full_path(folder), "files": entries})
    else:
        say_lines(table([(entry.name + "/", "") if entry.folder else (entry.name, str(entry.size)) for entry in found]))


@files_command.command("get")
@click.argument("remote")
@click.argument("local", default="", type=click.Path())
@overwrite_option
@url_option
@click.pass_context
def get_file(context: click.Context, remote: str, local: str, overwrite: bool, url: str | None) -> None:
    """Bring the robot's file REMOTE to LOCAL, a file or a folder; without, to here."""
    settings = settings_of(context)
    wanted = wanted_file(local or ".", overwrite)
    path = full_path(remote)
    try:
        target = require_new(wanted / posixpath.basename(path) if wanted.is_dir() else wanted, overwrite)
        with draft_in(target.parent) as draft:
            with _files(settings, url) as files:
                files.get(path, draft)
            target = move_whole(draft, target, overwrite)
    except (NoPlaceForFile, OSError) as error:
        raise CommandFailed(str(error)) from None
    _say(settings, str(target))


@files_command.command("put")
@click.argument("local", type=click.Path(exists=True, dir_okay=False, path_type=Path))
@click.argument("remote", default=HOME + "/")
@overwrite_option
@url_option
@click.pass_context
def put_file(context: click.Context, local: Path, remote: str, overwrite: bool, url: str | None) -> None:
    """Bring the file LOCAL to REMOTE on the robot, a file or a folder; without, to /home/nao."""
    settings = settings_of(context)
    with _files(settings, url) as files:
        path, there = files.place(remote, local.name)
        if there and not overwrite:
            raise CommandFailed(f"{path} is on the robot already: another name, or --overwrite")
        try:
            files.put(local, path)
        except OSError as error:
            raise CommandFailed(f"{local} cannot be read: {error.strerror}") from None
    _say(settings, path)


def _say(settings: CliSettings, path: str) -> None:
    if settings.json:
        say_json({"path": path})
    else:
        click.echo(path)
