"""Records of dialogues, and the picture of a sound."""

from __future__ import annotations

import importlib.util
import json
import sys
from pathlib import Path

import numpy as np
import pytest
import soundfile
from PIL import Image

from nao_library_modules.dialogue_record import DOES, HEARS, PERSON, ROBOT, SAYS, DialogueRecordError, Turn, load, save
from nao_library_modules.sound_picture import (
    FILLS,
    GAP,
    LANE_HEIGHT,
    LEAST_WAVE_HEIGHT,
    LEFT,
    PANEL,
    TOP,
    WAVE,
    WAVE_HEIGHT,
    WIDTH,
    draw,
    spectrogram,
)

PACKAGE = Path(__file__).parents[3] / "nao_library_modules"
RATE = 16000
TURNS = [
    Turn(ROBOT, SAYS, "Shall we play?", 0.5, 1.0),
    Turn(PERSON, SAYS, "Yes!", 1.5, 2.0),
    Turn(ROBOT, HEARS, "yes", 2.5, 2.5, 0.91),
    Turn(ROBOT, DOES, "nods", 3.0, 3.5),
]


def tone(frequency, begin, end, seconds=4.0, rate=RATE):
    """A tone of half of full scale between two times."""
    times = np.arange(int(seconds * rate)) / rate
    return np.where((times >= begin) & (times < end), 0.5 * np.sin(2.0 * np.pi * frequency * times), 0.0)


def darkest(picture):
    """Column and row of the middle of what is darkest, as shares of the picture."""
    shade = np.asarray(picture.convert("L")).astype(float)
    rows, columns = np.nonzero(shade <= shade.min() + 20.0)
    return columns.mean() / picture.size[0], rows.mean() / picture.size[1]


def colored(picture, color):
    """Columns and rows of the pixels of a color."""
    rows, columns = np.nonzero((np.asarray(picture) == color).all(axis=-1))
    return columns, rows


@pytest.mark.parametrize("frequency, begin, end, rate", [(1000.0, 1.0, 2.0, RATE), (6000.0, 3.0, 4.0, 48000)])
def test_a_tone_is_where_its_time_and_its_frequency_are(frequency, begin, end, rate):
    sound = tone(frequency, begin, end, rate=rate)[:, np.newaxis]
    column, row = darkest(spectrogram(sound, rate, (400, 200)))
    assert column == pytest.approx((begin + end) / 2.0 / 4.0, abs=0.02)
    assert row == pytest.approx(1.0 - frequency / 8000.0, abs=0.02)


@pytest.mark.parametrize("channels", [1, 4])
def test_each_channel_has_its_waveform(channels):
    sound = np.stack([tone(500.0, channel, channel + 1.0) for channel in range(channels)], axis=1)
    columns, rows = colored(draw(sound, RATE), WAVE)
    edges = [TOP + channel * (max(LEAST_WAVE_HEIGHT, WAVE_HEIGHT // channels) + GAP) for channel in range(channels + 1)]
    for channel in range(channels):
        there = rows[columns == LEFT + PANEL * (2 * channel + 1) // 8]
        pixels, _ = np.histogram(there, edges)
        assert np.argmax(pixels) == channel and pixels[channel] > 40
        assert sum(pixels) == pixels[channel] + channels - 1  # of the others their zero lines


def test_words_stand_below_the_time_at_which_they_were_said():
    sound = tone(500.0, 0.0, 4.0)
    picture, bare = draw(sound, RATE, TURNS), draw(sound, RATE)
    assert picture.size[1] - bare.size[1] == 4 * LANE_HEIGHT
    columns, rows = colored(picture, FILLS[PERSON])
    edges = [(x - LEFT) / PANEL * 4.0 for x in (columns.min(), columns.max())]
    assert edges == pytest.approx([1.5, 2.0], abs=0.02)
    assert rows.min() > bare.size[1] - TOP
    with pytest.raises(ValueError, match="1 to 4 channels"):
        draw(np.zeros((100, 5)), RATE)


def test_a_record_comes_back_as_it_was_and_one_that_is_wrong_is_refused(tmp_path):
    path = tmp_path / "a.json"
    save(TURNS, path)
    assert load(path) == TURNS
    good = json.loads(path.read_text())
    for change, told in [
        ({"who": "cat"}, "'cat' 'says'"),
        ({"ended": 0.0}, "from 0.5 s to 0.0 s"),
    ]:
        first, *rest = good["turns"]
        path.write_text(json.dumps({**good, "turns": [{**first, **change}, *rest]}))
        with pytest.raises(DialogueRecordError, match=f"a.json: has a turn that is wrong: .*{told}"):
            load(path)
    for text, told in [("{", "cannot be read"), ("[]", "is no record"), ('{"format": "x"}', "is no")]:
        path.write_text(text)
        with pytest.raises(DialogueRecordError, match=f"a.json: {told}"):
            load(path)


def test_the_example_draws_a_file_with_words_or_tells_what_is_wrong(tmp_path, monkeypatch, capsys):
    spec = importlib.util.spec_from_file_location("plot_sound", PACKAGE / "examples" / "plot_sound.py")
    example = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(example)
    sound, words, output = (tmp_path / name for name in ("a.wav", "a.json", "a.png"))
    soundfile.write(str(sound), np.stack([tone(500.0, 1.0, 2.0)] * 4, axis=1), RATE)
    save(TURNS, words)
    (tmp_path / "no.wav").write_text("nothing")

    def run(*options):
        monkeypatch.setattr(sys, "argv", ["plot_sound.py", *map(str, options), "--output", str(output)])
        return example.main(), capsys.readouterr().out

    missing = [sound, "--words", tmp_path / "missing.json"]
    for options, told in [([tmp_path / "no.wav"], "no.wav"), (missing, "cannot be read")]:
        status, printed = run(*options)
        assert status == 1 and told in printed and not output.exists()
    status, printed = run(sound, "--words", words)
    assert status == 0 and "see " in printed and output.stat().st_size < 150_000
    with Image.open(output) as picture:
        assert picture.size[0] == WIDTH
