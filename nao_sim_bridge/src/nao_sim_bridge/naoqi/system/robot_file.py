"""What a module of the robot remembers from one run to the next, in a file among the robot's own."""

from __future__ import annotations

import json
import logging
import os
from pathlib import Path
from typing import Any, Callable, Mapping, TypeVar

from nao_sim_bridge.base.config import read_json
from nao_sim_bridge.base.errors import SimulationError
from nao_sim_bridge.base.record_dir import ClientFiles, NoSuchFile
from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.base.whole_file import put_aside, write_whole
from nao_sim_bridge.naoqi.binding.errors import NaoqiError

WITHOUT = "the robot begins with nothing instead"
UNUSABLE = (
    SimulationError,
    OSError,
    ValueError,
    TypeError,
    LookupError,
    ArithmeticError,
    AttributeError,
    RecursionError,
)
"""What reading a file of anything may raise."""
log = logging.getLogger("nao_sim.files")
Content = TypeVar("Content")


class RobotFile:
    """A JSON object in a file. One that cannot be used is put aside, and the module begins with nothing.

    Attributes:
        aside: Where the file is that could not be used; None if there was none.
    """

    def __init__(self, files: ClientFiles, name: str) -> None:
        self.aside: Path | None = None
        self._files = files
        self._name = name

    def load(self, read: Callable[[dict[str, Any]], Content]) -> Content:
        """What `read` makes of it; of nothing, {}, when there is no such file, or none that can be used.

        Args:
            read: Raises any of `UNUSABLE` where the content is not what `save` was given.
        """
        place = self._files.folder / self._name
        try:
            path = self._files.to_read(self._name)
        except NoSuchFile as error:
            if os.path.exists(place):  # a folder, a pipe
                self.aside = put_aside(place, error, WITHOUT)
            return read({})
        except (OSError, ValueError) as error:  # it leads out of the robot's places, or past what may not be looked at
            if os.path.islink(place):
                self.aside = put_aside(place, error, WITHOUT)
            else:
                log.error("%s cannot be used: %s; %s, and cannot keep what it learns", place, error, WITHOUT)
            return read({})
        try:
            content = read_json(path)
            _encoded(content)
            return read(content)
        except UNUSABLE as error:
            self.aside = put_aside(path, error, WITHOUT)
            return read({})

    def save(self, content: Mapping[str, Any]) -> None:
        """Have this in it and nothing else.

        Raises:
            NaoqiError: It would be too large, or has what no file can hold.
            FileTrouble: It cannot be written; the former content stays.
        """
        try:
            text = _encoded(content)
        except (ValueError, RecursionError) as error:
            raise NaoqiError(f"{self._name} cannot hold this: {error}") from error
        most = load_sizes().kept.file_bytes
        if len(text) > most:
            raise NaoqiError(f"{self._name} would have {len(text)} bytes: {most} at most")
        write_whole(self._files.to_change(self._name), text)


def _encoded(content: Mapping[str, Any]) -> bytes:
    """The bytes of a file; a ValueError for numbers that are not finite and halves of characters."""
    return json.dumps(content, ensure_ascii=False, allow_nan=False).encode()
