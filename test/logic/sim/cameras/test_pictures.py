"""What a camera makes of a picture: parameters, colour spaces, angles, and the tables of what there is."""

from __future__ import annotations

import math
from dataclasses import replace

import cv2
import numpy as np
import pytest

import vision_definitions
from nao_sim_bridge.cameras import settings as names
from nao_sim_bridge.cameras.color_spaces import encoded
from nao_sim_bridge.cameras.optics import CameraOptics, Optics
from nao_sim_bridge.cameras.sensor import Shot, develop
from nao_sim_bridge.cameras.settings import load_cameras

BRIGHTNESS, CONTRAST, SATURATION, HUE, GAIN, H_FLIP, V_FLIP, AUTO_WHITE = 0, 1, 2, 3, 6, 7, 8, 12
EXPOSURE, ALGORITHM, SHARPNESS, WHITE = 17, 22, 24, 33
MANUAL = {11: 0, AUTO_WHITE: 0}
SHOT = Shot("V6", 0, (0, 0, 0), (0, 0, 0, 1), 0.98, 0.76, 320, 240, 11, {}, 7)


def flat(*color, size=(320, 240)):
    return np.full((size[1], size[0], 3), color, np.uint8)


def taken(picture, parameters=None, version="V6", seed=7):
    """Mean colour, picture and what was chosen."""
    size = dict(width=picture.shape[1], height=picture.shape[0])
    rgb, chosen = develop(picture, replace(SHOT, version=version, seed=seed, parameters=parameters or {}, **size))
    return rgb.reshape(-1, 3).mean(axis=0), rgb, chosen


@pytest.fixture(scope="module")
def scene():
    """Edges, colours, light and dark."""
    picture = flat(150, 140, 130)
    picture[60:180, 40:140] = (200, 40, 40)
    picture[60:180, 180:280] = (40, 60, 190)
    picture[200:, :] = (60, 60, 55)
    return picture


@pytest.mark.parametrize("version", ["V6", "V5"])
def test_at_manual_defaults_the_picture_is_as_it_was_drawn(scene, version):
    mean, rgb, chosen = taken(scene, MANUAL, version)
    assert mean == pytest.approx(scene.reshape(-1, 3).mean(axis=0), abs=0.6)
    assert (rgb.astype(int) - scene).std() < 1.5
    assert chosen.luminance == pytest.approx(cv2.cvtColor(rgb, cv2.COLOR_RGB2GRAY).mean(), abs=1.5)


def test_sharpness_makes_edges_stronger_and_weaker(scene):
    soft = cv2.GaussianBlur(scene, (0, 0), 1.0)
    pictures = [taken(soft, {**MANUAL, SHARPNESS: value})[1] for value in (0, 4, 9)]
    edges = [cv2.Laplacian(cv2.cvtColor(rgb, cv2.COLOR_RGB2GRAY), cv2.CV_64F).std() for rgb in pictures]
    assert edges[0] < 0.9 * edges[1] < 0.81 * edges[2]


@pytest.mark.parametrize("version", ["V6", "V5"])
@pytest.mark.parametrize("size", [(40, 30), (320, 240), (1280, 960)])
def test_auto_exposure_brings_every_light_to_the_same_mean(version, size):
    for level in (60, 130, 230):
        _, rgb, chosen = taken(flat(level, level, level, size=size), version=version)
        assert rgb.shape == (size[1], size[0], 3)
        assert chosen.luminance == pytest.approx(135, abs=3)


def test_twice_the_light_is_not_twice_the_number(scene):
    """Pictures have a gamma."""
    once, twice = (taken(flat(60, 60, 60), {**MANUAL, EXPOSURE: value})[0] for value in (32, 64))
    assert twice / once == pytest.approx([2 ** (1 / 2.2)] * 3, rel=0.02)
    assert taken(scene, {**MANUAL, EXPOSURE: 0})[0] == pytest.approx([0.0] * 3, abs=1.0)


def test_gain_is_brighter_and_noisier_and_noise_that_of_its_seed():
    low, high = taken(flat(60, 60, 60), MANUAL), taken(flat(60, 60, 60), {**MANUAL, GAIN: 64})
    assert (low[0][0], high[0][0]) == pytest.approx((60, 60 * 4 ** (1 / 2.2)), rel=0.03)
    assert high[1].std() / low[1].std() == pytest.approx(4.0, rel=0.25)
    first, again, other = (taken(flat(120, 120, 120), MANUAL, seed=seed)[1].astype(int) for seed in (1, 1, 2))
    assert np.array_equal(first, again)
    assert 0.8 < (first - other).std() / (np.sqrt(2) * first.std()) < 1.2


def test_brightness_is_added_with_v6_and_what_auto_exposure_aims_at_with_v5():
    for change in (40, -60):
        brighter = taken(flat(120, 120, 120), {**MANUAL, BRIGHTNESS: change})[0]
        assert brighter == pytest.approx([120 + change] * 3, abs=1)
    means = [taken(flat(90, 90, 90), {BRIGHTNESS: value}, "V5")[2].luminance for value in (20, 55, 90)]
    assert means == pytest.approx([65, 135, 205], abs=3)


def test_contrast_spreads_and_narrows_and_flips_mirror(scene):
    narrow, normal, wide = (taken(scene, {**MANUAL, CONTRAST: value})[1] for value in (16, 32, 64))
    assert narrow.std() == pytest.approx(normal.std() / 2, rel=0.05) and wide.std() > 1.3 * normal.std()
    for h, v, mirrored in ((1, 0, normal[:, ::-1]), (0, 1, normal[::-1]), (1, 1, normal[::-1, ::-1])):
        assert np.array_equal(taken(scene, {**MANUAL, H_FLIP: h, V_FLIP: v})[1], mirrored)


def test_saturation_takes_colors_out_and_makes_them_stronger():
    color = flat(140, 100, 100)
    assert taken(color, {**MANUAL, SATURATION: 0})[0] == pytest.approx([112] * 3, abs=1)
    strong = taken(color, {**MANUAL, SATURATION: 128})[0]
    assert strong[0] - strong[1] == pytest.approx(80, abs=2)
    assert strong @ (0.299, 0.587, 0.114) == pytest.approx(112, abs=1)


def test_hue_turns_colors_and_leaves_grey_and_v5_has_none():
    red = flat(150, 100, 100)
    assert taken(flat(100, 100, 100), {**MANUAL, HUE: 90})[0] == pytest.approx([100] * 3, abs=1)
    assert taken(red, {**MANUAL, HUE: 180})[0] == pytest.approx([80, 129, 131], abs=4)
    assert taken(red, {**MANUAL, HUE: 90})[0][2] == pytest.approx(159, abs=2)
    assert taken(red, {**MANUAL, HUE: 90}, "V5")[0] == pytest.approx([150, 100, 100], abs=1)


def test_white_balance_takes_the_color_of_the_light_or_is_set_by_hand_with_v5():
    warm, raw = taken(flat(130, 122, 116))[0], taken(flat(130, 122, 116), {AUTO_WHITE: 0})[0]
    assert warm.max() - warm.min() < 3 and raw[0] - raw[2] > 10
    colored = taken(flat(180, 60, 50))[0]
    assert colored[0] > 2 * colored[2], "what is not nearly grey says nothing about the light"
    cold, warm = (taken(flat(110, 110, 110), {**MANUAL, WHITE: kelvin}, "V5")[0] for kelvin in (2700, 6500))
    assert cold[2] > cold[0] + 30 and warm[0] > warm[2] + 20


def test_exposure_algorithms_of_v5():
    picture = flat(30, 30, 30)
    picture[:120] = 220
    average, highlights, lowlights = (taken(picture, {ALGORITHM: a}, "V5")[2].exposure for a in (0, 2, 3))
    assert highlights < average < lowlights


RED, GREEN, BLUE, WHITEST, GREY, DARK = (255, 0, 0), (0, 255, 0), (0, 0, 255), (255, 255, 255), (90, 90, 90), (1, 2, 3)


@pytest.mark.parametrize(
    "space, color, expected",
    [(0, RED, [76, 76]), (8, WHITEST, [255, 255]), (1, BLUE, [255, 255]), (2, RED, [255, 255]), (1, GREY, [128, 128])]
    + [(3, DARK, [1, 1]), (4, DARK, [2, 2]), (5, DARK, [3, 3]), (6, RED, [0, 0]), (6, GREEN, [85, 85])]
    + [(6, BLUE, [170, 170]), (7, GREY, [0, 0]), (7, GREEN, [255, 255]), (9, GREY, [90, 128, 90, 128])]
    + [(10, GREY, [90, 128, 128] * 2), (10, RED, [76, 85, 255] * 2), (11, DARK, [1, 2, 3] * 2)]
    + [(12, GREEN, [85, 255, 150] * 2), (13, DARK, [3, 2, 1] * 2), (14, GREY, [90, 90, 128, 128])]
    + [(15, (10, 200, 10), [0, 255, 0] * 2), (16, GREEN, [85, 255, 170] * 2), (18, DARK, [255, 1, 2, 3] * 2)]
    + [(22, WHITEST, [255, 128, 128] * 2), (25, WHITEST, [255, 0])],
)
def test_known_colors(space, color, expected):
    values = encoded(np.array([[color, color]], np.uint8), space).ravel().tolist()
    assert values[: len(expected)] == pytest.approx(expected, abs=1)


@pytest.mark.parametrize("version, h_deg, v_deg", [("V6", 56.3, 43.7), ("V5", 60.9, 47.6)])
def test_each_version_has_its_field_of_view(version, h_deg, v_deg):
    for index in (0, 1):
        assert CameraOptics(version, index).fov == pytest.approx((math.radians(h_deg), math.radians(v_deg)))


@pytest.mark.parametrize("version", ["V6", "V5"])
def test_names_and_numbers_are_those_of_the_sdk(version):
    tables = load_cameras(version)
    for table in (tables.resolutions, tables.color_spaces, tables.parameters):
        assert table
        for number, entry in table.items():
            assert getattr(vision_definitions, entry.name) == number == entry.id
    assert tables.model_id == {"V6": vision_definitions.kOV5640, "V5": vision_definitions.kMT9M114}[version]
    known = {value for name, value in vars(names).items() if name.isupper() and name != "FOCUS_ONCE"}
    assert set(tables.parameters) <= known


def test_signs_are_those_of_naoqi_and_angles_lead_back_to_the_place():
    optics = Optics(1.0, 0.8)
    assert optics.angles(0.5, 0.5) == (0.0, 0.0)
    assert optics.angles(0.0, 0.0) == pytest.approx((0.5, -0.4))  # upper left corner
    assert optics.angles(1.0, 1.0) == pytest.approx((-0.5, 0.4))
    assert optics.angular_size(1.0, 1.0) == pytest.approx(optics.fov)
    for x, y in [(0.1, 0.9), (0.5, 0.25), (0.98, 0.02)]:
        assert optics.place(*optics.angles(x, y)) == pytest.approx((x, y))
        assert optics.image_size(*optics.angular_size(x, y)) == pytest.approx((x, y))
