"""Files that are written while the sound goes on can be read at any moment."""

from __future__ import annotations

import numpy as np
import pytest
import soundfile

from nao_sim_bridge.sim.errors import BadValue
from nao_sim_bridge.sim.sound import wav_file
from nao_sim_bridge.sim.sound.wav_file import OggFile, WavFile


@pytest.fixture
def noise():
    return np.random.default_rng(0).integers(-20000, 20000, (8160, 4), dtype=np.int16)


def test_a_wav_is_whole_after_every_block_without_being_closed(tmp_path, noise):
    path = tmp_path / "a.wav"
    file = WavFile(path, 48000, 4)
    assert soundfile.info(str(path)).frames == 0
    for count in (1, 2, 3):
        file.write(noise)
        samples, rate = soundfile.read(str(path), dtype="int16")
        assert (rate, samples.shape) == (48000, (8160 * count, 4))
        np.testing.assert_array_equal(samples[-8160:], noise)
    file.close()
    assert path.stat().st_size == 44 + 3 * noise.nbytes


def test_a_wav_replaces_a_longer_one(tmp_path, noise):
    path = tmp_path / "a.wav"
    path.write_bytes(b"x" * 100000)
    file = WavFile(path, 16000, 1)
    file.write(noise[:, :1])
    file.close()
    assert soundfile.info(str(path)).frames == 8160


def test_a_wav_that_is_full_says_so_and_stays_whole(tmp_path, noise, monkeypatch):
    monkeypatch.setattr(wav_file, "LARGEST", 100000)
    path = tmp_path / "a.wav"
    file = WavFile(path, 48000, 4)
    file.write(noise)
    with pytest.raises(BadValue, match="4 GiB"):
        file.write(noise)
    file.close()
    assert soundfile.info(str(path)).frames == 8160


def test_an_ogg_holds_what_was_written(tmp_path):
    path = tmp_path / "a.ogg"
    time = np.arange(16000) / 16000
    tone = (10000 * np.sin(2.0 * np.pi * 440.0 * time)).astype(np.int16)[:, np.newaxis]
    file = OggFile(path, 16000, 1)
    for first in range(0, 16000, 2720):
        file.write(tone[first : first + 2720])
    file.close()
    facts = soundfile.info(str(path))
    assert (facts.format, facts.samplerate, facts.channels, facts.frames) == ("OGG", 16000, 1, 16000)
    samples, _ = soundfile.read(str(path))
    assert np.argmax(np.abs(np.fft.rfft(samples))) == 440
