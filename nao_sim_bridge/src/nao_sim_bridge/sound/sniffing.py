"""What a sound file is, by its first bytes, before a decoder sees it. Arithmetic on bytes only.

Only what somebody needs reaches a decoder: WAV with plain samples, FLAC, Ogg Vorbis, Ogg Opus, and MP3. Decoders have
known holes in what nobody needs; of libsndfile 1.2.2, the one in the pinned wheel: IRCAM (CVE-2025-52194), ADPCM in WAV
and AIFF (an overflow of its frames), and MP3 through the libmpg123 1.32.3 that it brings (CVE-2024-10573). MP3 is
therefore decoded by FFmpeg, and the others are refused.
"""

from __future__ import annotations

import struct
from typing import BinaryIO, Tuple

KINDS = "WAV (PCM, float, A-law, u-law), FLAC, Ogg Vorbis, Ogg Opus and MP3"
# Codes of WAVE's formats: PCM, float, A-law, u-law; and the one that says the code stands further on.
PLAIN, EXTENSIBLE = (1, 3, 6, 7), 0xFFFE
# The header of an Ogg page up to its table of segments.
OGG_HEAD = 27
MOST_CHUNKS, MOST_TAGS = 1000, 8


def kind_of(file: BinaryIO) -> Tuple[str, int]:
    """What a file holds, "wav", "flac", "ogg" or "mp3", and at which byte it begins: an MP3 behind its tags.

    Before anything else tags are refused: libsndfile counts their length in its own way, and finds another begin.

    Args:
        file: At any place; left at any place.

    Raises:
        ValueError: It is none of them, or of a form that is not decoded; the text says which.
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
