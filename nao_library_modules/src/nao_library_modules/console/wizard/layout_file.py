"""The wizard's file on the disk: read, watched for changes, saved if it has not changed there, checked with a robot."""

from __future__ import annotations

import threading
from collections.abc import Callable, Collection, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from naoqi.errors import NaoError

from ...behaviors.behavior_errors import Problem
from ...behaviors.server_functions import FunctionTables
from ...core.errors import of_those
from ...core.files import write_whole
from ...core.waiting import Listeners
from ...studies.command_check import CommandCheck, value_problems
from ...studies.commands import BEHAVIORS, RUN, ConsoleFileError, RobotCommand, command_problems, revision_of, type_of
from .layout import EditConflict, WizardButton, WizardLayout, read_layout


class SavedText(NamedTuple):
    """The text of a file, and what tells it from another one."""

    text: str
    revision: str


class LayoutFile:
    """One file, and the example that stands for it while it is not there.

    Args:
        path: The file; only this one is ever written.
        example: Read while there is no such file.
    """

    def __init__(self, path: Path, example: Path) -> None:
        self.path = path
        self._example = example

    @property
    def mark(self) -> tuple[int, int]:
        """Changes when the file does: time of the last change, ns, and length; zeros if it is not there."""
        try:
            found = self.path.stat()
        except OSError:
            return (0, 0)
        return (found.st_mtime_ns, found.st_size)

    def text(self) -> SavedText:
        """What is in the file now. Raises ConsoleFileError if it cannot be read."""
        path = self.path if self.path.exists() else self._example
        try:
            text = path.read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise ConsoleFileError(str(path), [Problem("", f"cannot be read: {error}")]) from error
        return SavedText(text, revision_of(text))

    def layout(self) -> WizardLayout:
        """What the page is made of. Raises ConsoleFileError with all that is wrong."""
        return read_layout(self.text().text, self.path.name)

    def save(self, text: str, revision: str | None) -> SavedText:
        """Write a text that can be read as a layout.

        Args:
            text: YAML.
            revision: Of the text that it was made from; None: whatever is there is replaced.

        Raises:
            ConsoleFileError: It is no layout; the file stays as it is.
            EditConflict: The file is not the one that it was made from.
            FileTrouble: It cannot be written.
        """
        read_layout(text, self.path.name)
        if revision is not None and self.text().revision != revision:
            raise EditConflict(self.path)
        write_whole(self.path, text)
        return SavedText(text, revision_of(text))


class CurrentLayout:
    """The layout that pages show: the newest of the file that could be read. Any thread.

    Attributes:
        layout: Empty before a file could be read.
        problems: What is wrong with the file as it is now; `layout` is then that of before.
    """

    def __init__(self, file: LayoutFile) -> None:
        """Read the file."""
        self.layout = WizardLayout()
        self.problems: Sequence[Problem] = ()
        self._file = file
        self._looking = threading.Lock()
        self._mark: tuple[int, int] | None = None
        self._listeners = Listeners()
        self.look()

    def look(self) -> None:
        """Read the file again if it has changed, and tell pages of that. Not for the event loop."""
        with self._looking:
            mark = self._file.mark
            if mark == self._mark:
                return
            self._mark = mark
            try:
                self.layout, self.problems = self._file.layout(), ()
            except ConsoleFileError as error:
                self.problems = error.problems
        for listener in self._listeners:
            listener()

    def subscribe(self, callback: Callable[[], None]) -> Callable[[], None]:
        """Have changes told, in the thread that learns of them; what comes back ends that."""
        return self._listeners.add(callback)


def doubts(layout: WizardLayout, robot: Any, behaviors: Collection[str] | None) -> list[Problem]:
    """What the servers of a robot would refuse, in the order of the file; buttons for other robots are left out.

    Takes a call of a service for each server that is used; not for the event loop.

    Args:
        layout: The file.
        robot: A `RobotClient`.
        behaviors: Names of the stored behaviours; None: not known.
    """
    found = []
    tables = FunctionTables()
    for group, button in layout.buttons():
        if button.robot and button.robot.strip("/") != robot.namespace.strip("/"):
            continue
        where = f"{group.title}: {button.label}"
        found += [Problem(where, text, button.line) for text in _problems(button, robot, behaviors, tables)]
    return found


def layout_problems(layout: WizardLayout, check: CommandCheck) -> list[Problem]:
    """What robots would refuse of all buttons, in the order of the file; plans are not looked at."""
    return [
        Problem(f"{group.title}: {button.label}", text, button.line)
        for group, button in layout.buttons()
        if isinstance(button.action, RobotCommand)
        for text in check.problems(button.action)
    ]


def stored_behaviors(robot: Any) -> list[str] | None:
    """Names of the behaviours that a robot has stored; None if nobody tells."""
    from nao_library_msgs.srv import ListBehaviors

    try:
        return [each.name for each in robot.call(f"{BEHAVIORS}/list", ListBehaviors).behaviors]
    except NaoError:
        return None


def _problems(button: WizardButton, robot: Any, behaviors: Collection[str] | None, tables: FunctionTables) -> list[str]:
    command = button.action
    if not isinstance(command, RobotCommand) or command.stops:
        return []
    problems = command_problems(command, robot.describe)
    if not problems and command.server == BEHAVIORS and behaviors is not None:
        name, fields = command.chain[0]
        wanted = str(fields.get("str_param", ""))
        if name == RUN and wanted and wanted not in behaviors and not button.names:
            problems.append(f"there is no behavior {wanted!r}{of_those(wanted, behaviors)}")
    if not problems and command.server != BEHAVIORS:
        problems += value_problems(command, type_of(command.server, robot.describe), tables)
    return problems
