"""The largest blob of a colour in drawn pictures."""

import math

import cv2
import numpy as np
import pytest
from seen_cards import OPTICS

from nao_sim_bridge.vision.color_blob import BlobSettings, ColorBlobDetector

GREEN = (20, 180, 60)
ROUND, ANY = (BlobSettings(GREEN, 40, 50, only_round) for only_round in (True, False))


@pytest.fixture
def picture():
    """A green disc, a longer and larger green bar, a red disc."""
    image = np.full((240, 320, 3), 128, np.uint8)
    cv2.circle(image, (80, 120), 20, GREEN[::-1], -1)
    cv2.rectangle(image, (160, 200), (300, 215), (70, 170, 10), -1)
    cv2.circle(image, (240, 60), 30, (0, 0, 220), -1)
    return image


def test_the_largest_one_counts_unless_it_has_to_be_round(picture):
    detect = ColorBlobDetector().detect
    bar, disc = (detect(picture, OPTICS, settings) for settings in (ANY, ROUND))
    assert (bar.x, bar.y) == pytest.approx((230.5 / 320, 208 / 240), abs=0.005)
    assert (disc.x * 320, disc.y * 240, disc.radius * 320) == pytest.approx((80.5, 120.5, 20.5), abs=0.7)
    assert (disc.alpha, disc.beta) == pytest.approx(OPTICS.angles(disc.x, disc.y))
    edges = [OPTICS.angles(x / 320, 0.5)[0] for x in (60, 101)]
    assert 2.0 * disc.angle == pytest.approx(edges[0] - edges[1], abs=0.004)


def test_nothing_is_found_of_another_colour_too_small_or_before_a_colour_is_told(picture):
    detect = ColorBlobDetector().detect
    assert detect(picture, OPTICS, None) is None
    assert detect(picture, OPTICS, BlobSettings((20, 60, 180), 40, 50, False)) is None
    assert detect(picture, OPTICS, BlobSettings(GREEN, 40, 5000, False)) is None
    assert detect(picture, OPTICS, BlobSettings(GREEN, 2, 50, False)).radius * 320 == pytest.approx(20.5, abs=0.7)
    assert math.isfinite(detect(np.full((120, 160, 3), GREEN[::-1], np.uint8), OPTICS, ANY).angle)
