"""Sound files: written at once or while sounds go on, and read where others bring them.

A WAV is whole at any moment, even if its writer is killed.
"""

from __future__ import annotations

import struct
import threading
from pathlib import Path

import numpy as np

from nao_sim_bridge.base.child_process import ChildProcess
from nao_sim_bridge.base.errors import BadValue, SimulationError
from nao_sim_bridge.base.samples import Sound
from nao_sim_bridge.base.sizes import Sizes, load_sizes
from nao_sim_bridge.base.whole_file import FileTrouble, WholeFile

KINDS = {".wav": ("WAV", "PCM_16"), ".flac": ("FLAC", "PCM_16"), ".ogg": ("OGG", "VORBIS"), ".mp3": ("MP3", None)}
HEADER = struct.Struct("<4sI4s4sIHHIIHH4sI")
PCM, BITS = 1, 16
# What fits into the 32 bits that a WAV has for its length.
LARGEST = 2**32 - 1 - HEADER.size
MODULE = "nao_sim_bridge.sound.worker"
START_TIMEOUT = 30.0
"""s; it is there within a fraction of one, but a busy machine may need long to start an interpreter."""


class SoundFileError(SimulationError):
    """A sound file that cannot be read or written; the text names it and says why."""


def write_sound(path: Path | str, sound: Sound) -> None:
    """Write a sound; the ending of the name says of which kind the file is.

    Raises:
        SoundFileError: The kind is unknown, or there can be no such sound.
        FileTrouble: The file cannot be written.
    """
    import soundfile  # takes a moment, and a silent simulation does without

    path = Path(path)
    if path.suffix.lower() not in KINDS:
        raise SoundFileError(f"sound file {path}: the name has to end with {', '.join(KINDS)}")
    kind, coding = KINDS[path.suffix.lower()]
    try:
        with WholeFile(path) as target:
            with soundfile.SoundFile(target, "w", sound.rate, sound.channels, coding, format=kind) as file:
                # In pieces: the encoder of Vorbis keeps all that it is given at once on its stack.
                for first in range(0, sound.frames, sound.rate):
                    file.write(np.clip(sound.samples[first : first + sound.rate], -1.0, 1.0))
    except (soundfile.LibsndfileError, ValueError) as error:
        raise SoundFileError(f"sound file {path}: cannot be written: {error}") from error


class WavFile:
    """A WAV of 16 bits, its header brought up to date with each block; closed, it replaces a file that was there."""

    def __init__(self, path: Path, rate: int, channels: int) -> None:
        self._rate, self._channels = rate, channels
        self._bytes = 0
        self._file = WholeFile(path)
        self._file.write(self._header())
        self._file.flush()

    def write(self, samples: np.ndarray, silence: int = 0) -> None:
        """Append (frames, channels) int16, behind some frames of silence.

        Raises:
            BadValue: The file has no room for them.
            FileTrouble: They cannot be written; after `recover`, others may.
        """
        block = np.ascontiguousarray(samples, dtype="<i2").tobytes()
        before, begin = self._bytes, self._bytes + silence * self._channels * BITS // 8
        if begin + len(block) > LARGEST:
            raise BadValue("length of the recording", "more", "4 GiB, all that a WAV can hold")
        self._file.seek(HEADER.size + begin)
        self._file.write(block)
        self._bytes = begin + len(block)
        self._file.seek(0)
        self._file.write(self._header())
        try:
            self._file.flush()
        except FileTrouble:
            self._bytes = before
            raise

    def recover(self) -> None:
        """Go on after a FileTrouble."""
        self._file.recover()

    def close(self) -> None:
        """End the file; see `WholeFile.close`."""
        self._file.close()

    def _header(self) -> bytes:
        frame = self._channels * BITS // 8
        form = (16, PCM, self._channels, self._rate, self._rate * frame, frame, BITS)
        return HEADER.pack(b"RIFF", HEADER.size - 8 + self._bytes, b"WAVE", b"fmt ", *form, b"data", self._bytes)


class OggFile:
    """An Ogg Vorbis file."""

    def __init__(self, path: Path, rate: int, channels: int) -> None:
        import soundfile

        self._target = WholeFile(path)
        self._file = soundfile.SoundFile(self._target, "w", rate, channels, format="OGG", subtype="VORBIS")

    def write(self, samples: np.ndarray) -> None:
        """Append (frames, channels) int16.

        Raises:
            FileTrouble: They cannot be written.
        """
        self._file.write(samples)
        self._target.flush()

    def close(self) -> None:
        self._file.close()
        self._target.close()


class _Failed(SoundFileError):
    """The process died, or took too long."""


class SoundReader:
    """Reads sound files that others bring in a process of its own, which `config/sizes.json` bounds.

    It starts with the first file. Any thread may ask; one file is read at a time.
    """

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
        deadline = child.deadline(self.sizes.decoder.total_s)
        child.send("read", request, what)
        rate, channels = child.receive(deadline, what)
        samples = bytearray()
        while True:
            block = child.receive(deadline, what)
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
