"""Sound from an address of the web: fetched as a whole in a process of its own, with limits, then decoded."""

from __future__ import annotations

import tempfile
import threading
import urllib.parse
from typing import Callable

from nao_sim_bridge.base.child_process import ChildProcess
from nao_sim_bridge.base.errors import SimulationError
from nao_sim_bridge.base.samples import Sound
from nao_sim_bridge.base.sizes import StreamSizes
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.sound.sound_files import SoundFiles

MODULE = "nao_sim_bridge.naoqi.sound.web_fetch"
LOOK = 0.1
"""How often it is looked whether anybody still wants it, s."""


class WebStreams:
    """Fetches sounds for the clients of one robot, from this computer and private networks only if that is allowed."""

    def __init__(self, sounds: SoundFiles, allow_private: bool) -> None:
        self.sizes: StreamSizes = sounds.reader.sizes.stream
        self.count = 0
        self._sounds = sounds
        self._allow_private = allow_private
        self._lock = threading.Lock()  # guards the count

    def fetch(self, address: str, wanted: Callable[[], bool] = lambda: True) -> Sound:
        """The sound at an address of http, https, or a file that the client may read; for a thread of its own.

        `wanted` is asked now and then whether to go on. A NaoqiError when the address is none or not allowed, nothing
        usable is there, it is too large, it does not end, too many are being fetched, or nobody wants it any more.
        """
        try:
            parts = urllib.parse.urlsplit(address)
        except ValueError as error:
            raise _no_address(address) from error
        if parts.scheme == "file":
            folder = str(self._sounds.files.folder) + "/"
            return self._sounds.read(urllib.parse.unquote(parts.path).replace(folder, "", 1))
        if parts.scheme not in ("http", "https") or not parts.hostname:
            raise _no_address(address)
        with self._lock:
            if self.count >= self.sizes.at_once:
                raise NaoqiError(
                    f"{self.count} streams are being fetched, at most {self.sizes.at_once} at once are allowed"
                )
            self.count += 1
        try:
            with tempfile.NamedTemporaryFile() as file:
                self._download(address, file.name, wanted)
                return self._sounds.read_path(file.name, address)
        finally:
            with self._lock:
                self.count -= 1

    def _download(self, address: str, path: str, wanted: Callable[[], bool]) -> None:
        what = f"nothing can be fetched from {address}"
        memory = str(self.sizes.memory_bytes)
        child = ChildProcess(MODULE, [memory], "fetching process", SimulationError, SimulationError)
        deadline = child.deadline(self.sizes.total_s)
        try:
            child.send("fetch", (address, path, self.sizes, self._allow_private), what)
            while not child.pipe.poll(LOOK):
                if not wanted():
                    raise NaoqiError(f"{what}: nobody wants it any more")
                if deadline.left < 0.0:
                    raise NaoqiError(f"{what}: it has not ended after {self.sizes.total_s:g} s")
            child.receive(0.0, what)
        except SimulationError as error:
            raise NaoqiError(str(error)) from error
        finally:
            child.kill()


def _no_address(address: str) -> NaoqiError:
    return NaoqiError(f"streamName is {address!r}, allowed is an address of http, https or file")
