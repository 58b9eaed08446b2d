"""Records of walks: footprints, centre of pressure, files, and the picture."""

from __future__ import annotations

import json
import math

import pytest

from nao_library_modules.walk_picture import FILLS, MASS, PRESSURE, SOLE, draw, outline
from nao_library_modules.walk_record import LEFT, RIGHT, Sample, WalkRecordError, footprints, load, save


def sample(left=0.0, right=0.0, loads=(2.5, 2.5), planned=("", (0.0, 0.0, 0.0))):
    """Feet at these distances ahead, 0.1 m apart; the centre of mass between them."""
    mass = ((left + right) / 2.0, 0.0)
    return Sample((left, 0.05, 0.0), (right, -0.05, 0.0), mass, loads, ((0.02, 0.0), (0.02, 0.0)), planned)


# The right foot swings 8 cm ahead, then the left one to its side.
WALK = [
    sample(),
    sample(right=0.04, loads=(5.0, 0.0), planned=(RIGHT, (0.081, -0.05, 0.0))),
    sample(right=0.08, loads=(4.5, 0.5)),
    sample(right=0.079, loads=(2.5, 2.5)),
    sample(right=0.08, loads=(0.1, 4.9)),
    sample(left=0.05, right=0.08, loads=(0.0, 5.0), planned=(LEFT, (0.082, 0.05, 0.0))),
    sample(left=0.08, right=0.08),
]


def test_feet_in_the_air_leave_no_prints():
    prints = footprints(WALK)
    assert [(each.foot, each.place[0]) for each in prints] == [(LEFT, 0.0), (RIGHT, 0.0), (RIGHT, 0.08), (LEFT, 0.08)]
    assert [each.planned and each.planned[0] for each in prints] == [None, None, 0.081, 0.082]


def test_a_turn_on_the_spot_is_a_step():
    turned = Sample((0.0, 0.05, 0.3), (0.0, -0.05, 0.0), (0.0, 0.0), (2.5, 2.5), ((0.0, 0.0), (0.0, 0.0)))
    assert [each.foot for each in footprints([sample(), turned])] == [LEFT, RIGHT, LEFT]


@pytest.mark.parametrize(
    "loads, pressure", [((5.0, 0.0), (0.02, 0.05)), ((2.5, 2.5), (0.02, 0.0)), ((1.0, 3.0), (0.02, -0.025))]
)
def test_the_pressure_of_both_feet_is_weighed_by_what_they_carry(loads, pressure):
    assert sample(loads=loads).pressure == pytest.approx(pressure)


def test_a_robot_in_the_air_has_no_pressure():
    assert sample(loads=(0.0, 0.0)).pressure is None


def test_a_record_comes_back_as_it_was(tmp_path):
    path = tmp_path / "walk.json"
    save(WALK, path)
    assert load(path) == WALK


@pytest.mark.parametrize(
    "text, problem",
    [
        ("", "cannot be read"),
        ("[]", "format"),
        (json.dumps({"format": "nao_walk_record"}), "samples"),
        (json.dumps({"format": "nao_walk_record", "samples": [{"left": [0, 0]}]}), "wrong"),
    ],
)
def test_a_file_that_is_no_record_is_refused(tmp_path, text, problem):
    path = tmp_path / "other.json"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(WalkRecordError, match=problem) as raised:
        load(path)
    assert "other.json" in str(raised.value)


def test_the_picture_is_to_scale_and_shows_everything():
    picture = draw(WALK)
    pixels = list(picture.getdata())
    for color in (*FILLS.values(), MASS, PRESSURE):
        assert color in pixels, color
    # The soles cover what they cover on the ground, at equal scale in both directions.
    columns = [i % picture.width for i, pixel in enumerate(pixels[: picture.width * 300]) if pixel == FILLS[LEFT]]
    rows = [i // picture.width for i, pixel in enumerate(pixels) if pixel == FILLS[LEFT]]
    length, breadth = max(columns) - min(columns), max(rows) - min(rows)
    xs, ys = zip(*SOLE)
    assert length / breadth == pytest.approx((max(xs) - min(xs) + 0.08) / (max(ys) - min(ys)), rel=0.1)


def test_soles_are_mirror_images_that_turn_with_the_foot():
    left, right = outline(LEFT, (0.0, 0.0, 0.0)), outline(RIGHT, (0.0, 0.0, 0.0))
    assert [(x, -y) for x, y in left] == right
    turned = outline(LEFT, (1.0, 2.0, math.pi / 2.0))
    assert turned == [pytest.approx((1.0 - y, 2.0 + x)) for x, y in left]


def test_nothing_cannot_be_drawn():
    with pytest.raises(ValueError, match="without a sample"):
        draw([])
