"""Known people: descriptions of their faces by name, and the file in which they survive."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Sequence

import numpy as np

from nao_sim_bridge.base.archives import Archive
from nao_sim_bridge.base.errors import SimulationError
from nao_sim_bridge.base.whole_file import write_whole
from nao_sim_bridge.vision.faces_features import likeness

MOST_PICTURES = 10
"""Pictures of one person at most."""
# How alike two faces are that have nothing to do with each other, and two pictures of the same face: score 0 and 1.
STRANGERS, SAME = 0.80, 0.95
KEY = "person_{}"
POLICIES = ("overwrite", "merge", "keep")


class FaceFileError(SimulationError):
    """A file of known faces that cannot be read."""


class FaceMemory:
    """The people that are known. Not for several threads at once."""

    def __init__(self) -> None:
        self._pictures: dict[str, np.ndarray] = {}

    @property
    def names(self) -> list[str]:
        """Who is known, first learnt first."""
        return list(self._pictures)

    def pictures_of(self, name: str) -> int:
        return len(self._pictures.get(name, ()))

    def learn(self, name: str, description: np.ndarray) -> bool:
        """Add a picture of somebody; False when there are as many as there can be."""
        if self.pictures_of(name) >= MOST_PICTURES:
            return False
        before = self._pictures.get(name, np.empty((0, len(description)), np.float32))
        self._pictures[name] = np.vstack((before, description[None].astype(np.float32)))
        return True

    def forget(self, name: str) -> bool:
        """Forget somebody; False when nobody of the name is known."""
        return self._pictures.pop(name, None) is not None

    def clear(self) -> None:
        self._pictures.clear()

    def recognise(self, description: np.ndarray) -> tuple[str, float]:
        """Who it is most likely, and how sure that is, 0..1; ("", 0) when nobody is known."""
        best, score = "", 0.0
        for name, pictures in self._pictures.items():
            alike = float(likeness(description, pictures).max())
            found = min(1.0, max(0.0, (alike - STRANGERS) / (SAME - STRANGERS)))
            if found > score:
                best, score = name, found
        return best, score

    def take_over(self, other: FaceMemory, policy: str) -> None:
        """Take people of another memory in; one of `POLICIES` says what happens to somebody who is known already.

        "overwrite" takes the pictures of the other memory instead, "merge" has both, "keep" changes nothing.
        """
        for name, pictures in other._pictures.items():
            if name not in self._pictures or policy == "overwrite":
                self._pictures[name] = pictures
            elif policy == "merge":
                self._pictures[name] = np.vstack((self._pictures[name], pictures))[:MOST_PICTURES]

    def copy(self) -> FaceMemory:
        other = FaceMemory()
        other._pictures = dict(self._pictures)
        return other

    def save(self, path: Path) -> None:
        """Write all to a file, as a whole or not at all.

        Raises:
            FileTrouble: It cannot be written; what was there before still is.
        """
        content = io.BytesIO()
        arrays = {KEY.format(number): pictures for number, pictures in enumerate(self._pictures.values())}
        np.savez(content, names=np.array(self.names, dtype=np.str_), **arrays)
        write_whole(path, content.getvalue())

    @classmethod
    def load(cls, path: Path, length: int | None = None) -> FaceMemory:
        """What a file has.

        Args:
            path: The file.
            length: Numbers of a description; None: any, as long as all have as many.

        Raises:
            FaceFileError: It cannot be read, or is no such file.
        """
        memory = cls()
        try:
            with Archive(path) as content:
                names = [str(name) for name in read_array(content.read("names.npy"))]
                arrays = [read_array(content.read(f"{KEY.format(i)}.npy")) for i in range(len(names))]
            memory._pictures = dict(zip(names, _checked(arrays, length)))
        except (OSError, ValueError, TypeError) as error:
            raise FaceFileError(f"{str(path)!r} is no file of known faces: {error}") from error
        return memory


def read_array(content: bytes) -> np.ndarray:
    """The array of a .npy file; its header may not claim more than there is."""
    file = io.BytesIO(content)
    try:
        if np.lib.format.read_magic(file) != (1, 0):
            raise ValueError("its version is not 1.0")
        shape, columns_first, kind = np.lib.format.read_array_header_1_0(file)
    except (EOFError, SyntaxError, TypeError, RecursionError, MemoryError) as error:
        raise ValueError(f"its header is broken: {error}") from error
    if kind.hasobject or columns_first or kind.itemsize == 0:
        raise ValueError(f"{kind} in this order is not read")
    return np.frombuffer(content, kind, offset=file.tell()).reshape(shape)


def _checked(arrays: Sequence[np.ndarray], length: int | None) -> list[np.ndarray]:
    widths = {array.shape[1:] for array in arrays} | ({(length,)} if length else set())
    if len(widths) > 1 or any(array.ndim != 2 or not 1 <= len(array) <= MOST_PICTURES for array in arrays):
        raise ValueError("its descriptions do not fit together, or not to faces")
    if any(array.dtype.kind != "f" or not np.isfinite(array).all() for array in arrays):
        raise ValueError("its descriptions are not of finite numbers")
    return [array.astype(np.float32) for array in arrays]
