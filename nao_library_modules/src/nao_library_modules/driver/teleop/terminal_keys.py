"""Keys of a terminal, one by one and without Enter. Its settings are restored in any case."""

from __future__ import annotations

import atexit
import os
import select
import termios
import tty
from contextlib import suppress

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
    """A terminal whose keys arrive at once (cbreak mode). A context manager; inside, `read` gives keys."""

    def __init__(self, file: int) -> None:
        """Take a terminal by its file descriptor; raises NaoError if it is none."""
        if not os.isatty(file):
            raise NaoError("keys need a terminal: start this in one with rosrun, not by a launch file or a pipe")
        self._file = file
        self._before = termios.tcgetattr(file)

    def __enter__(self) -> TerminalKeys:
        atexit.register(self.restore)  # for an end that does not pass through here
        tty.setcbreak(self._file)
        return self

    def __exit__(self, *_: object) -> None:
        self.restore()
        atexit.unregister(self.restore)

    def restore(self) -> None:
        """Restore the settings of the terminal; keys not read yet are discarded."""
        with suppress(termios.error, OSError):  # where the terminal is gone, its settings are with it
            termios.tcsetattr(self._file, termios.TCSAFLUSH, self._before)

    def read(self, limit: float) -> list[str]:
        """Keys since the last call, after waiting for one at most `limit` s.

        "ctrl-d" when the terminal is gone.
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
    """Names of the keys in the text of a terminal; sequences of arrow keys come in one piece."""
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
