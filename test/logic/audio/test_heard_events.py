"""What the events of the robot's hearing say."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from nao_library_modules.audio_in.hearing import Bearing, begun_sounds, located_sound, recognised, turned

LEVEL = [0.0] * 6


def located(azimuth, elevation, head=LEVEL, confidence=0.5, energy=0.2):
    return [[12, 340000], [azimuth, elevation, confidence, energy], LEVEL, list(head)]


def test_left_and_up_are_positive():
    vectors = {(0.0, 0.0): (1, 0, 0), (math.pi / 2, 0.0): (0, 1, 0), (0.0, math.pi / 2): (0, 0, 1)}
    for bearing, vector in vectors.items():
        assert Bearing(*bearing).vector == pytest.approx(vector, abs=1e-12)
    back = Bearing.of(tuple(3.0 * part for part in Bearing(-1.9, 0.7).vector))
    assert (back.azimuth, back.elevation) == pytest.approx((-1.9, 0.7))


def test_turns_are_right_handed_and_the_one_about_z_comes_last():
    down = (0.0, math.pi / 2, 1.0)  # pitched down, ahead is below; then a turn to the left leaves it there
    for angles, x in [((0, 0, math.pi / 2), (0, 1, 0)), (down, (0, 0, -1)), ((math.pi / 2, 0, 0), (1, 0, 0))]:
        assert turned((1.0, 0.0, 0.0), angles) == pytest.approx(x, abs=1e-12)
    assert turned((0.0, 1.0, 0.0), (math.pi / 2, 0, 0)) == pytest.approx((0, 0, 1), abs=1e-12)


@given(st.floats(-1.5, 1.5), st.floats(-1.5, 1.5))
def test_a_head_that_is_turned_hears_the_same_place_elsewhere(yaw, azimuth):
    sound = located_sound(located(azimuth, 0.0, head=[0.0, 0.1, 0.45, 0.0, 0.0, yaw]))
    assert sound.in_head == Bearing(azimuth, 0.0)
    assert (sound.in_base.azimuth, sound.in_base.elevation) == pytest.approx((azimuth + yaw, 0.0), abs=1e-9)
    down = located_sound(located(0.0, 0.5, head=[0, 0, 0.4, 0, 0.5, 0]))
    assert (down.in_base.azimuth, down.in_base.elevation) == pytest.approx((0.0, 0.0))
    assert (sound.head, sound.confidence, sound.energy) == ((0.0, 0.1, 0.45), 0.5, 0.2)


def test_only_the_begin_of_a_sound_counts():
    two = [[12, 0, 0.8, 5], [90, 1, 0.4, 9]]
    rows = [([[12, 1, 0.8, 5]], [0.8]), ([[12, 0, 0.8, 5]], []), (two, [0.4]), ([12, 1, 0.7, 5], [0.7]), ([], [])]
    for value, confidences in rows:
        assert [sound.confidence for sound in begun_sounds(value)] == confidences
    assert [sound.time for sound in begun_sounds([[90, 1, 0.4, 9000000], [3, 1, 0.2]])] == [9.0, 0.0]
    with pytest.raises(ValueError, match="no sounds that were detected"):
        begun_sounds([[1]])


def test_words_are_bare_and_a_reset_is_none():
    assert recognised(["yes", 0.6, "no", 0.2]) == [("yes", 0.6), ("no", 0.2)]
    assert recognised(["<...> stand up <...>", 0.5]) == [("stand up", 0.5)]
    for nothing in ([], None, ["", -3.0], ["<...>", 0.0]):
        assert recognised(nothing) == []
    for wrong in (["yes"], ["yes", "loud"], [3, 0.5], 7):
        with pytest.raises(ValueError, match="no words that were recognised"):
            recognised(wrong)
