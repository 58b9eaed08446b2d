"""Reads ZIP archives that others bring: sizes are counted while reading, whatever they claim."""

from __future__ import annotations

import posixpath
import zipfile
import zlib
from pathlib import Path

from nao_sim_bridge.base.sizes import ArchiveSizes, load_sizes

PACKED = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)
ENCRYPTED = 0x1


class BadArchive(ValueError):
    """An archive that cannot be read, or has something in it that is not allowed."""


class Archive:
    """A ZIP archive. Its members are stored or deflated, as other ways of packing cannot be unpacked bit by bit.

    Args:
        sizes: What is allowed; that of `sizes.json` when None.

    Raises:
        BadArchive: It is none, has too many members, one that is packed or named in a way that is not allowed, or
            claims too much.
        OSError: It cannot be read.
    """

    def __init__(self, path: Path, sizes: ArchiveSizes | None = None) -> None:
        self._sizes = sizes or load_sizes().archive
        self._unpacked = 0
        if path.stat().st_size > self._sizes.file_bytes:
            raise BadArchive(f"has more than {self._sizes.file_bytes} bytes")
        try:
            self._archive = zipfile.ZipFile(path)
            self._members = {entry.filename: entry for entry in self._archive.infolist()}
        except (zipfile.BadZipFile, NotImplementedError, ValueError, IndexError, KeyError) as error:
            raise BadArchive(f"is no archive: {error}") from error
        try:
            self._check(self._archive.infolist())
        except BadArchive:
            self.close()
            raise

    def __enter__(self) -> Archive:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        self._archive.close()

    @property
    def names(self) -> list[str]:
        return list(self._members)

    def read(self, name: str) -> bytes:
        """A member.

        Raises:
            BadArchive: There is none of that name, it is broken, or it or all that was read so far is too large.
        """
        if name not in self._members:
            raise BadArchive(f"there is no {name!r} in it")
        largest = max(0, min(self._sizes.member_bytes, self._sizes.total_bytes - self._unpacked))
        try:
            with self._archive.open(self._members[name]) as member:
                content = member.read(largest + 1)
        except (zipfile.BadZipFile, zlib.error, EOFError, RuntimeError, NotImplementedError) as error:
            raise BadArchive(f"{name!r} is broken: {error}") from error
        self._unpacked += len(content)
        if len(content) > largest:
            raise BadArchive(f"{name!r} is too large: {self._allowed()}")
        return content

    def _check(self, entries: list[zipfile.ZipInfo]) -> None:
        if len(entries) > self._sizes.members:
            raise BadArchive(f"has {len(entries)} members, at most {self._sizes.members} are allowed")
        for entry in entries:
            if entry.compress_type not in PACKED or entry.flag_bits & ENCRYPTED:
                raise BadArchive(f"{entry.filename!r} is packed in a way that is not read: stored and deflated are")
            name = posixpath.normpath(entry.filename)
            if name.startswith(("/", "..")) or "\\" in name:
                raise BadArchive(f"{entry.filename!r} is outside of it")
        claimed = [entry.file_size for entry in entries]
        if max(claimed, default=0) > self._sizes.member_bytes or sum(claimed) > self._sizes.total_bytes:
            raise BadArchive(f"unpacks to {sum(claimed)} bytes: {self._allowed()}")

    def _allowed(self) -> str:
        return f"at most {self._sizes.member_bytes} bytes a member and {self._sizes.total_bytes} of all are allowed"
