"""Reads sound files that others bring: in a process of its own, bounded by `config/sizes.json`."""

from __future__ import annotations

import threading
import time
from pathlib import Path

import numpy as np

from nao_sim_bridge.base.child_process import ChildProcess
from nao_sim_bridge.base.samples import Sound
from nao_sim_bridge.base.sizes import Sizes, load_sizes
from nao_sim_bridge.sound.files import SoundFileError

MODULE = "nao_sim_bridge.sound.worker"
START_TIMEOUT = 30.0
"""s; it is there within a fraction of one, but a busy machine may need long to start an interpreter."""


class _Failed(SoundFileError):
    """The process died, or took too long."""


class SoundReader:
    """Its process starts with the first file. Any thread may ask; one file is read at a time."""

    def __init__(self) -> None:
        self.sizes: Sizes = load_sizes()
        self._lock = threading.Lock()
        self._child: ChildProcess | None = None

    @property
    def pid(self) -> int | None:
        """Process id of the sound process; None while there is none."""
        child = self._child
        return child.process.pid if child is not None else None

    def read(self, path: Path | str, longest: float | None = None) -> Sound:
        """The sound in a file, at its own rate and with its own channels; blocks until it is there.

        Args:
            longest: Longest sound allowed, s; that of a sound of a world when None.

        Raises:
            SoundFileError: There is no such file, it holds no sound that can be read, or too much of it.
        """
        what, path = f"sound file {path}", Path(path)
        if not path.exists():
            raise SoundFileError(f"{what}: there is no such file")
        if not path.is_file():
            raise SoundFileError(f"{what}: is not a file")
        longest = self.sizes.sound.world_s if longest is None else longest
        with self._lock:
            try:
                return self._received(self._running(), (str(path.absolute()), longest, self.sizes.sound), what)
            except SoundFileError:
                raise
            except BaseException:
                self._kill()  # an answer that is half read: what comes next would be taken for another one
                raise

    def close(self) -> None:
        """End the process; a later file would start it again."""
        child = self._child
        if child is not None and self._lock.locked():
            child.process.kill()  # it decodes, and nobody waits for that
        with self._lock:
            if self._child is not None:
                self._child.stop()
                self._child = None

    # --- inside, under the lock -----------------------------------------------------------------------------------

    def _received(self, child: ChildProcess, request: tuple, what: str) -> Sound:
        end = time.monotonic() + self.sizes.decoder.total_s
        child.send("read", request, what)
        rate, channels = child.receive(end - time.monotonic(), what)
        samples = bytearray()
        while True:
            block = child.receive(max(0.0, end - time.monotonic()), what)
            if not block:
                return Sound(np.frombuffer(samples, np.float32).reshape(-1, channels), rate)
            samples += block

    def _running(self) -> ChildProcess:
        """The process when it is ready; it is started when it does not run."""
        child = self._child
        if child is None or child.over or child.process.poll() is not None:
            self._kill()
            memory = str(self.sizes.decoder.memory_bytes)
            self._child = child = ChildProcess(MODULE, [memory], "sound process", _Failed, SoundFileError)
            child.receive(START_TIMEOUT, "starting")
        return child

    def _kill(self) -> None:
        if self._child is not None:
            self._child.kill()
