"""The sound process: `python -m nao_sim_bridge.sound.worker FD MEMORY`. It decodes sound files that others bring.

In a process of its own with at most MEMORY bytes of address space: a small file may expand to a large sound, and a
broken one may take a decoder down.

It talks over the inherited pipe FD in tuples (kind, content). First it sends ("ready", None). Then it answers ("read",
(path, longest sound in s, SoundSizes)) with ("sound", (rate, channels)), then ("samples", bytes of float32) for each
second or less, and ("samples", b"") at the end; or at any place with ("error", text). It ends when the pipe is closed.
"""

from __future__ import annotations

import os
import struct
import sys
from multiprocessing.connection import Connection
from typing import Any, BinaryIO, Iterable, Iterator, Tuple

import numpy as np
import soundfile

from nao_sim_bridge.base.child_process import limit_memory, pipe_to_parent
from nao_sim_bridge.base.samples import RATE
from nao_sim_bridge.base.sizes import SoundSizes

OPENED = ("WAV", "WAVEX", "FLAC", "OGG")
"""What libsndfile may take a file for."""
KINDS = "WAV (PCM, float, A-law, u-law), FLAC, Ogg Vorbis, Ogg Opus and MP3"
# Codes of WAVE's formats: PCM, float, A-law, u-law; and the one that says the code stands further on.
PLAIN, EXTENSIBLE = (1, 3, 6, 7), 0xFFFE
# The header of an Ogg page up to its table of segments.
OGG_HEAD = 27
MOST_CHUNKS, MOST_TAGS = 1000, 8


def kind_of(file: BinaryIO) -> Tuple[str, int]:
    """What a file holds, "wav", "flac", "ogg" or "mp3", by its first bytes, and where it begins: MP3 behind its tags.

    Only what somebody needs reaches a decoder: WAV with plain samples, FLAC, Ogg Vorbis, Ogg Opus, and MP3. Decoders
    have known holes in what nobody needs; of libsndfile 1.2.2, the one in the pinned wheel: IRCAM (CVE-2025-52194),
    ADPCM in WAV and AIFF (an overflow of its frames), and MP3 through the libmpg123 1.32.3 that it brings
    (CVE-2024-10573). MP3 is therefore decoded by FFmpeg, and the others are refused.

    Before anything else tags are refused: libsndfile counts their length in its own way, and finds another begin. A
    ValueError says what it is when it is none of them, or of a form that is not decoded.
    """
    begin = _after_tags(file)
    file.seek(begin)
    head = file.read(64)
    if head[:4] == b"RIFF" and head[8:12] == b"WAVE" and begin == 0:
        _check_wav(file)
        return "wav", begin
    if head[:4] == b"fLaC" and begin == 0:
        return "flac", begin
    if head[:4] == b"OggS" and len(head) > OGG_HEAD and begin == 0:
        packet = head[OGG_HEAD + head[26] :]
        if packet.startswith((b"\x01vorbis", b"OpusHead")):
            return "ogg", begin
        raise ValueError(f"it is Ogg with something else than Vorbis or Opus; allowed are {KINDS}")
    # Eleven bits of ones, then a version, and the layer III.
    if len(head) >= 2 and head[0] == 0xFF and head[1] & 0xE6 == 0xE2 and head[1] & 0x18 != 0x08:
        return "mp3", begin
    behind = "behind its tags " if begin else ""
    raise ValueError(f"it begins {behind}with {head[:4]!r}, which is none of {KINDS}; tags are for MP3 alone")


def _after_tags(file: BinaryIO) -> int:
    """Where the file begins behind tags of ID3."""
    place = 0
    for _ in range(MOST_TAGS):
        file.seek(place)
        head = file.read(10)
        if len(head) < 10 or head[:3] != b"ID3":
            return place
        size = 0
        for byte in head[6:10]:  # seven bits each
            size = size << 7 | byte & 0x7F
        place += 10 + size + (10 if head[5] & 0x10 else 0)
    raise ValueError(f"it begins with more than {MOST_TAGS} tags")


def _check_wav(file: BinaryIO) -> None:
    """Refuse a WAV whose samples are packed; what comes before the samples may say only once how they are."""
    place, formats = 12, []
    for _ in range(MOST_CHUNKS):
        file.seek(place)
        head = file.read(8)
        if len(head) < 8 or head[:4] == b"data":
            break
        size = struct.unpack("<I", head[4:])[0]
        if head[:4] == b"fmt ":
            formats.append(file.read(min(size, 40)))
        place += 8 + size + size % 2
    file.seek(0)
    before = file.read(min(place, 1_000_000))
    if len(formats) != 1 or before.count(b"fmt ") != 1 or place > 1_000_000:
        raise ValueError("its header does not say once, before the samples, of which form they are")
    code = formats[0][:2]
    if len(code) == 2 and struct.unpack("<H", code)[0] == EXTENSIBLE:
        code = formats[0][24:26]
    number = struct.unpack("<H", code)[0] if len(code) == 2 else 0
    if number not in PLAIN:
        raise ValueError(f"it is WAV with samples of form {number:#x}; allowed are {KINDS}")


class Refused(ValueError):
    """A file that is larger than what is allowed."""


def main(arguments: Iterable[str]) -> int:
    """Serve one pipe until it is closed."""
    descriptor, memory = arguments
    pipe = pipe_to_parent(descriptor)
    limit_memory(int(memory))
    try:
        pipe.send(("ready", None))
        while True:
            _, request = pipe.recv()
            try:
                _decode(pipe, *request)
            except MemoryError:
                pipe.send(("error", f"cannot be read: it needs more memory than the {memory} bytes there are for it"))
            except Refused as error:
                pipe.send(("error", str(error)))
            except (RuntimeError, OSError, ValueError) as error:
                pipe.send(("error", f"cannot be read: {error}"))
    except (EOFError, BrokenPipeError, ConnectionResetError):
        return 0  # the parent is gone or wants no more


def _decode(pipe: Connection, path: str, longest: float, sizes: SoundSizes) -> None:
    with open(path, "rb", buffering=0) as file:  # libsndfile goes on at the descriptor
        size = os.fstat(file.fileno()).st_size
        if size > sizes.file_bytes:
            raise Refused(f"has {size} bytes, at most {sizes.file_bytes} are allowed")
        kind, begin = kind_of(file)
        file.seek(begin)
        blocks = _mp3(_From(file, begin)) if kind == "mp3" else _libsndfile(file)
        rate, channels, claimed = next(blocks)
        _check(rate, channels, claimed, longest, sizes)
        pipe.send(("sound", (rate, channels)))
        frames = 0
        for block in blocks:
            frames += len(block)
            _check(rate, channels, frames, longest, sizes)  # what a header says need not be so
            for first in range(0, len(block), rate):
                part = np.nan_to_num(block[first : first + rate].astype(np.float32, copy=False))
                pipe.send(("samples", part.tobytes()))
    if not frames:
        raise Refused("holds no sound (0 frames)")
    pipe.send(("samples", b""))


def _check(rate: int, channels: int, frames: int, longest: float, sizes: SoundSizes) -> None:
    """Raise an error for a sound that is too large, as it is or at the rate of the simulated world."""
    if not sizes.lowest_rate_hz <= rate <= sizes.highest_rate_hz:
        allowed = f"{sizes.lowest_rate_hz} to {sizes.highest_rate_hz}"
        raise Refused(f"has {rate} frames a second, allowed are {allowed}")
    if channels > sizes.channels:
        raise Refused(f"has {channels} channels, at most {sizes.channels} are allowed")
    if frames > longest * rate:
        raise Refused(f"is {frames / rate:.0f} s long, at most {longest:.0f} s are allowed")
    values = frames * channels * max(1.0, RATE / rate)
    if values > sizes.values:
        raise Refused(f"has {values:.0f} samples in {channels} channels, at most {sizes.values} are allowed")


def _libsndfile(file: BinaryIO) -> Iterator[Any]:
    """First rate, channels, frames as the header says; then (frames, channels) float32, a second or less at a time."""
    with soundfile.SoundFile(file.fileno(), closefd=False) as sound:
        if sound.format not in OPENED:
            raise ValueError(f"it is {sound.format} for its decoder, allowed are {', '.join(OPENED)}")
        yield sound.samplerate, sound.channels, sound.frames
        while True:
            block = sound.read(sound.samplerate, dtype="float32", always_2d=True)
            if not len(block):
                return
            yield block


class _From:
    """A file from a byte on: in the tags before it FFmpeg would look for pictures, and decode them."""

    def __init__(self, file: BinaryIO, begin: int) -> None:
        self.read = file.read
        self._file = file
        self._begin = begin

    def seek(self, offset: int, whence: int = os.SEEK_SET) -> int:
        self._file.seek(offset + self._begin if whence == os.SEEK_SET else offset, whence)
        return self.tell()

    def tell(self) -> int:
        return self._file.tell() - self._begin


def _mp3(file: _From) -> Iterator[Any]:
    """The same of an MP3, whose header does not say how long it is."""
    import av  # takes a moment, and most sounds are none

    with av.open(file, format="mp3", metadata_errors="ignore") as container:
        if not container.streams.audio or len(container.streams) > 1:
            raise ValueError("it has no sound, or something else beside it")
        context = container.streams.audio[0].codec_context
        yield context.sample_rate, context.channels, 0
        try:
            for frame in container.decode(audio=0):
                if (frame.sample_rate, len(frame.layout.channels)) != (context.sample_rate, context.channels):
                    raise ValueError("its rate or its channels change on the way")
                yield frame.to_ndarray().T
        except av.error.FFmpegError as error:
            raise ValueError(f"its frames are broken: {error.strerror}") from error


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
