"""Sound files that are written while the sound goes on; a WAV is whole at any moment, even if its writer is killed."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import soundfile

from nao_sim_bridge.sim.errors import BadValue

HEADER = struct.Struct("<4sI4s4sIHHIIHH4sI")
PCM, BITS = 1, 16
# What fits into the 32 bits that a WAV has for its length.
LARGEST = 2**32 - 1 - HEADER.size


class WavFile:
    """A WAV of 16 bits, its header brought up to date with each block.

    Args:
        path: Where; a file that is there is replaced.
        rate: Samples a second.
        channels: Their number.
    """

    def __init__(self, path: Path, rate: int, channels: int) -> None:
        self._rate, self._channels = rate, channels
        self._bytes = 0
        self._file = path.open("wb", buffering=0)
        self._file.write(self._header())

    def write(self, samples: np.ndarray) -> None:
        """Append (frames, channels) int16.

        Raises:
            BadValue: The file has no room for them.
        """
        block = np.ascontiguousarray(samples, dtype="<i2").tobytes()
        if self._bytes + len(block) > LARGEST:
            raise BadValue("length of the recording", "more", "4 GiB, all that a WAV can hold")
        self._file.seek(0, 2)
        self._file.write(block)
        self._bytes += len(block)
        self._file.seek(0)
        self._file.write(self._header())

    def close(self) -> None:
        """End the file."""
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
    """An Ogg Vorbis file.

    Args:
        path: Where; a file that is there is replaced.
        rate: Samples a second.
        channels: Their number.
    """

    def __init__(self, path: Path, rate: int, channels: int) -> None:
        self._file = soundfile.SoundFile(str(path), "w", rate, channels, format="OGG", subtype="VORBIS")

    def write(self, samples: np.ndarray) -> None:
        """Append (frames, channels) int16."""
        self._file.write(samples)

    def close(self) -> None:
        """End the file."""
        self._file.close()
