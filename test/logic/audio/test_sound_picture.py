"""Records of dialogues, and the picture of a sound."""

from __future__ import annotations

import json

import numpy as np
import pytest

from example_parts.dialogue_record import (
    DOES,
    HEARS,
    PERSON,
    ROBOT,
    SAYS,
    Turn,
    load,
    save,
)
from example_parts.record_file import RecordError
from example_parts.sound_picture import spectrogram

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


@pytest.mark.parametrize("frequency, begin, end, rate", [(1000.0, 1.0, 2.0, RATE), (6000.0, 3.0, 4.0, 48000)])
def test_a_tone_is_where_its_time_and_its_frequency_are(frequency, begin, end, rate):
    sound = tone(frequency, begin, end, rate=rate)[:, np.newaxis]
    column, row = darkest(spectrogram(sound, rate, (400, 200)))
    assert column == pytest.approx((begin + end) / 2.0 / 4.0, abs=0.02)
    assert row == pytest.approx(1.0 - frequency / 8000.0, abs=0.02)


def test_a_record_comes_back_as_it_was_and_one_that_is_wrong_is_refused(tmp_path):
    path = tmp_path / "a.json"
    save(TURNS, path)
    assert load(path) == TURNS
    good = json.loads(path.read_text())
    for change, told in [({"who": "cat"}, "'cat' 'says'"), ({"ended": 0.0}, "from 0.5 s to 0.0 s")]:
        first, *rest = good["turns"]
        path.write_text(json.dumps({**good, "turns": [{**first, **change}, *rest]}))
        with pytest.raises(RecordError, match=f"a.json: has a turn that is wrong: .*{told}"):
            load(path)
    for text, told in [("{", "cannot be read"), ("[]", "is no record"), ('{"format": "x"}', "is no")]:
        path.write_text(text)
        with pytest.raises(RecordError, match=f"a.json: {told}"):
            load(path)
