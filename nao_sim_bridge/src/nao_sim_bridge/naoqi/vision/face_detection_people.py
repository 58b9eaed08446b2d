"""The people that the robot knows, kept in a file of the folder for recordings."""

from __future__ import annotations

import os
import threading
from typing import Any, Callable

import numpy as np

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.record_dir import ClientFiles
from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.base.whole_file import put_aside
from nao_sim_bridge.vision.face_memory import FaceFileError, FaceMemory
from nao_sim_bridge.vision.faces_features import DESCRIPTION_LENGTH

FILE, OLD_FILE = "faces.npz", "faces_old.npz"


class KnownPeople:
    """Known people; what changes is on the disk before it counts. Any thread.

    A file that cannot be used is put aside, and nobody is known.

    Attributes:
        changed: Called when somebody has been learnt or forgotten.
    """

    def __init__(self, files: ClientFiles) -> None:
        self.changed: list[Callable[[], Any]] = []
        self._files = files
        self._lock = threading.Lock()
        self._memory: FaceMemory | None = None

    @property
    def names(self) -> list[str]:
        with self._lock:
            return self._known().names

    def recognise(self, description: np.ndarray) -> tuple[str, float]:
        """Who it is most likely, and how sure that is, 0..1."""
        with self._lock:
            return self._known().recognise(description)

    def learn(self, name: str, description: np.ndarray) -> bool:
        """Add a picture of somebody; False when there are as many as there can be."""
        return self._change(lambda memory: memory.learn(name, description))

    def forget(self, name: str) -> bool:
        """Forget somebody; False when nobody of the name is known."""
        return self._change(lambda memory: memory.forget(name))

    def clear(self) -> None:
        def clear(memory: FaceMemory) -> bool:
            memory.clear()
            return True

        self._change(clear)

    def take_over(self, policy: str) -> bool:
        """Take in the people of the file `faces_old.npz`, a `faces.npz` of another robot; False when there is none.

        A FaceFileError when it is not such a file.
        """
        path = self._files.to_write(OLD_FILE)
        if not path.is_file():
            return False
        other = FaceMemory.load(path, DESCRIPTION_LENGTH)

        def take_over(memory: FaceMemory) -> bool:
            memory.take_over(other, policy)
            return True

        return self._change(take_over)

    def _change(self, change: Callable[[FaceMemory], bool]) -> bool:
        with self._lock:
            changed = self._known().copy()
            done = change(changed)
            most = load_sizes().kept.people
            if len(changed.names) > max(most, len(self._known().names)):
                raise BadValue(
                    "people", len(changed.names), f"at most {most} whose faces are known: forgetPerson first"
                )
            if done:
                changed.save(self._files.to_change(FILE))
                self._memory = changed
        for call in list(self.changed) if done else ():
            call()
        return done

    def _known(self) -> FaceMemory:
        """The people, read from the file when they are wanted first; with the lock held."""
        if self._memory is None:
            self._memory = FaceMemory()
            place = self._files.folder / FILE
            if os.path.lexists(place):
                try:
                    self._memory = FaceMemory.load(self._files.to_write(FILE), DESCRIPTION_LENGTH)
                except (FaceFileError, OSError, ValueError) as error:
                    put_aside(place, error, "nobody is known by the face")
        return self._memory
