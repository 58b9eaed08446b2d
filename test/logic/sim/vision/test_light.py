"""How dark and how backlit pictures are, by their luminance."""

import numpy as np
import pytest
from seen_cards import OPTICS

from nao_sim_bridge.vision.light import BACKLIT, NOT_BACKLIT, POSSIBLY_BACKLIT, BacklightingDetector, DarknessDetector


def grey(*levels):
    """A picture of rows of these levels, equally many of each."""
    rows = np.repeat(np.array(levels, np.uint8), 120 // len(levels))
    return np.tile(rows[:, None, None], (1, 160, 3))


@pytest.mark.parametrize(
    "picture, exposed, darkness",
    [((255,), 1.0, 0), ((130,), 1.0, 0), ((55,), 1.0, 50), ((110,), 2.5, 60), ((0,), 9, 100)],
)
def test_a_place_is_as_dark_as_its_picture_less_what_the_exposure_adds(picture, exposed, darkness):
    assert DarknessDetector().detect(grey(*picture), OPTICS, exposed) == darkness


@pytest.mark.parametrize(
    "levels, backlit",
    [
        ((255, 30, 30, 30), BACKLIT),  # a window in a dim room
        ((255, 30, 120, 120), NOT_BACKLIT),
        ((255, 30, 30, 120), POSSIBLY_BACKLIT),
        ((30, 30, 30, 30), NOT_BACKLIT),  # dark, but evenly
        ((120, 140, 130, 120), NOT_BACKLIT),
    ],
)
def test_a_picture_is_backlit_when_much_is_dim_and_something_is_clipped(levels, backlit):
    assert BacklightingDetector().detect(grey(*levels), OPTICS) == backlit
