"""Pictures of a film, side by side."""

from __future__ import annotations

from fractions import Fraction

import av
import numpy as np
import pytest
from PIL import Image

from nao_library_modules.contact_sheet import BAND, MOMENTS, Part, contact_sheet, frames_at, save_small

RATE, SECONDS, SIDE = 10, 6, 64


@pytest.fixture
def film(tmp_path):
    """A film that gets brighter: at time t its grey is 40 t."""
    path = tmp_path / "film.mp4"
    with av.open(str(path), "w") as container:
        stream = container.add_stream("mpeg4", rate=RATE)
        stream.width = stream.height = SIDE
        stream.pix_fmt, stream.bit_rate = "yuv420p", 2_000_000
        for number in range(RATE * SECONDS):
            grey = np.full((SIDE, SIDE, 3), 40.0 * number / RATE, np.uint8)
            frame = av.VideoFrame.from_ndarray(grey, format="rgb24")
            frame.pts, frame.time_base = number, Fraction(1, RATE)
            container.mux(stream.encode(frame))
        container.mux(stream.encode(None))
    return path


def grey(picture):
    return float(np.asarray(picture).mean())


def test_moments_are_spread_over_the_part():
    assert Part("a", 2.0, 5.0).moments(3) == [2.5, 3.5, 4.5]


def test_pictures_are_those_of_their_times_in_any_order(film):
    found = [grey(picture) for picture in frames_at(film, [3.05, 1.05, 99.0])]
    assert found == pytest.approx([120.0, 40.0, 236.0], abs=6.0)


def test_a_sheet_has_a_strip_for_each_part(film):
    sheet = contact_sheet(film, [Part("dark", 0.0, 3.0), Part("bright", 3.0, 6.0)], side=32)
    assert sheet.size == (MOMENTS * 32, 2 * (32 + BAND))
    dark = sheet.crop((0, BAND, sheet.width, BAND + 32))
    bright = sheet.crop((0, 2 * BAND + 32, sheet.width, sheet.height))
    assert grey(dark) == pytest.approx(60.0, abs=8.0) and grey(bright) == pytest.approx(180.0, abs=8.0)
    name = np.asarray(sheet.crop((0, 0, sheet.width, BAND)).convert("L"))
    assert name.min() < 80 and name.max() == 255  # something is written there


def test_strips_can_stand_side_by_side(film):
    parts = [Part(str(place), place, place + 1.0) for place in range(3)]
    assert contact_sheet(film, parts, side=32, columns=2).size == (2 * MOMENTS * 32 + BAND, 2 * (32 + BAND))


def test_the_middle_of_pictures_is_enough(film):
    assert contact_sheet(film, [Part("all", 0.0, 6.0)], side=32, share=0.5).size == (MOMENTS * 16, 32 + BAND)


def test_a_small_sheet_has_few_colours(film, tmp_path):
    save_small(contact_sheet(film, [Part("all", 0.0, 6.0)], side=32), tmp_path / "sheet.png")
    assert Image.open(tmp_path / "sheet.png").mode == "P"


def test_a_film_without_pictures_is_told(tmp_path):
    path = tmp_path / "empty.wav"
    with av.open(str(path), "w") as container:
        stream = container.add_stream("pcm_s16le", rate=8000)
        stream.layout = "mono"
        frame = av.AudioFrame.from_ndarray(np.zeros((1, 800), np.int16), format="s16", layout="mono")
        frame.sample_rate = 8000
        container.mux(stream.encode(frame))
    with pytest.raises((ValueError, IndexError)):
        frames_at(path, [0.0])
