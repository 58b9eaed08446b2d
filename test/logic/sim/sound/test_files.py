"""Sound files: read and written in all kinds; recordings that grow are whole at any moment."""

from __future__ import annotations

import numpy as np
import pytest
import soundfile
from disks import room

from nao_sim_bridge.base.samples import sine
from nao_sim_bridge.base.whole_file import FileTrouble
from nao_sim_bridge.sound.files import OggFile, WavFile, write_sound


@pytest.mark.parametrize("name, error", [("a.wav", 2e-5), ("a.flac", 2e-5), ("a.ogg", 0.02), ("a.mp3", 0.02)])
def test_a_sound_comes_back_from_its_file(reader, tmp_path, name, error):
    tone = sine(440.0, 0.5, 0.5, 44100)
    write_sound(tmp_path / name, tone)
    back = reader.read(tmp_path / name)
    assert (back.rate, back.channels) == (44100, 1)
    assert back.frames == pytest.approx(tone.frames, abs=2400)
    levels = [np.sqrt(np.mean(each.samples[4000:16000] ** 2)) for each in (back, tone)]
    assert levels[0] == pytest.approx(levels[1], rel=error)


@pytest.fixture
def noise():
    return np.random.default_rng(0).integers(-20000, 20000, (8160, 4), dtype=np.int16)


def test_a_wav_is_whole_after_every_block_and_replaces_a_longer_one_in_the_end(tmp_path, noise):
    path, part = tmp_path / "a.wav", tmp_path / "a.part1.wav"
    path.write_bytes(b"x" * 1000000)
    file = WavFile(path, 48000, 4)
    assert soundfile.info(str(part)).frames == 0
    for count in (1, 2, 3):
        file.write(noise)
        samples, rate = soundfile.read(str(part), dtype="int16")
        assert (rate, samples.shape) == (48000, (8160 * count, 4))
        np.testing.assert_array_equal(samples[-8160:], noise)
    assert path.stat().st_size == 1000000
    file.close()
    assert path.stat().st_size == 44 + 3 * noise.nbytes


def test_a_wav_goes_on_after_a_full_disk_with_silence_for_what_was_lost(tmp_path, noise):
    path = tmp_path / "a.wav"
    file = WavFile(path, 48000, 4)
    with room(100000):
        file.write(noise)
        with pytest.raises(FileTrouble, match="a.wav cannot be written: File too large"):
            file.write(noise)
    file.recover()
    file.write(noise, silence=8160)
    file.close()
    samples, _ = soundfile.read(str(path), dtype="int16")
    np.testing.assert_array_equal(samples, np.concatenate([noise, np.zeros_like(noise), noise]))


def test_a_full_disk_leaves_no_half_sound_and_an_ogg_of_what_had_room(tmp_path, noise):
    path = tmp_path / "a.flac"
    write_sound(path, sine(440.0, 0.5, 0.5, 44100))
    before = path.read_bytes()
    with room(4000), pytest.raises(FileTrouble, match="a.flac cannot be written: File too large"):
        write_sound(path, sine(440.0, 5.0, 0.5, 44100))
    assert path.read_bytes() == before
    file = OggFile(tmp_path / "a.ogg", 48000, 4)
    with room(60000), pytest.raises(FileTrouble, match="a.ogg cannot be written"):
        for _ in range(100):
            file.write(noise)
    with pytest.raises(FileTrouble, match="a.ogg cannot be written"):
        file.close()
    assert len(soundfile.read(str(tmp_path / "a.ogg"))[0]) > 8160


def test_an_ogg_holds_what_was_written(tmp_path):
    path = tmp_path / "a.ogg"
    tone = (10000 * np.sin(2.0 * np.pi * 440.0 * np.arange(16000) / 16000)).astype(np.int16)[:, np.newaxis]
    file = OggFile(path, 16000, 1)
    for first in range(0, 16000, 2720):
        file.write(tone[first : first + 2720])
    file.close()
    facts = soundfile.info(str(path))
    assert (facts.format, facts.samplerate, facts.channels, facts.frames) == ("OGG", 16000, 1, 16000)
    assert np.argmax(np.abs(np.fft.rfft(soundfile.read(str(path))[0]))) == 440
