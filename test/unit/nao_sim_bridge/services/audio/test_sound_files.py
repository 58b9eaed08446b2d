"""Sound files of all kinds are read; what is no sound is named."""

from __future__ import annotations

import numpy as np
import pytest
import soundfile

from nao_sim_bridge.record_dir import ClientFiles
from nao_sim_bridge.services.audio import sound_files
from nao_sim_bridge.services.audio.sound_files import read_client_file
from nao_sim_bridge.services.errors import NaoqiError


@pytest.fixture
def files(tmp_path):
    return ClientFiles(tmp_path)


def tone(rate, channels):
    time = np.arange(rate) / rate
    return np.stack([0.5 * np.sin(2.0 * np.pi * 440.0 * (side + 1) * time) for side in range(channels)], axis=1)


@pytest.mark.parametrize(
    "name, rate, channels, options",
    [
        ("a.wav", 48000, 1, {}),
        ("a.wav", 44100, 2, {}),
        ("a.wav", 8000, 1, {"subtype": "PCM_U8"}),
        ("a.wav", 22050, 2, {"subtype": "PCM_24"}),
        ("a.wav", 16000, 1, {"subtype": "FLOAT"}),
        ("a.wav", 96000, 4, {}),
        ("a.ogg", 44100, 2, {}),
        ("a.ogg", 16000, 1, {"subtype": "OPUS"}),
        ("a.flac", 48000, 2, {"subtype": "PCM_24"}),
        ("a.mp3", 44100, 2, {}),
        ("A.MP3", 16000, 1, {}),
    ],
)
def test_all_kinds_come_at_the_rate_of_the_world(files, tmp_path, name, rate, channels, options):
    soundfile.write(str(tmp_path / name), tone(rate, channels), rate, **options)
    sound = read_client_file(files, name)
    assert (sound.rate, sound.channels) == (48000, channels)
    assert sound.duration == pytest.approx(1.0, abs=0.08 if name.lower().endswith("mp3") else 1e-3)
    middle = sound.samples[12000:36000]
    for side in range(channels):
        spectrum = np.abs(np.fft.rfft(middle[:, side] * np.hanning(len(middle))))
        assert np.argmax(spectrum) * 2.0 == pytest.approx(440.0 * (side + 1), abs=2.0)
        assert np.sqrt(np.mean(middle[:, side] ** 2)) == pytest.approx(0.3536, rel=0.03)


def test_what_cannot_be_read_is_named(files, tmp_path):
    (tmp_path / "text.wav").write_text("this is no sound")
    (tmp_path / "nothing.wav").write_bytes(b"")
    (tmp_path / "folder.wav").mkdir()
    soundfile.write(str(tmp_path / "silent.wav"), np.zeros((0, 1)), 48000)
    for name, message in [
        ("text.wav", "'text.wav' cannot be read as sound .*; allowed are wav, ogg, flac and mp3"),
        ("nothing.wav", "'nothing.wav' cannot be read as sound"),
        ("silent.wav", "'silent.wav' cannot be played: .*holds no sound"),
    ]:
        with pytest.raises(NaoqiError, match=message) as error:
            read_client_file(files, name)
        assert str(tmp_path) not in str(error.value)
    with pytest.raises(ValueError, match="'folder.wav' is a folder, not a file"):
        read_client_file(files, "folder.wav")
    with pytest.raises(ValueError, match="no file 'missing.wav'"):
        read_client_file(files, "missing.wav")


def test_a_file_that_was_cut_off_is_played_as_far_as_it_goes(files, tmp_path):
    path = tmp_path / "cut.wav"
    soundfile.write(str(path), tone(48000, 1), 48000)
    path.write_bytes(path.read_bytes()[: 44 + 48000])
    assert read_client_file(files, "cut.wav").frames == 24000


def test_very_long_files_are_refused(files, tmp_path, monkeypatch):
    monkeypatch.setattr(sound_files, "LONGEST", 0.5)
    soundfile.write(str(tmp_path / "long.wav"), tone(48000, 1), 48000)
    with pytest.raises(NaoqiError, match="'long.wav' is 1 s long, allowed are 0 s"):
        read_client_file(files, "long.wav")
