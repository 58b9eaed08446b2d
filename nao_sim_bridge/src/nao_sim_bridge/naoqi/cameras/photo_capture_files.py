"""Files of pictures: their names, and the formats that NAOqi has for them."""

from __future__ import annotations

import posixpath
from pathlib import Path

import cv2
import numpy as np

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.record_dir import ClientFiles
from nao_sim_bridge.naoqi.binding.errors import NaoqiError

JPEG_QUALITY = 95
GREY_ONLY = ("pbm", "pgm")
"""Formats that hold no colour: a colour picture becomes grey, in "pbm" black and white."""
FORMATS = ("bmp", "dib", "jpeg", "jpg", "jpe", "png", "pbm", "pgm", "ppm", "sr", "ras", "tiff", "tif")


def picture_files(files: ClientFiles, folder: str, name: str, kind: str, count: int, overwrite: bool) -> list[Path]:
    """Paths of the pictures of a series; folders on the way are made.

    One picture has the name as it was given, several are name_0, name_1, ...; the ending of the format is added when
    the name does not have it.

    Raises:
        BadValue: The name is that of a folder.
        NaoqiError: There is such a file, and it must not be overwritten.
        ValueError: A file leads out of the folder for recordings, or cannot be made there.
    """
    ending = f".{kind}"
    stem = name[: -len(ending)] if name.lower().endswith(ending) else name
    if not posixpath.basename(stem):
        raise BadValue("fileName", name, "the name of a file")
    names = [stem] if count == 1 else [f"{stem}_{number}" for number in range(count)]
    paths = [files.to_write(posixpath.join(folder, one + ending)) for one in names]
    there = next((path for path in paths if path.exists()), None)
    if there is not None and not overwrite:
        raise NaoqiError(f"file {str(there)!r} exists already, and is not to be overwritten")
    return paths


def encoded(picture: np.ndarray, kind: str) -> bytes:
    """A picture in a file format.

    Args:
        picture: (height, width) grey or (height, width, 3) BGR, uint8.
        kind: One of `FORMATS`.
    """
    if picture.ndim == 3 and picture.shape[2] == 1:
        picture = picture[:, :, 0]
    if kind in GREY_ONLY and picture.ndim == 3:
        picture = cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY)
    elif kind == "ppm" and picture.ndim == 2:
        picture = cv2.cvtColor(picture, cv2.COLOR_GRAY2BGR)
    written, content = cv2.imencode(f".{kind}", picture, [cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY])
    if not written:
        raise NaoqiError(f"a picture of {picture.shape[1]}x{picture.shape[0]} cannot be written as {kind!r}")
    return content.tobytes()
