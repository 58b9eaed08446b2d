"""Sound files: read and written in all kinds; recordings that grow are whole at any moment."""

from __future__ import annotations

import numpy as np
import pytest
import soundfile

from nao_sim_bridge.sim.sound.files import read_sound, write_sound
from nao_sim_bridge.sim.sound.samples import sine
from nao_sim_bridge.sim.sound.wav_file import OggFile, WavFile


@pytest.mark.parametrize("name, error", [("a.wav", 2e-5), ("a.flac", 2e-5), ("a.ogg", 0.02), ("a.mp3", 0.02)])
def test_a_sound_comes_back_from_its_file(tmp_path, name, error):
    tone = sine(440.0, 0.5, 0.5, 44100)
    write_sound(tmp_path / name, tone)
    back = read_sound(tmp_path / name)
    assert (back.rate, back.channels) == (44100, 1)
    assert back.frames == pytest.approx(tone.frames, abs=2400)
    levels = [np.sqrt(np.mean(each.samples[4000:16000] ** 2)) for each in (back, tone)]
    assert levels[0] == pytest.approx(levels[1], rel=error)


@pytest.fixture
def noise():
    return np.random.default_rng(0).integers(-20000, 20000, (8160, 4), dtype=np.int16)


def test_a_wav_is_whole_after_every_block_and_replaces_a_longer_one(tmp_path, noise):
    path = tmp_path / "a.wav"
    path.write_bytes(b"x" * 1000000)
    file = WavFile(path, 48000, 4)
    assert soundfile.info(str(path)).frames == 0
    for count in (1, 2, 3):
        file.write(noise)
        samples, rate = soundfile.read(str(path), dtype="int16")
        assert (rate, samples.shape) == (48000, (8160 * count, 4))
        np.testing.assert_array_equal(samples[-8160:], noise)
    file.close()
    assert path.stat().st_size == 44 + 3 * noise.nbytes


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
