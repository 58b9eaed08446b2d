"""What a module of the robot remembers from one run to the next, in a file among the robot's own."""

from __future__ import annotations

import json
import logging
from typing import Any, Mapping

from nao_sim_bridge.base.config import read_json
from nao_sim_bridge.base.errors import ConfigError
from nao_sim_bridge.base.record_dir import ClientFiles, NoSuchFile
from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.base.whole_file import write_whole
from nao_sim_bridge.naoqi.binding.errors import NaoqiError

log = logging.getLogger("nao_sim.files")


class RobotFile:
    """A JSON object in a file. One that cannot be read is put aside, with ".broken" behind its name."""

    def __init__(self, files: ClientFiles, name: str) -> None:
        self._files = files
        self._name = name

    def load(self) -> dict[str, Any]:
        """What is in it; empty when there is no such file."""
        try:
            path = self._files.to_read(self._name)
        except NoSuchFile:
            return {}
        try:
            return read_json(path)
        except ConfigError as error:
            aside = path.with_name(path.name + ".broken")
            path.replace(aside)
            log.error("%s; it is kept as %s, and the robot begins with nothing", error, aside)
            return {}

    def save(self, content: Mapping[str, Any]) -> None:
        """Have this in it and nothing else.

        Raises:
            NaoqiError: It would be too large.
            FileTrouble: It cannot be written; the former content stays.
        """
        text = json.dumps(content).encode()
        most = load_sizes().kept.file_bytes
        if len(text) > most:
            raise NaoqiError(f"{self._name} would have {len(text)} bytes: {most} at most")
        write_whole(self._files.to_change(self._name), text)
