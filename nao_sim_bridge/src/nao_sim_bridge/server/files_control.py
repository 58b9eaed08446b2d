"""Files of the robot for who runs the simulator: what there is, and pieces of files in both directions. Any thread."""

from __future__ import annotations

import hashlib
import os
import threading

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.record_dir import ClientFiles
from nao_sim_bridge.base.whole_file import DRAFT, FileTrouble
from nao_sim_bridge.naoqi.binding.arguments import whole_number

PIECE = 1 << 20
"""Bytes that are read at once."""
LONGEST_FILE = 1 << 32
"""Bytes."""


class FilesControl:
    """Lists, reads and writes files of a robot."""

    def __init__(self, files: ClientFiles) -> None:
        self._files = files
        self._lock = threading.Lock()  # one piece is written at a time

    def listed(self, folder: str) -> dict[str, int]:
        r"""As `ClientFiles.listed`; bytes of names that are no UTF-8, which libqi does not carry, as `\xe9`."""
        sizes = self._files.listed(folder)
        return {os.fsencode(name).decode("utf-8", "backslashreplace"): size for name, size in sizes.items()}

    def read(self, name: str, offset: int) -> bytes:
        """At most `PIECE` bytes of a file, from a byte on; nothing behind its end.

        Raises:
            ValueError: There is no such file; see `ClientFiles.to_read`.
        """
        path = self._files.to_read(name)
        whole_number(offset, "offset", 0, LONGEST_FILE)
        with path.open("rb") as file:
            file.seek(offset)
            return file.read(PIECE)

    def write(self, name: str, offset: int, piece: bytes, last: bool) -> str:
        """Write the next piece of a file, the first at 0; the robot's path of the file.

        Others see the file, and what it replaces is gone, when the last piece is there. One that is never ended is
        removed when the simulator starts again.

        Raises:
            ValueError: There can be no such file; see `ClientFiles.to_keep`.
            BadValue: The piece does not follow those before.
            FileTrouble: It cannot be written.
        """
        path = self._files.to_keep(name)
        draft = path.with_name(f".{hashlib.sha256(os.fsencode(path.name)).hexdigest()[:32]}{DRAFT}")
        with self._lock:
            try:
                there = draft.stat().st_size if offset and draft.exists() else 0
                if offset != there:
                    raise BadValue("offset", offset, f"{there}, the bytes of {name!r} that are there, or 0")
                with draft.open("ab" if offset else "wb") as file:
                    file.write(piece)
                if last:
                    os.replace(draft, path)
            except OSError as error:
                raise FileTrouble(path, error) from error
        return self._files.to_robot(path)
