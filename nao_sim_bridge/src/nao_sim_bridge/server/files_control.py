"""Files of the robot for who runs the simulator: what there is, and pieces of files in both directions. Any thread."""

from __future__ import annotations

import itertools
import os
import threading
from typing import Callable

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.record_dir import ClientFiles
from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.base.whole_file import FileTrouble, WholeFile
from nao_sim_bridge.naoqi.binding.arguments import whole_number

PIECE = 1 << 20
"""Bytes that are read at once."""
LONGEST_FILE = 1 << 32
"""Bytes."""


class FilesControl:
    """Lists, reads and writes files of a robot. What is being written outlasts a factory reset.

    Args:
        files: Those of the robot as it is now.
    """

    def __init__(self, files: Callable[[], ClientFiles]) -> None:
        self._files = files
        self._lock = threading.Lock()  # one piece is written at a time
        self._numbers = itertools.count(1)
        self._uploads: dict[int, WholeFile] = {}

    def listed(self, folder: str) -> dict[str, int]:
        r"""As `ClientFiles.listed`; bytes of names that are no UTF-8, which libqi does not carry, as `\xe9`."""
        sizes = self._files().listed(folder)
        return {os.fsencode(name).decode("utf-8", "backslashreplace"): size for name, size in sizes.items()}

    def read(self, name: str, offset: int) -> bytes:
        """At most `PIECE` bytes of a file, from a byte on; nothing behind its end.

        Raises:
            ValueError: There is no such file; see `ClientFiles.to_read`.
        """
        path = self._files().to_read(name)
        whole_number(offset, "offset", 0, LONGEST_FILE)
        with path.open("rb") as file:
            file.seek(offset)
            return file.read(PIECE)

    def begin(self, name: str) -> int:
        """Begin to write a file; the number that `write` takes its pieces by.

        Others see the file, and what it replaces is gone, when the last piece is there. One that is never ended is
        removed when the simulator ends, or when there are too many of them.

        Raises:
            ValueError: There can be no such file; see `ClientFiles.to_keep`.
            FileTrouble: It cannot be written.
        """
        file = WholeFile(self._files().ready(name), hidden=True)
        with self._lock:
            number = next(self._numbers)
            self._uploads[number] = file
            if len(self._uploads) > load_sizes().clients.uploads:
                self._uploads.pop(next(iter(self._uploads))).discard()
        return number

    def write(self, number: int, piece: bytes, last: bool) -> str:
        """Write the next piece of a file; the robot's path of it.

        Raises:
            BadValue: No file of this number is being written.
            FileTrouble: It cannot be written, and is given up.
        """
        with self._lock:
            file = self._uploads.pop(number, None)
            if file is None:
                raise BadValue("number", number, "that of a file that is begun and not ended or given up")
            files = self._files()
            name = files.to_robot(file.path)
            try:
                file.write(piece)
                file.flush()
                if last:
                    file.close()
                    files.to_keep(name)
                else:
                    self._uploads[number] = file  # behind those of which nothing came for longer
            except FileTrouble:
                file.discard()
                raise
        return name

    def close(self) -> None:
        """Give up what is being written."""
        with self._lock:
            while self._uploads:
                self._uploads.popitem()[1].discard()
