"""`nao files`: files on the robot; of a simulated one through its own service, of a real one by ssh and scp."""

from __future__ import annotations

import posixpath
import shlex
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

import click

from ...core.files import NoPlaceForFile, draft_in, move_whole, require_new
from ...core.nao_facts import HOME, full_path
from ..cli_settings import CliSettings, NaoGroup, address_of, settings_of, url_option
from ..direct_robot import DirectRobot
from ..output import CommandFailed, StackMissing, overwrite_option, say_json, say_lines, table, wanted_file

USER = "nao"
SIMULATION = "NaoSimulation"
"""Module that only a simulated robot has."""
PIECE = 1 << 20
"""Bytes that are sent at once."""
CONNECT_LIMIT = 10
"""s in which a real robot has to answer ssh."""
UNREACHABLE = 255
"""Exit status of ssh without a connection."""
LISTED = "-dl"
"""What is listed, by the first letter of `ls -l`: files, folders, links."""
WHERE = """\
p={path}; if [ -d "$p" ] || [ {folder} = yes ]; then p="${{p%/}}"/{name}; fi
if [ -d "$p" ]; then echo folder; elif [ -e "$p" ]; then echo file; else mkdir -p "${{p%/*}}" && echo free; fi &&
echo "$p"
"""
"""Tells, on the robot, where a file would go and what is there; makes the folder for it."""


@dataclass(frozen=True)
class Entry:
    """A file, or a folder, whose size is 0."""

    name: str
    size: int
    folder: bool


class RobotFiles(Protocol):
    """The files of a robot. Paths are the robot's, from its root on. All raise CommandFailed where it refuses."""

    def listed(self, folder: str) -> list[Entry]:
        """What is in a folder, by name."""

    def place(self, path: str, name: str) -> tuple[str, bool]:
        """Where a file of this name goes that is to be `path`, or in it, and whether there is one already."""

    def get(self, path: str, target: Path) -> None:
        """Bring a file to this computer, over one that is there."""

    def put(self, source: Path, path: str) -> None:
        """Bring a file to the robot, over one that is there."""


class SimulatedFiles:
    """Files of a simulated robot, on this computer or elsewhere."""

    def __init__(self, robot: DirectRobot) -> None:
        self._robot = robot

    def listed(self, folder: str) -> list[Entry]:
        found = self._robot.call(SIMULATION, "listFiles", folder)
        return [Entry(name.rstrip("/"), size, name.endswith("/")) for name, size in sorted(found.items())]

    def place(self, path: str, name: str) -> tuple[str, bool]:
        full = full_path(path)
        if path.endswith("/") or self._there(full) is not None:
            full = posixpath.join(full, name)
        beside = {entry.name: entry for entry in self._there(posixpath.dirname(full)) or ()}
        known = beside.get(posixpath.basename(full))
        if known and known.folder:
            raise _is_folder(full)
        return full, known is not None

    def get(self, path: str, target: Path) -> None:
        with target.open("wb") as file:
            while piece := bytes(self._robot.call(SIMULATION, "readFile", path, file.tell())):
                file.write(piece)

    def put(self, source: Path, path: str) -> None:
        with source.open("rb") as file:
            number = self._robot.call(SIMULATION, "beginFile", path)
            while piece := file.read(PIECE):
                self._robot.call(SIMULATION, "writeFile", number, piece, False)
            self._robot.call(SIMULATION, "writeFile", number, b"", True)

    def _there(self, folder: str) -> list[Entry] | None:
        """What is in a folder; None where there is no such folder, or none may be."""
        try:
            return self.listed(folder)
        except CommandFailed:
            return None


class FilesOverSsh:
    """Files of a real robot.

    ssh asks for the password of its user where no key is known there.

    Args:
        host: Name or IP of the robot.
        limit: s that each of its programs may take, with the time in which the password is typed; None for ever.
        quiet: Whether scp tells nothing of how far it is.
    """

    def __init__(self, host: str, limit: float | None = None, quiet: bool = False) -> None:
        self._login = f"{USER}@{host}"
        self._copied = f"{USER}@[{host}]" if ":" in host else self._login
        self._limit = limit
        self._quiet = quiet

    def listed(self, folder: str) -> list[Entry]:
        lines = self._ask(f"cd {shlex.quote(full_path(folder))} && LC_ALL=C ls -lnA").splitlines()
        return sorted((_entry(line) for line in lines if line[:1] in LISTED), key=lambda entry: entry.name)

    def place(self, path: str, name: str) -> tuple[str, bool]:
        wanted = {"path": full_path(path), "name": name, "folder": "yes" if path.endswith("/") else "no"}
        answer = self._ask(WHERE.format(**{key: shlex.quote(text) for key, text in wanted.items()}))
        there, _, full = answer.rstrip("\n").partition("\n")
        if there == "folder":
            raise _is_folder(full)
        return full, there == "file"

    def get(self, path: str, target: Path) -> None:
        self._copy(f"{self._copied}:{_plain(path)}", str(target.absolute()))

    def put(self, source: Path, path: str) -> None:
        self._copy(str(source.absolute()), f"{self._copied}:{_plain(path)}")

    def _ask(self, command: str) -> str:
        """What a command for the robot's shell prints."""
        return self._run(["ssh", "-x", *self._options(), self._login, command], subprocess.PIPE)

    def _copy(self, source: str, target: str) -> None:
        self._run(["scp", *self._options(), "--", source, target], subprocess.DEVNULL if self._quiet else None)

    def _options(self) -> list[str]:
        return ["-o", f"ConnectTimeout={CONNECT_LIMIT}"]

    def _run(self, command: list[str], output: int | None) -> str:
        try:
            done = subprocess.run(  # no shell on this computer
                command,
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.PIPE,
                encoding="utf-8",
                errors="backslashreplace",  # names on the robot are any bytes
                timeout=self._limit,
            )
        except FileNotFoundError:
            raise CommandFailed(
                f"there is no {command[0]} on this computer, which files of a real robot come and go by: install it"
                " (openssh-client)"
            ) from None
        except subprocess.TimeoutExpired:
            raise CommandFailed(f"{command[0]} to {self._login} has not ended within {self._limit:g} s") from None
        if done.returncode:
            told = " ".join(done.stderr.split()) or f"{command[0]} ended with status {done.returncode}"
            failure = StackMissing if done.returncode == UNREACHABLE else CommandFailed
            raise failure(f"{self._login}: {told}")
        return done.stdout or ""


def files_of(robot: DirectRobot, host: str, limit: float | None, quiet: bool) -> RobotFiles:
    """The files of a robot, which is simulated or real; see `FilesOverSsh`."""
    return SimulatedFiles(robot) if robot.has(SIMULATION) else FilesOverSsh(host, limit, quiet)


def _entry(line: str) -> Entry:
    """A file or folder from a line of `ls -ln`: rights, links, user, group, size, three of the date, name."""
    rights, _, _, _, size, _, _, _, name = line.split(None, 8)
    folder = rights.startswith("d")
    return Entry(name.split(" -> ")[0], 0 if folder else int(size), folder)


def _plain(path: str) -> str:
    """A path that means the same to every scp: older ones hand it to a shell on the robot, newer ones do not."""
    full = full_path(path)
    if shlex.quote(full) != full:
        raise CommandFailed(f"{full!r} is no path for scp: give one of letters, digits and _ @ % + = : , . / - alone")
    return full


def _is_folder(path: str) -> CommandFailed:
    return CommandFailed(f"{path} is a folder on the robot")


# --- nao files --------------------------------------------------------------------------------------------------------


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
