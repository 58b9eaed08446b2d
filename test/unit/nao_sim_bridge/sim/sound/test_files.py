from __future__ import annotations

import numpy as np
import pytest
import soundfile

from nao_sim_bridge.sim.sound.files import SoundFileError, read_sound, write_sound
from nao_sim_bridge.sim.sound.samples import Sound, sine


@pytest.mark.parametrize("name, error", [("a.wav", 2e-5), ("a.flac", 2e-5), ("a.ogg", 0.02), ("a.mp3", 0.02)])
def test_a_sound_comes_back_from_its_file(tmp_path, name, error):
    tone = sine(440.0, 0.5, 0.5, 44100)
    write_sound(tmp_path / name, tone)
    back = read_sound(tmp_path / name)
    assert (back.rate, back.channels) == (44100, 1)
    assert back.frames == pytest.approx(tone.frames, abs=2400)
    middle = slice(4000, 16000)
    assert np.sqrt(np.mean(back.samples[middle] ** 2)) == pytest.approx(
        np.sqrt(np.mean(tone.samples[middle] ** 2)), rel=error
    )


@pytest.mark.parametrize("coding", ["PCM_U8", "PCM_24", "PCM_32", "FLOAT", "DOUBLE", "ULAW"])
def test_wav_files_of_all_codings_are_read(tmp_path, coding):
    samples = np.stack([np.linspace(-0.9, 0.9, 1000), np.zeros(1000)], axis=1)
    soundfile.write(tmp_path / "a.wav", samples, 22050, coding)
    sound = read_sound(tmp_path / "a.wav")
    assert sound.channels == 2 and sound.rate == 22050
    assert np.abs(sound.samples - samples).max() < (0.03 if coding in ("PCM_U8", "ULAW") else 1e-5)


def test_errors_name_the_file_and_what_is_wrong(tmp_path):
    (tmp_path / "text.wav").write_text("this is no sound")
    soundfile.write(tmp_path / "empty.wav", np.zeros((0, 1)), 48000)
    for name, word in (("missing.wav", "no such"), (".", "not a file"), ("text.wav", "cannot"), ("empty.wav", "0 fr")):
        with pytest.raises(SoundFileError, match=word) as caught:
            read_sound(tmp_path / name)
        assert str(tmp_path) in str(caught.value)


def test_unknown_endings_are_refused_with_the_known_ones(tmp_path):
    with pytest.raises(SoundFileError, match=r"\.wav, \.flac"):
        write_sound(tmp_path / "a.xyz", Sound(np.zeros(5)))


def test_a_long_ogg_can_be_written(tmp_path):
    long = Sound(np.zeros((300 * 8000, 2), np.float32), 8000)
    write_sound(tmp_path / "long.ogg", long)
    assert read_sound(tmp_path / "long.ogg").frames == long.frames
