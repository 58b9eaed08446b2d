"""What can be played of a video that was not written to its end. Players refuse a file that ends within a frame.

An MP4 file, as it is written here, is a row of parts, each complete in itself; an AVI file is a row of frames.
"""

from __future__ import annotations

import os
import struct
from pathlib import Path
from typing import BinaryIO

HEADER = struct.Struct(">I4s")
CHUNK = struct.Struct("<4sI")
AVI_FRAMES = (b"00dc", b"00db")
LONGEST_AVI_HEADER = 65536
COUNT_AT = 8
"""Of a `trun` box: where the number of its frames stands, from its name on."""


def keep_what_is_whole(path: Path, file_type: str) -> int:
    """Cut off what is behind the last complete part or frame.

    Args:
        path: The file; nobody may write it any more.
        file_type: mp4 or avi.

    Returns:
        How many frames it has now.

    Raises:
        OSError: It cannot be read or cut.
    """
    with path.open("rb") as file:
        frames, end = {"mp4": _mp4, "avi": _avi}[file_type](file, os.path.getsize(path))
    os.truncate(path, end)
    return frames


def _mp4(file: BinaryIO, length: int) -> tuple[int, int]:
    """Number of frames in complete parts, and where the last of these ends."""
    frames = end = described = 0
    for kind, start, size in _boxes(file, length):
        if kind == b"moof":
            file.seek(start)
            described = _frames_of(file.read(size))
        elif kind == b"mdat":
            frames, end = frames + described, start + size
    return frames, end


def _avi(file: BinaryIO, length: int) -> tuple[int, int]:
    """Number of complete frames, and where the last of these ends."""
    frames = end = 0
    start = file.read(LONGEST_AVI_HEADER).find(b"movi") + len(b"movi")
    while len(b"movi") <= start <= length - CHUNK.size:
        file.seek(start)
        kind, size = CHUNK.unpack(file.read(CHUNK.size))
        start += CHUNK.size + size + size % 2
        if start > length:
            break
        if kind in AVI_FRAMES and size:  # an empty one only says that the frame before it is still shown
            frames, end = frames + 1, start
    return frames, end


def _boxes(file: BinaryIO, length: int) -> list[tuple[bytes, int, int]]:
    """Kind, place and size of the complete boxes at the top of a file."""
    found, start = [], 0
    while start + HEADER.size <= length:
        file.seek(start)
        size, kind = HEADER.unpack(file.read(HEADER.size))
        if size < HEADER.size or start + size > length:
            break
        found.append((kind, start, size))
        start += size
    return found


def _frames_of(description: bytes) -> int:
    at = description.find(b"trun")
    return struct.unpack_from(">I", description, at + COUNT_AT)[0] if at >= 0 else 0
