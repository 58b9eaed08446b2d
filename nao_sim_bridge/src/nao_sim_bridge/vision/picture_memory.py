"""Pictures that a robot has learnt, with their names, and the file in which they survive."""

from __future__ import annotations

import io
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Tuple

import numpy as np

from nao_sim_bridge.base.archives import Archive
from nao_sim_bridge.base.errors import SimulationError
from nao_sim_bridge.base.whole_file import write_whole
from nao_sim_bridge.vision.face_memory import read_array
from nao_sim_bridge.vision.picture_features import LearntPicture

MOST = 200
"""Pictures in a database: each costs time with every picture of the camera."""
PARTS = (("points", 2, np.float32), ("descriptions", 128, np.uint8), ("outline", 2, np.float32))


class PictureFileError(SimulationError):
    """A file of learnt pictures that cannot be read."""


@dataclass(frozen=True, eq=False)
class KnownPicture:
    """A learnt picture: its labels, the name first, and the file that it came from."""

    labels: Tuple[str, ...]
    file: str
    features: LearntPicture


def save(pictures: Tuple[KnownPicture, ...], path: Path) -> None:
    """Write pictures to a file, all or nothing.

    Raises:
        FileTrouble: It cannot be written; what was there before still is.
    """
    content = io.BytesIO()
    about = np.array([json.dumps([one.labels, one.file]) for one in pictures], dtype=np.str_)
    arrays = {f"{part}_{i}": getattr(one.features, part) for i, one in enumerate(pictures) for part, *_ in PARTS}
    np.savez(content, about=about, **arrays)
    write_whole(path, content.getvalue())


def load(path: Path) -> Tuple[KnownPicture, ...]:
    """What a file has.

    Raises:
        PictureFileError: It cannot be read, or is no such file.
    """
    try:
        with Archive(path) as content:
            about = [json.loads(str(text)) for text in read_array(content.read("about.npy"))]
            return tuple(_read(content, i, *one) for i, one in enumerate(about))
    except (OSError, ValueError, TypeError, RecursionError) as error:
        raise PictureFileError(f"{str(path)!r} is no file of learnt pictures: {error}") from error


def _read(content: Archive, number: int, labels: list, file: str) -> KnownPicture:
    arrays = {}
    for part, columns, kind in PARTS:
        array = read_array(content.read(f"{part}_{number}.npy"))
        if array.ndim != 2 or array.shape[1] != columns or array.dtype != kind or not len(array):
            raise ValueError(f"{part} of picture {number} are {array.shape} {array.dtype}")
        if not np.isfinite(array).all():
            raise ValueError(f"{part} of picture {number} are not finite")
        arrays[part] = array
    if len(arrays["points"]) != len(arrays["descriptions"]):
        raise ValueError(f"points and descriptions of picture {number} do not fit together")
    return KnownPicture(tuple(map(str, labels)), str(file), LearntPicture(**arrays))
