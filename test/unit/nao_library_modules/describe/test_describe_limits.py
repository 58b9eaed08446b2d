"""What the words of refusals allow."""

import math

import pytest

from nao_library_modules.describe_limits import limits, told_by, words


@pytest.mark.parametrize(
    "text, low, high",
    [
        ("0..1", 0, 1),
        ("a whole number 0..100 (%)", 0, 100),
        ("-1 (left) .. 1 (right)", -1, 1),
        ("50..400 %, or 0 for the robot's own", 0, 400),
        ("above 0 to 3600 s", 0, 3600),
        ("up to 3600 s, or 0 for the default", 0, 3600),
        ("0 s or more", 0, math.nan),
        ("more than 0 s", 0, math.nan),
        ("the name of a file", math.nan, math.nan),
        ("one of 16000, 22050 (Hz)", math.nan, math.nan),
    ],
)
def test_limits_are_read_from_words(text, low, high):
    assert limits(text) == pytest.approx((low, high), nan_ok=True)


@pytest.mark.parametrize(
    "text, expected",
    [
        ("one of a, b", ("a", "b")),
        ("'#RRGGBB' or one of red, green", ("red", "green")),
        ("for each step one of LLeg, RLeg", ("LLeg", "RLeg")),
        ("one of Left Arm, b", ()),
        ("anything", ()),
    ],
)
def test_words_are_read_from_lists(text, expected):
    assert words(text) == expected


def test_several_refusals_of_a_field_are_told_together():
    told = told_by(["at least one", "0..1", "one of a, b"])
    assert told.text == "at least one; 0..1; one of a, b"
    assert (told.minimum, told.maximum, told.choices) == (0.0, 1.0, ("a", "b"))
