"""Closest names to a mistyped one."""

from __future__ import annotations

import pytest

from nao_library_modules.suggestion import closest, did_you_mean

KNOWN = ["setIntensity", "setColor", "getColor", "LeftFaceLeds", "LeftFaceLed1"]


@pytest.mark.parametrize(
    "typed, best", [("setColour", "setColor"), ("SETCOLOR", "setColor"), ("LeftFaceLed", "LeftFaceLeds")]
)
def test_the_closest_name_comes_first(typed, best):
    assert closest(typed, KNOWN)[0] == best


def test_names_that_look_like_nothing_get_no_suggestion():
    assert closest("zzz", KNOWN) == []
    assert did_you_mean("zzz", KNOWN) == ""


def test_equally_close_names_keep_their_order():
    assert closest("Led", ["Leds", "Led2", "Led1", "Other"]) == ["Leds", "Led2", "Led1"]


@pytest.mark.parametrize(
    "typed, known, best",
    [
        ("FaceLed", [*(f"FaceLed{n}" for n in range(8)), "FaceLeds"], "FaceLeds"),
        ("Brain", ["Brain0", "BrainX", "Brain1"], "BrainX"),
        ("FaceLed9", ["FaceLeds", "FaceLed1"], "FaceLed1"),
        ("gaze", ["maze", "gate"], "gate"),
    ],
)
def test_of_equally_close_names_one_of_many_comes_last_then_the_beginning_counts(typed, known, best):
    assert closest(typed, known)[0] == best


def test_no_more_names_than_asked_for():
    assert len(closest("getColor", KNOWN, count=1)) == 1


def test_text_quotes_the_names():
    assert did_you_mean("LeftFaceLed", ["LeftFaceLeds"]) == ": did you mean 'LeftFaceLeds'?"
