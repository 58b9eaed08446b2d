"""Bytes of the colour spaces."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from nao_sim_bridge.sim.cameras.color_spaces import ENCODERS, encode, encoded
from nao_sim_bridge.sim.cameras.settings import load_cameras
from nao_sim_bridge.sim.errors import BadValue

RED, GREEN, BLUE, WHITE, GREY = (255, 0, 0), (0, 255, 0), (0, 0, 255), (255, 255, 255), (90, 90, 90)


def picture(*pixels):
    """(1, n, 3)."""
    return np.array([pixels], dtype=np.uint8)


def bytes_of(color, space):
    return list(encode(picture(color, color), space))


@pytest.fixture(scope="module")
def noise():
    return np.random.default_rng(1).integers(0, 256, (12, 16, 3), dtype=np.uint8)


@pytest.mark.parametrize("space", ENCODERS)
def test_there_are_as_many_bytes_as_the_table_says(noise, space):
    layers = load_cameras("V6").color_spaces[space].layers
    assert len(encode(noise, space)) == 12 * 16 * layers
    assert encoded(noise, space).dtype == np.uint8


@pytest.mark.parametrize(
    "space, color, expected",
    [
        (0, RED, [76, 76]),
        (8, WHITE, [255, 255]),
        (1, BLUE, [255, 255]),
        (2, RED, [255, 255]),
        (1, GREY, [128, 128]),
        (3, (1, 2, 3), [1, 1]),
        (4, (1, 2, 3), [2, 2]),
        (5, (1, 2, 3), [3, 3]),
        (6, RED, [0, 0]),
        (6, GREEN, [85, 85]),
        (6, BLUE, [170, 170]),
        (7, GREY, [0, 0]),
        (7, GREEN, [255, 255]),
        (9, GREY, [90, 128, 90, 128]),
        (10, GREY, [90, 128, 128] * 2),
        (10, RED, [76, 85, 255] * 2),
        (11, (1, 2, 3), [1, 2, 3] * 2),
        (12, GREEN, [85, 255, 150] * 2),
        (13, (1, 2, 3), [3, 2, 1] * 2),
        (14, GREY, [90, 90, 128, 128]),
        (15, (10, 200, 10), [0, 255, 0] * 2),
        (16, GREEN, [85, 255, 170] * 2),
        (18, (1, 2, 3), [255, 1, 2, 3] * 2),
        (22, WHITE, [255, 128, 128] * 2),
        (25, WHITE, [255, 0]),
        (26, GREY, None),
    ],
)
def test_known_colors(space, color, expected):
    values = bytes_of(color, space)
    if expected is None:  # no colour: no chroma
        assert values[1] == values[4] == 0
    else:
        assert values[: len(expected)] == pytest.approx(expected, abs=1)


def test_two_pixels_share_their_color_in_yuv422():
    red, _, blue, _ = picture(RED, GREY, BLUE, GREY)[0]
    assert list(encode(picture(red, blue), 9)) == pytest.approx([76, (85 + 255) / 2, 29, (255 + 107) / 2], abs=1)
    assert list(encode(picture(red, blue), 14)) == pytest.approx([76, 29, (85 + 255) / 2, (255 + 107) / 2], abs=1)


def test_yuv422_leads_back_to_the_picture():
    """Smooth pictures lose next to nothing."""
    ramp = np.linspace(0, 255, 64).astype(np.uint8)
    rgb = np.dstack(np.broadcast_arrays(ramp[None, :], ramp[:, None], 255 - ramp[None, :])).copy()
    y, u, v = (plane.astype(float) for plane in np.split(encoded(rgb, 10), 3, axis=2))
    native = encoded(rgb, 9).astype(float)
    assert native[..., 0] == pytest.approx(y[..., 0])
    assert native[:, 0::2, 1] == pytest.approx((u[:, 0::2, 0] + u[:, 1::2, 0]) / 2, abs=1)
    red = y + 1.402 * (v - 128)
    assert red[..., 0].clip(0, 255) == pytest.approx(rgb[..., 0].astype(float), abs=3)


def test_hue_of_lch_goes_round_the_circle():
    lab = cv2.cvtColor(picture(RED).astype(np.float32) / 255.0, cv2.COLOR_RGB2Lab)[0, 0]
    _, chroma, hue = encoded(picture(RED, RED), 25)[0, 0]
    assert chroma == pytest.approx(np.hypot(lab[1], lab[2]), abs=1)
    assert hue == pytest.approx(np.arctan2(lab[2], lab[1]) * 128 / np.pi, abs=1)


@pytest.mark.parametrize("space", [17, 20, 21, 23, 27])
def test_what_needs_a_depth_camera_is_refused(noise, space):
    with pytest.raises(BadValue, match=f"colorSpace is {space}, allowed is one of 0, 1"):
        encode(noise, space)
