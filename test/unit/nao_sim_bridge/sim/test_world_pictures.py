"""Pictures on things: what is asked for is painted, and what cannot be painted is refused before."""

from __future__ import annotations

import pickle

import cv2
import numpy as np
import pytest
import zxingcpp
from PIL import Image

from nao_sim_bridge.sim.errors import BadValue, UnknownName
from nao_sim_bridge.sim.faces import load_faces
from nao_sim_bridge.sim.landmarks import load_landmarks
from nao_sim_bridge.sim.painting import names
from nao_sim_bridge.sim.painting.pattern import PATTERNS
from nao_sim_bridge.sim.painting.poster import DRAWINGS
from nao_sim_bridge.sim.world_pictures import ASPECTS, WorldPicture, aspect, barcode, paint

ALL = [
    *[("landmark", str(number)) for number in load_landmarks().marks],
    *[(kind, name) for kind in ("face", "head") for name in load_faces()],
    *[("poster", name) for name in names.POSTERS],
    *[("pattern", name) for name in names.PATTERNS],
    ("qr", "hello nao"),
    ("barcode", "4006381333931"),
    ("barcode", "code128:NAO-25"),
]


@pytest.mark.parametrize("kind, content", ALL)
def test_everything_that_is_known_can_be_painted(kind, content):
    picture = paint(WorldPicture(kind, content))
    assert picture.dtype == np.uint8 and picture.shape[2] == 3
    assert 100 <= min(picture.shape[:2]) and max(picture.shape[:2]) <= 2048
    assert picture.std() > 5.0, "it is more than one colour"
    if kind in ASPECTS:
        assert picture.shape[1] / picture.shape[0] == pytest.approx(ASPECTS[kind])
    assert aspect(WorldPicture(kind, content)) == pytest.approx(picture.shape[1] / picture.shape[0])


def test_the_names_of_posters_and_patterns_are_those_that_can_be_painted():
    assert set(names.POSTERS) == set(DRAWINGS)
    assert set(names.PATTERNS) == set(PATTERNS)


@pytest.mark.parametrize(
    "kind, content, text, form",
    [
        ("qr", "hello nao", "hello nao", "QRCode"),
        ("qr", "Grüße vom Roboter, 100 %", "Grüße vom Roboter, 100 %", "QRCode"),
        ("qr", "x" * 300, "x" * 300, "QRCode"),
        ("barcode", "4006381333931", "4006381333931", "EAN13"),
        ("barcode", "400638133393", "4006381333931", "EAN13"),
        ("barcode", "code128:NAO-25 b", "NAO-25 b", "Code128"),
    ],
)
def test_codes_can_be_read_again(kind, content, text, form):
    (code,) = zxingcpp.read_barcodes(paint(WorldPicture(kind, content)))
    assert (code.text, code.format) == (text, getattr(zxingcpp.BarcodeFormat, form))


@pytest.mark.parametrize(
    "kind, content, message",
    [
        ("landmark", "65", "landmark is '65', allowed is one of 64, 68"),
        ("qr", "", "1 to 300 bytes"),
        ("qr", "ü" * 151, "1 to 300 bytes"),
        ("barcode", "4006381333932", "check digit of this one would be 1"),
        ("barcode", "40063813339", "12 or 13 digits"),
        ("barcode", "code128:", "1 to 40 printable"),
        ("barcode", "code128:ä", "1 to 40 printable"),
        ("face", "nobody", "face is 'nobody', allowed is one of anna"),
        ("poster", "mona", "allowed is one of hills"),
        ("pattern", "gold", "allowed is one of oak"),
        ("file", "/nowhere.png", "a file that is there"),
    ],
)
def test_what_cannot_be_painted_is_refused(kind, content, message):
    with pytest.raises(BadValue, match=message):
        WorldPicture(kind, content)


def test_an_unknown_kind_is_refused():
    with pytest.raises(UnknownName, match="did you mean 'poster'"):
        WorldPicture("postr", "hills")


def test_a_short_article_number_gets_its_check_digit():
    assert barcode("400638133393") == ("EAN13", "4006381333931")


def test_a_file_is_shown_as_it_is_and_a_large_one_is_made_smaller(tmp_path):
    small, large = tmp_path / "small.png", tmp_path / "large.jpg"
    Image.new("RGB", (30, 20), (200, 10, 10)).save(small)
    Image.new("RGB", (6000, 3000), (10, 200, 10)).save(large)
    assert paint(WorldPicture("file", str(small))).shape == (20, 30, 3)
    assert paint(WorldPicture("file", str(large))).shape[:2] == (1024, 2048)
    assert aspect(WorldPicture("file", str(large))) == pytest.approx(2.0)


def test_a_file_that_is_no_picture_is_told(tmp_path):
    path = tmp_path / "text.png"
    path.write_text("no picture")
    with pytest.raises(BadValue, match="a picture: "):
        aspect(WorldPicture("file", str(path)))


def test_a_file_that_is_broken_inside_is_told(tmp_path):
    path = tmp_path / "broken.png"
    Image.fromarray(np.random.default_rng(1).integers(0, 255, (20, 30, 3), dtype=np.uint8)).save(path)
    content = path.read_bytes()
    length_at = content.index(b"IDAT") - 4
    path.write_bytes(content[:length_at] + (100).to_bytes(4, "big") + content[length_at + 4 :])
    with pytest.raises(BadValue, match="a picture: broken PNG file"):
        aspect(WorldPicture("file", str(path)))


def test_a_file_that_would_fill_the_memory_is_refused_before_it_is_unpacked(tmp_path):
    path = tmp_path / "bomb.png"
    Image.new("1", (8000, 8000)).save(path)
    assert path.stat().st_size < 100_000
    with pytest.raises(BadValue, match="a picture: it has 8000x8000 pixels, more than 50000000"):
        aspect(WorldPicture("file", str(path)))


def test_a_file_that_has_vanished_meanwhile_is_grey_and_nobody_goes_blind(tmp_path, caplog):
    path = tmp_path / "small.png"
    Image.new("RGB", (30, 20), (200, 10, 10)).save(path)
    picture = WorldPicture("file", str(path))
    path.unlink()
    assert np.unique(paint(picture)).tolist() == [128]
    assert "a thing of the world is grey: picture file is" in caplog.text


def test_a_picture_goes_to_another_process_and_is_painted_once():
    picture = WorldPicture("poster", "waves")
    assert pickle.loads(pickle.dumps(picture)) == picture
    assert paint(picture) is paint(WorldPicture("poster", "waves"))
    assert not paint(picture).flags.writeable


# --- landmarks --------------------------------------------------------------------------------------------------------


def turned(word, steps):
    return word[steps:] + word[:steps]


def difference(first, second):
    return sum(a != b for a, b in zip(first, second))


def test_marks_differ_in_four_sectors_in_any_rotation():
    table = load_landmarks()
    words = list(table.marks.values())
    assert len(words) == 18
    for index, word in enumerate(words):
        assert min(difference(word, turned(word, step)) for step in range(1, table.sectors)) >= 4
        for other in words[:index]:
            assert min(difference(word, turned(other, step)) for step in range(table.sectors)) >= 4


def test_sectors_follow_clockwise_from_the_top():
    table, picture = load_landmarks(), paint(WorldPicture("landmark", "119"))
    middle = picture.shape[0] / 2.0
    radius = middle / (1.0 + table.margin)
    read = []
    for sector in range(table.sectors):
        angle = 2.0 * np.pi * (sector + 0.5) / table.sectors
        column, row = middle + 0.5 * radius * np.sin(angle), middle - 0.5 * radius * np.cos(angle)
        read.append(bool(picture[int(row), int(column), 0] > 128))
    assert tuple(read) == table.marks[119]
    assert picture[2, 2, 0] > 200, "the card is white"
    assert picture[int(middle - 0.9 * radius), int(middle), 0] < 60, "the rim is black"


# --- faces ------------------------------------------------------------------------------------------------------------


def seen(picture, width):
    """A card in a grey room, `width` pixels wide, in a picture of 320x240."""
    height = round(width * picture.shape[0] / picture.shape[1])
    room = np.full((240, 320), 150, np.uint8)
    top, left = (240 - height) // 2, (320 - width) // 2
    small = cv2.resize(cv2.cvtColor(picture, cv2.COLOR_RGB2GRAY), (width, height), interpolation=cv2.INTER_AREA)
    room[top : top + height, left : left + width] = small
    return room


@pytest.mark.parametrize("name", load_faces())
@pytest.mark.parametrize("width", [48, 80, 140])
def test_a_detector_of_faces_finds_everybody(name, width):
    detector = cv2.CascadeClassifier(cv2.data.haarcascades + "haarcascade_frontalface_alt2.xml")
    found = detector.detectMultiScale(seen(paint(WorldPicture("face", name)), width), 1.1, 3, minSize=(20, 20))
    head = width * 2.0 / 3.0
    x, _, w, _ = min(found, key=lambda box: abs(box[2] - head))
    assert x + w / 2.0 == pytest.approx(160.0, abs=width * 0.1)
    assert 0.7 * head < w < 1.5 * head


def test_no_two_people_look_alike():
    small = {
        name: cv2.resize(cv2.cvtColor(paint(WorldPicture("head", name)), cv2.COLOR_RGB2GRAY), (32, 46)).astype(float)
        for name in load_faces()
    }
    normal = {name: (face - face.mean()) / face.std() for name, face in small.items()}
    for first in normal:
        for second in normal:
            if first < second:
                assert np.mean(normal[first] * normal[second]) < 0.9, (first, second)
