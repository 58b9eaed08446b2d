"""What the parameters of a camera do to its pictures."""

from __future__ import annotations

import math
from dataclasses import replace

import cv2
import numpy as np
import pytest

from nao_sim_bridge.sim.cameras.photograph import photograph, read_photograph
from nao_sim_bridge.sim.cameras.sensor import develop
from nao_sim_bridge.sim.cameras.shot import Shot

BRIGHTNESS, CONTRAST, SATURATION, HUE, GAIN, H_FLIP, V_FLIP = 0, 1, 2, 3, 6, 7, 8
AUTO_EXPOSURE, AUTO_WHITE, EXPOSURE, ALGORITHM, SHARPNESS, WHITE, BACKLIGHT, AUTO_FOCUS, FOCUS = (
    11,
    12,
    17,
    22,
    24,
    33,
    34,
    40,
    43,
)
MANUAL = {AUTO_EXPOSURE: 0, AUTO_WHITE: 0}


def shot(version="V6", size=(320, 240), seed=7, **_):
    return Shot(version, 0, (0, 0, 0), (0, 0, 0, 1), 0.98, 0.76, *size, 11, {}, seed)


def flat(color, size=(320, 240)):
    return np.full((size[1], size[0], 3), color, np.uint8)


def taken(picture, parameters=None, version="V6", seed=7):
    """Mean colour, picture and what was chosen."""
    size = picture.shape[1], picture.shape[0]
    rgb, chosen = develop(picture, replace(shot(version, size, seed), parameters=parameters or {}))
    return rgb.reshape(-1, 3).mean(axis=0), rgb, chosen


@pytest.fixture(scope="module")
def scene():
    """Edges, colours, light and dark."""
    picture = flat((150, 140, 130))
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


@pytest.mark.parametrize("version", ["V6", "V5"])
@pytest.mark.parametrize("level", [60, 130, 230])
def test_auto_exposure_brings_every_light_to_the_same_mean(version, level):
    _, _, chosen = taken(flat((level,) * 3), version=version)
    assert chosen.luminance == pytest.approx(135, abs=3)


def test_auto_exposure_raises_the_gain_when_the_exposure_is_at_its_end():
    light, dark = taken(flat((200,) * 3))[2], taken(flat((40,) * 3))[2]
    assert light.exposure < 32 and light.gain == 16
    assert dark.exposure == 128 and dark.gain > 16


def test_twice_the_light_is_not_twice_the_number(scene):
    """Pictures have a gamma."""
    once = taken(flat((60,) * 3), {**MANUAL, EXPOSURE: 32})[0]
    twice = taken(flat((60,) * 3), {**MANUAL, EXPOSURE: 64})[0]
    assert twice / once == pytest.approx([2 ** (1 / 2.2)] * 3, rel=0.02)
    assert taken(scene, {**MANUAL, EXPOSURE: 0})[0] == pytest.approx([0.0] * 3, abs=1.0)


def test_gain_is_brighter_and_noisier():
    low_mean, low, _ = taken(flat((60,) * 3), MANUAL)
    high_mean, high, _ = taken(flat((60,) * 3), {**MANUAL, GAIN: 64})
    assert high_mean[0] == pytest.approx(60 * 4 ** (1 / 2.2), rel=0.03)
    assert high.std() / low.std() == pytest.approx(4.0, rel=0.25)
    assert low_mean[0] == pytest.approx(60, abs=0.5)


def test_noise_is_that_of_its_seed():
    grey = flat((120,) * 3)
    first, again, other = (taken(grey, MANUAL, seed=seed)[1] for seed in (1, 1, 2))
    assert np.array_equal(first, again)
    difference = first.astype(int) - other
    assert 0.8 < difference.std() / (np.sqrt(2) * first.astype(int).std()) < 1.2


@pytest.mark.parametrize("value, change", [(40, 40), (-60, -60)])
def test_brightness_is_added_with_v6(value, change):
    assert taken(flat((120,) * 3), {**MANUAL, BRIGHTNESS: value})[0] == pytest.approx([120 + change] * 3, abs=1)


def test_brightness_is_what_auto_exposure_aims_at_with_v5():
    means = [taken(flat((90,) * 3), {BRIGHTNESS: value}, "V5")[2].luminance for value in (20, 55, 90)]
    assert means == pytest.approx([65, 135, 205], abs=3)


def test_contrast_spreads_and_narrows(scene):
    narrow, normal, wide = (taken(scene, {**MANUAL, CONTRAST: value})[1].std() for value in (16, 32, 64))
    assert narrow == pytest.approx(normal / 2, rel=0.05)
    assert wide > 1.3 * normal


def test_saturation_takes_colors_out_and_makes_them_stronger():
    color = flat((140, 100, 100))
    grey = taken(color, {**MANUAL, SATURATION: 0})[0]
    assert grey == pytest.approx([112] * 3, abs=1)
    strong = taken(color, {**MANUAL, SATURATION: 128})[0]
    assert strong[0] - strong[1] == pytest.approx(80, abs=2)
    assert strong @ (0.299, 0.587, 0.114) == pytest.approx(112, abs=1)


def test_hue_turns_colors_and_leaves_grey():
    assert taken(flat((100,) * 3), {**MANUAL, HUE: 90})[0] == pytest.approx([100] * 3, abs=1)
    red = flat((150, 100, 100))
    turned = taken(red, {**MANUAL, HUE: 180})[0]
    assert turned[0] < turned[1] and turned[0] < turned[2]
    assert taken(red, {**MANUAL, HUE: 90}, "V5")[0] == pytest.approx([150, 100, 100], abs=1)


def test_flips(scene):
    plain = taken(scene, MANUAL)[1]
    assert np.array_equal(taken(scene, {**MANUAL, H_FLIP: 1})[1], plain[:, ::-1])
    assert np.array_equal(taken(scene, {**MANUAL, V_FLIP: 1})[1], plain[::-1])
    assert np.array_equal(taken(scene, {**MANUAL, H_FLIP: 1, V_FLIP: 1})[1], plain[::-1, ::-1])


def sharpness_of(picture):
    return cv2.Laplacian(cv2.cvtColor(picture, cv2.COLOR_RGB2GRAY), cv2.CV_64F).std()


def test_sharpness_makes_edges_stronger_and_weaker(scene):
    soft = cv2.GaussianBlur(scene, (0, 0), 1.0)
    values = [sharpness_of(taken(soft, {**MANUAL, SHARPNESS: value})[1]) for value in (0, 4, 9)]
    assert values[0] < 0.9 * values[1] < 0.81 * values[2]


def test_focus_blurs_unless_the_camera_focuses_by_itself(scene):
    sharp = sharpness_of(taken(scene, MANUAL)[1])
    assert sharpness_of(taken(scene, {**MANUAL, FOCUS: 125})[1]) < 0.6 * sharp
    assert sharpness_of(taken(scene, {**MANUAL, FOCUS: 125, AUTO_FOCUS: 1})[1]) == pytest.approx(sharp)
    assert sharpness_of(taken(scene, {**MANUAL, FOCUS: 250})[1]) == pytest.approx(sharp)


def test_automatic_white_balance_takes_the_color_of_the_light():
    warm = taken(flat((130, 122, 116)))[0]
    assert warm.max() - warm.min() < 3
    raw = taken(flat((130, 122, 116)), {AUTO_WHITE: 0})[0]
    assert raw[0] - raw[2] > 10
    colored = taken(flat((180, 60, 50)))[0]
    assert colored[0] > 2 * colored[2], "what is not nearly grey says nothing about the light"


def test_white_balance_by_hand_with_v5():
    cold, warm = (taken(flat((110,) * 3), {**MANUAL, WHITE: kelvin}, "V5")[0] for kelvin in (2700, 6500))
    assert cold[2] > cold[0] + 30 and warm[0] > warm[2] + 20


@pytest.mark.parametrize("version, value", [("V6", 1), ("V5", 4)])
def test_backlight_compensation_looks_at_the_middle(version, value):
    picture = flat((230,) * 3)
    picture[60:180, 80:240] = 40
    middle = lambda parameters: taken(picture, parameters, version)[1][100:140, 120:200].mean()  # noqa: E731
    assert middle({BACKLIGHT: value}) > 1.2 * middle({BACKLIGHT: 0})


def test_exposure_algorithms_of_v5():
    picture = flat((30,) * 3)
    picture[:120] = 220
    average, highlights, lowlights = (taken(picture, {ALGORITHM: a}, "V5")[2].exposure for a in (0, 2, 3))
    assert highlights < average < lowlights


def test_a_black_picture_is_no_accident():
    _, rgb, chosen = taken(flat((0, 0, 0)))
    assert (chosen.exposure, chosen.gain) == (128, 128)
    assert rgb.mean() < 10


@pytest.mark.parametrize("size", [(40, 30), (80, 60), (160, 120), (1280, 960)])
def test_all_sizes(size):
    _, rgb, chosen = taken(flat((100, 110, 90), size))
    assert rgb.shape == (size[1], size[0], 3)
    assert chosen.luminance == pytest.approx(135, abs=3)


def test_a_photograph_brings_what_was_chosen_with_it(scene):
    request = replace(shot(), parameters={**MANUAL, EXPOSURE: 50}, color_space=0)
    photo = read_photograph(photograph(scene, request))
    rgb, chosen = develop(scene, request)
    assert (photo.chosen.exposure, photo.chosen.gain) == (50, 16)
    assert math.isclose(photo.chosen.luminance, chosen.luminance, rel_tol=1e-6)
    assert np.array_equal(np.frombuffer(photo.data, np.uint8).reshape(240, 320), cv2.cvtColor(rgb, cv2.COLOR_RGB2GRAY))
