"""Pictures on things: what is asked for is painted, and what cannot be painted is refused before."""

from __future__ import annotations

import pickle

import numpy as np
import pytest
import zxingcpp
from PIL import Image

from nao_sim_bridge.base.errors import BadValue, UnknownName
from nao_sim_bridge.world.painting.known_faces import load_faces
from nao_sim_bridge.world.painting.known_landmarks import load_landmarks
from nao_sim_bridge.world.pictures import ASPECTS, PATTERNS, POSTERS, WorldPicture, aspect, barcode, paint

EAN = "4006381333931"
KNOWN = {
    "landmark": list(map(str, load_landmarks().marks)),
    "face": list(load_faces()),
    "head": list(load_faces()),
    "poster": list(POSTERS),
    "pattern": list(PATTERNS),
    "qr": ["hello nao"],
    "barcode": [EAN, "code128:NAO-25"],
}


@pytest.mark.parametrize("kind", KNOWN)
def test_everything_that_is_known_can_be_painted(kind):
    for content in KNOWN[kind]:
        picture = paint(WorldPicture(kind, content))
        assert picture.dtype == np.uint8 and picture.shape[2] == 3 and not picture.flags.writeable
        assert 100 <= min(picture.shape[:2]) and max(picture.shape[:2]) <= 2048
        assert picture.std() > 5.0, "it is more than one colour"
        proportions = picture.shape[1] / picture.shape[0]
        assert aspect(WorldPicture(kind, content)) == pytest.approx(proportions)
        assert ASPECTS.get(kind, proportions) == pytest.approx(proportions)
        again = pickle.loads(pickle.dumps(WorldPicture(kind, content)))
        assert again == WorldPicture(kind, content) and paint(again) is picture, "painted once"


@pytest.mark.parametrize(
    "kind, content, text, form",
    [
        ("qr", "hello nao", "hello nao", "QRCode"),
        ("barcode", EAN, EAN, "EAN13"),
        ("barcode", EAN[:12], EAN, "EAN13"),
        ("barcode", "code128:NAO-25 b", "NAO-25 b", "Code128"),
    ],
)
def test_codes_can_be_read_again(kind, content, text, form):
    (code,) = zxingcpp.read_barcodes(paint(WorldPicture(kind, content)))
    assert (code.text, code.format) == (text, getattr(zxingcpp.BarcodeFormat, form))
    assert barcode("400638133393") == ("EAN13", EAN)


@pytest.mark.parametrize(
    "kind, content, message",
    [
        ("landmark", "65", "landmark is '65', allowed is one of 64, 68"),
        ("qr", "ü" * 151, "1 to 300 bytes"),
        ("barcode", "4006381333932", "check digit of this one would be 1"),
        ("file", "/nowhere.png", "a file that is there"),
    ],
)
def test_what_cannot_be_painted_is_refused(kind, content, message):
    with pytest.raises(BadValue, match=message):
        WorldPicture(kind, content)
    with pytest.raises(UnknownName, match="did you mean 'poster'"):
        WorldPicture("postr", "hills")


def test_a_file_is_shown_as_it_is_a_large_one_smaller_and_a_vanished_one_grey(tmp_path, caplog):
    small, large = tmp_path / "small.png", tmp_path / "large.jpg"
    Image.new("RGB", (30, 20), (200, 10, 10)).save(small)
    Image.new("RGB", (6000, 3000), (10, 200, 10)).save(large)
    assert paint(WorldPicture("file", str(small))).shape == (20, 30, 3)
    assert paint(WorldPicture("file", str(large))).shape[:2] == (1024, 2048)
    assert aspect(WorldPicture("file", str(large))) == pytest.approx(2.0)
    other = small.rename(tmp_path / "other.png")
    picture = WorldPicture("file", str(other))
    other.unlink()
    assert np.unique(paint(picture)).tolist() == [128]
    assert "a thing of the world is grey: picture file is" in caplog.text


def test_sectors_follow_clockwise_from_the_top():
    table, picture = load_landmarks(), paint(WorldPicture("landmark", "119"))
    middle = picture.shape[0] / 2.0
    radius = middle / (1.0 + table.margin)
    angles = [2.0 * np.pi * (sector + 0.5) / table.sectors for sector in range(table.sectors)]
    places = [(middle - 0.5 * radius * np.cos(a), middle + 0.5 * radius * np.sin(a)) for a in angles]
    assert tuple(bool(picture[int(row), int(column), 0] > 128) for row, column in places) == table.marks[119]
    assert picture[2, 2, 0] > 200, "the card is white"
    assert picture[int(middle - 0.9 * radius), int(middle), 0] < 60, "the rim is black"
