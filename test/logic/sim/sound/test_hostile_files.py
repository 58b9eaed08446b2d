"""Sound files that claim or expand to too much, or need a decoder that is not trusted: the next one is read."""

from __future__ import annotations

import os
import signal
import struct
from contextlib import suppress
from dataclasses import replace

import numpy as np
import pytest
import soundfile
from waits import hold

from nao_sim_bridge.base.samples import sine
from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.sound.files import SoundFileError, SoundReader, write_sound


def chunk(name, content):
    return name + struct.pack("<I", len(content)) + content + b"\0" * (len(content) % 2)


def wav(*chunks):
    return chunk(b"RIFF", b"WAVE" + b"".join(chunks))


def form(code=1, channels=1, rate=48000, bits=16):
    size = channels * bits // 8
    return chunk(b"fmt ", struct.pack("<HHIIHH", code, channels, rate, rate * size, size, bits))


def tag(content, flags=0):
    size = bytes(len(content) >> shift & 0x7F for shift in (21, 14, 7, 0))
    return b"ID3\x03\0" + bytes([flags]) + size + content


DATA = chunk(b"data", b"\0" * 3200)


def flac(frames, channels=2, rate=48000):
    """The header of a FLAC that claims so many frames, and nothing behind it."""
    packed = rate << 44 | (channels - 1) << 41 | 15 << 36 | frames
    return b"fLaC\x80\x00\x00\x22" + struct.pack(">HH", 4096, 4096) + bytes(6) + packed.to_bytes(8, "big") + bytes(16)


@pytest.fixture
def refusal(reader, tmp_path):
    """The text with which a file of this content is refused; without the path."""

    def read(content, name="a.wav", **options):
        path = tmp_path / name
        path.write_bytes(content)
        with pytest.raises(SoundFileError) as raised:
            reader.read(path, **options)
        assert str(raised.value).startswith(f"sound file {path}: ")
        return str(raised.value).split(": ", 1)[1]

    return read


@pytest.mark.parametrize(
    "content, text",
    [
        (wav(form(channels=60), DATA), "has 60 channels, at most 16 are allowed"),
        (wav(form(rate=1), DATA), "has 1 frames a second, allowed are 4000 to 192000"),
        (wav(form(rate=10**9), DATA), "has 1000000000 frames a second, allowed are 4000 to 192000"),
        (flac(2**36 - 1), "is 1431656 s long, at most 3600 s are allowed"),
        (flac(100_000_000), r"has 200000000 samples in 2 channels, at most 172800000 are allowed"),
    ],
    ids=["channels", "slow", "fast", "long", "many"],
)
def test_what_a_header_claims_is_refused_before_it_is_read(refusal, content, text):
    assert refusal(content) == text


def test_a_small_file_that_expands_is_refused_by_its_samples_at_the_rate_of_the_world(refusal, tmp_path):
    with soundfile.SoundFile(str(tmp_path / "b.flac"), "w", 4000, 8, format="FLAC") as file:
        for _ in range(100):
            file.write(np.zeros((20000, 8), np.int16))
    assert (tmp_path / "b.flac").stat().st_size < 200_000
    text = refusal((tmp_path / "b.flac").read_bytes(), "a.flac")
    assert text == "has 192000000 samples in 8 channels, at most 172800000 are allowed"


def test_a_longer_sound_than_the_client_may_have_is_refused(refusal):
    assert refusal(wav(form(), DATA), longest=0.01) == "is 0 s long, at most 0 s are allowed"


@pytest.mark.parametrize("code", [0x0002, 0x0011, 0x0031])  # two kinds of ADPCM, and GSM
def test_packed_samples_never_reach_their_decoder(refusal, code):
    assert refusal(wav(form(code), DATA)).startswith(f"cannot be read: it is WAV with samples of form {code:#x}")
    extended = struct.pack("<HHIIHHHHIH", 0xFFFE, 1, 48000, 96000, 2, 16, 22, 16, 4, code) + bytes(14)
    assert f"form {code:#x}" in refusal(wav(chunk(b"fmt ", extended), DATA))
    hidden = wav(form(), chunk(b"junk", form(code)), DATA)
    assert "does not say once" in refusal(hidden)


@pytest.mark.parametrize("kind", ["AIFF", "AU", "CAF", "IRCAM", "W64", "VOC", "NIST", "SVX", "MAT4", "PAF"])
def test_kinds_that_nobody_needs_are_refused_also_behind_a_tag(refusal, tmp_path, kind):
    soundfile.write(str(tmp_path / "b"), np.zeros(100), 48000, format=kind, subtype="PCM_16")
    content = (tmp_path / "b").read_bytes()
    assert "which is none of WAV" in refusal(content)
    assert "which is none of WAV" in refusal(tag(bytes(10)) + content, "a.mp3")


@pytest.mark.parametrize("kind", ["WAV", "FLAC", "OGG"])
def test_what_the_other_decoder_opens_has_no_tags_in_which_another_file_could_hide(refusal, tmp_path, kind):
    soundfile.write(str(tmp_path / "b"), np.zeros(100), 48000, format=kind)
    for flags in (0, 0x10):  # with and without a footer, which libsndfile does not count
        footer = bytes(10) if flags else b""
        assert "tags are for MP3 alone" in refusal(tag(bytes(64), flags) + footer + (tmp_path / "b").read_bytes())


def test_ogg_with_another_codec_is_refused(refusal, tmp_path):
    soundfile.write(str(tmp_path / "b.ogg"), np.zeros(4800), 48000, format="OGG", subtype="VORBIS")
    content = (tmp_path / "b.ogg").read_bytes()
    assert "something else than Vorbis or Opus" in refusal(content.replace(b"\x01vorbis", b"\x7fFLAC\0\0"), "a.ogg")


def test_an_mp3_is_read_by_its_own_decoder_and_its_length_is_counted(reader, refusal, tmp_path):
    write_sound(tmp_path / "b.mp3", sine(440.0, 1.0, 0.5, 44100))
    assert reader.read(tmp_path / "b.mp3").duration == pytest.approx(1.0, abs=0.06)
    content = (tmp_path / "b.mp3").read_bytes()
    assert refusal(content, "a.mp3", longest=0.5) == "is 1 s long, at most 0 s are allowed"


def test_pictures_in_the_tags_of_an_mp3_reach_no_decoder(reader, tmp_path):
    write_sound(tmp_path / "b.mp3", sine(440.0, 1.0, 0.5, 44100))
    sound = (tmp_path / "b.mp3").read_bytes()
    picture = (
        b"\0image/bmp\0\3\0BM" + struct.pack("<IIIIiiHHIIiiII", 3126, 0, 54, 40, 32, 32, 1, 24, *[0] * 6) + bytes(3072)
    )
    (tmp_path / "a.mp3").write_bytes(tag(b"APIC" + struct.pack(">I", len(picture)) + b"\0\0" + picture) + sound)
    # Of a file that has a picture as well nothing is read.
    assert reader.read(tmp_path / "a.mp3").frames == reader.read(tmp_path / "b.mp3").frames


def test_a_file_that_needs_more_memory_than_there_is_ends_alone(tmp_path):
    reader = SoundReader()
    assert reader.pid is None, "there is no process before there is a file"
    sizes = load_sizes()
    fast = replace(sizes.sound, highest_rate_hz=10**9)
    reader.sizes = replace(sizes, sound=fast, decoder=replace(sizes.decoder, memory_bytes=300_000_000))
    try:
        write_sound(tmp_path / "b.wav", sine(440.0, 1.0))
        with open(tmp_path / "a.wav", "wb") as file:  # a second of it takes 400 MB, of which the disk has none
            file.write(wav(form(rate=200_000_000), b"")[:36] + b"data" + struct.pack("<I", 200_000_000))
            file.truncate(200_000_000)
        with pytest.raises(SoundFileError, match="it needs more memory than the 300000000 bytes there are for it"):
            reader.read(tmp_path / "a.wav")
        assert reader.read(tmp_path / "b.wav").frames == 48000
    finally:
        reader.close()


def test_a_file_on_which_the_process_dies_or_hangs_is_refused_and_the_next_one_is_read(reader, tmp_path, monkeypatch):
    write_sound(tmp_path / "b.wav", sine(440.0, 1.0))
    assert reader.read(tmp_path / "b.wav").frames == 48000
    hold(reader.pid)
    monkeypatch.setattr(reader, "sizes", replace(load_sizes(), decoder=replace(load_sizes().decoder, total_s=0.1)))
    with pytest.raises(SoundFileError, match="no answer of the sound process"):
        reader.read(tmp_path / "b.wav")
    monkeypatch.undo()
    assert reader.read(tmp_path / "b.wav").frames == 48000
    os.kill(reader.pid, signal.SIGKILL)
    with suppress(SoundFileError):  # it may or may not have been noticed
        reader.read(tmp_path / "b.wav")
    assert reader.read(tmp_path / "b.wav").frames == 48000
