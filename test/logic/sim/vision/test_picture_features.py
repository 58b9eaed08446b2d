"""Pictures that are recognised in drawn views: at another size, turned, tilted, one among others."""

import math

import cv2
import numpy as np
import pytest
from seen_cards import OPTICS

from nao_sim_bridge.base.config import config_file
from nao_sim_bridge.vision.picture_features import PictureDetector
from nao_sim_bridge.vision.picture_memory import KnownPicture, PictureFileError, load, save
from nao_sim_bridge.world.painting.poster import paint_poster

CORNERS = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], np.float32)


def poster(name):
    return np.ascontiguousarray(paint_poster(name)[..., ::-1])


def view(picture, places):
    """A grey wall of 320 x 240 with a picture whose corners are at places in it, px."""
    width, height = 128, 171
    picture = cv2.resize(picture, (width, height), interpolation=cv2.INTER_AREA)
    plane = cv2.getPerspectiveTransform(CORNERS * np.array((width, height), np.float32), np.array(places, np.float32))
    wall = np.full((240, 320, 3), 140, np.uint8)
    small = cv2.warpPerspective(
        picture, plane, (320, 240), dst=wall, borderMode=cv2.BORDER_TRANSPARENT, flags=cv2.INTER_AREA
    )
    return cv2.GaussianBlur(small, (0, 0), 0.6)


@pytest.fixture(scope="module")
def learnt():
    return {name: PictureDetector().learn(poster(name), True) for name in ("city", "planets")}


@pytest.fixture(scope="module")
def detector(learnt):
    return PictureDetector(list(learnt.values()))


def turned(angle, middle=(160, 120), width=90, height=120):
    """Corners of a picture that is turned in the view."""
    c, s = math.cos(angle), math.sin(angle)
    sides = [(x * width, y * height) for x, y in CORNERS - 0.5]
    return [(middle[0] + c * x - s * y, middle[1] + s * x + c * y) for x, y in sides]


WAYS = {
    "facing": turned(0.0, (140, 120), 96, 128),
    "tilted": [(100, 50), (190, 70), (190, 170), (100, 190)],
    "turned": turned(0.6),
}


@pytest.mark.parametrize("name, number", [("city", 0), ("planets", 1)])
@pytest.mark.parametrize("way", WAYS)
def test_it_is_found_with_its_outline_wherever_it_is(detector, name, number, way):
    (seen,) = detector.detect(view(poster(name), WAYS[way]), OPTICS, 10)
    assert seen.number == number and 8 <= seen.found and 0.0 < seen.share <= 1.0
    wanted = [OPTICS.angles(x / 320, y / 240) for x, y in WAYS[way]]
    assert np.array(seen.outline) == pytest.approx(np.array(wanted), abs=math.radians(3.0))


def test_others_are_not_found_and_of_several_the_most_certain_are_told(detector):
    assert detector.detect(view(poster("leaves"), WAYS["facing"]), OPTICS, 10) == []
    assert PictureDetector().detect(view(poster("city"), WAYS["facing"]), OPTICS, 10) == []
    both = view(poster("city"), turned(0.0, (80, 120), 105, 140))
    both[:, 160:] = view(poster("planets"), turned(0.0, (240, 120), 105, 140))[:, 160:]
    seen = detector.detect(both, OPTICS, 10)
    assert {one.number for one in seen} == {0, 1} and detector.detect(both, OPTICS, 1) == seen[:1]


def test_what_has_no_texture_cannot_be_learnt_and_a_thing_may_stand_out_from_its_background():
    learn = PictureDetector().learn
    plain = np.full((240, 320, 3), 90, np.uint8)
    assert learn(plain, True) is None and learn(plain, False) is None
    cover = cv2.resize(poster("city"), (160, 100), interpolation=cv2.INTER_AREA)
    plain[70:170, 80:240] = cover
    found = learn(plain, False)
    assert sorted(map(tuple, found.outline.round())) == pytest.approx(
        [(80, 70), (80, 169), (239, 70), (239, 169)], abs=3
    )
    assert found.points[:, 0].min() > 75 and found.points[:, 0].max() < 245


def test_a_database_survives_in_its_file_and_other_files_are_none(learnt, tmp_path):
    pictures = (KnownPicture(("town", "my wall"), "city.png", learnt["city"]),)
    save(pictures, tmp_path / "known.npz")
    (again,) = load(tmp_path / "known.npz")
    assert (again.labels, again.file) == (("town", "my wall"), "city.png")
    assert all(
        np.array_equal(getattr(again.features, part), getattr(learnt["city"], part)) for part in vars(again.features)
    )
    save((), tmp_path / "none.npz")
    assert load(tmp_path / "none.npz") == ()
    with pytest.raises(PictureFileError, match="is no file of learnt pictures"):
        load(config_file("faces.json"))
