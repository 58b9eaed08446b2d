"""Sounds written to files, at once or while they go on; a WAV is whole at any moment, even if its writer is killed."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np

from nao_sim_bridge.base.errors import BadValue, SimulationError
from nao_sim_bridge.base.samples import Sound
from nao_sim_bridge.base.whole_file import FileTrouble, WholeFile

KINDS = {".wav": ("WAV", "PCM_16"), ".flac": ("FLAC", "PCM_16"), ".ogg": ("OGG", "VORBIS"), ".mp3": ("MP3", None)}
HEADER = struct.Struct("<4sI4s4sIHHIIHH4sI")
PCM, BITS = 1, 16
# What fits into the 32 bits that a WAV has for its length.
LARGEST = 2**32 - 1 - HEADER.size


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
    """A WAV of 16 bits, its header brought up to date with each block.

    Args:
        path: Where; a file that is there is replaced when this one is closed.
        rate: Samples a second.
    """

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
        return HEADER.pack(
            b"RIFF",
            HEADER.size - 8 + self._bytes,
            b"WAVE",
            b"fmt ",
            16,
            PCM,
            self._channels,
            self._rate,
            self._rate * frame,
            frame,
            BITS,
            b"data",
            self._bytes,
        )


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
