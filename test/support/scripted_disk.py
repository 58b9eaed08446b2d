"""A disk that is full when a test says so: writes and syncs below a folder fail as those of a full disk do."""

from __future__ import annotations

import errno
import os
from pathlib import Path


class ScriptedDisk:
    """Takes the place of `os.write`, `os.pwrite`, `os.fsync` for files below a folder.

    Attributes:
        room: Bytes that can be written until it is full; None: any number.
        syncs: Whether a sync succeeds.
        failed: How many calls have failed.
    """

    def __init__(self, folder: Path, monkeypatch) -> None:
        self._folder = f"{folder}/"
        self.room: int | None = None
        self.syncs = True
        self.failed = 0
        self._write, self._pwrite = os.write, os.pwrite
        monkeypatch.setattr(os, "write", lambda file, data: self._written(file, data, self._write))
        monkeypatch.setattr(
            os, "pwrite", lambda file, data, at: self._written(file, data, lambda f, d: self._pwrite(f, d, at))
        )
        monkeypatch.setattr(os, "fsync", self._sync)

    def _is_here(self, file: int) -> bool:
        return os.readlink(f"/proc/self/fd/{file}").startswith(self._folder)

    def _written(self, file: int, data: bytes, write) -> int:
        if self.room is None or not self._is_here(file):
            return write(file, data)
        if not self.room:
            self.failed += 1
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        data = bytes(data)[: self.room]
        self.room -= len(data)
        return write(file, data)

    def _sync(self, file: int) -> None:
        if not self.syncs and self._is_here(file):
            self.failed += 1
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
