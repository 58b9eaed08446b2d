"""Keys from a terminal, one by one and without Enter. The terminal gets its settings back whatever happens."""

from __future__ import annotations

import atexit
import os
import select
import termios
import tty
from types import TracebackType

from naoqi.errors import NaoError

SEQUENCES = {
    "A": "up",
    "B": "down",
    "C": "right",
    "D": "left",
}
"""Last character of the sequences that arrow keys send after escape and [ or O."""
CONTROL = {"\x03": "ctrl-c", "\x04": "ctrl-d"}
ESCAPE = "\x1b"
LONGEST = 1024


class TerminalKeys:
    """A terminal in which keys count at once. A context manager; inside, `read` gives keys."""

    def __init__(self, file: int) -> None:
        """Take a terminal.

        Args:
            file: Its file descriptor.

        Raises:
            NaoError: If it is no terminal.
        """
        if not os.isatty(file):
            raise NaoError("keys need a terminal: start this in one with rosrun, not by a launch file or a pipe")
        self._file = file
        self._before = termios.tcgetattr(file)

    def __enter__(self) -> TerminalKeys:
        """Have keys count at once."""
        atexit.register(self.restore)  # for an end that does not pass through here
        tty.setcbreak(self._file)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Give the terminal its settings back."""
        self.restore()
        atexit.unregister(self.restore)

    def restore(self) -> None:
        """Give the terminal its settings back; keys that nobody read are forgotten."""
        try:
            termios.tcsetattr(self._file, termios.TCSAFLUSH, self._before)
        except (termios.error, OSError):
            pass  # the terminal is gone, and its settings with it

    def read(self, limit: float) -> list[str]:
        """Wait for keys.

        Args:
            limit: s to wait at most.

        Returns:
            The keys since the last time; "ctrl-d" when the terminal is gone.
        """
        ready, _, _ = select.select([self._file], [], [], limit)
        if not ready:
            return []
        try:
            text = os.read(self._file, LONGEST)
        except OSError:
            text = b""
        return decode(text.decode(errors="replace")) if text else ["ctrl-d"]


def decode(text: str) -> list[str]:
    """Names of the keys behind what a terminal sends.

    Args:
        text: Characters; arrow keys are sequences that begin with escape, and come in one piece.
    """
    keys = []
    place = 0
    while place < len(text):
        if text[place] == ESCAPE and text[place + 1 : place + 2] in ("[", "O"):
            end = place + 2
            while end < len(text) and not text[end].isalpha() and text[end] != "~":
                end += 1
            name = SEQUENCES.get(text[end : end + 1])
            keys.append(name or "another key")
            place = end + 1
        else:
            character = text[place]
            keys.append("escape" if character == ESCAPE else CONTROL.get(character, character))
            place += 1
    return keys
