"""The tables of the cameras."""

from __future__ import annotations

import json
import math

import pytest

import vision_definitions
from nao_sim_bridge.paths import config_file
from nao_sim_bridge.sim.cameras import parameters
from nao_sim_bridge.sim.cameras.color_spaces import ENCODERS
from nao_sim_bridge.sim.cameras.settings import FILE, load_cameras, parse_cameras
from nao_sim_bridge.sim.errors import BadValue, ConfigError


@pytest.fixture
def content():
    return json.loads(config_file(FILE).read_text())


@pytest.mark.parametrize("version", ["V6", "V5"])
def test_names_and_numbers_are_those_of_the_sdk(version):
    tables = load_cameras(version)
    for table in (tables.resolutions, tables.color_spaces, tables.parameters):
        assert table
        for number, entry in table.items():
            assert getattr(vision_definitions, entry.name) == number == entry.id
    assert tables.model_id == {"V6": vision_definitions.kOV5640, "V5": vision_definitions.kMT9M114}[version]
    known = {value for name, value in vars(parameters).items() if name.isupper() and name != "FOCUS_ONCE"}
    assert set(tables.parameters) <= known


def test_sizes_are_four_to_three_and_double():
    sizes = {size.id: (size.width, size.height) for size in load_cameras("V6").resolutions.values()}
    assert sizes[8] == (40, 30)
    assert [sizes[number][0] for number in (8, 7, 0, 1, 2, 3, 4)] == [40 * 2**power for power in range(7)]
    assert all(width * 3 == height * 4 for width, height in sizes.values())


def test_a_color_space_has_an_encoder_or_needs_a_depth_camera():
    spaces = load_cameras("V6").color_spaces.values()
    assert {space.id for space in spaces if space.layers} == set(ENCODERS)
    assert {space.id for space in spaces if not space.layers} == {17, 20, 21, 23}


def test_versions_differ():
    v6, v5 = load_cameras("V6"), load_cameras("V5")
    assert 4 in v6.resolutions and 4 not in v5.resolutions
    assert 33 in v5.parameters and 33 not in v6.parameters
    assert (v5.parameter(0).least, v6.parameter(0).least) == (0, -255)


@pytest.mark.parametrize(
    "check, value, text",
    [
        ("camera", 2, r"camera is 2, allowed is one of 0 \(top\), 1 \(bottom\)"),
        ("camera", True, "camera is True"),
        ("camera", "top", "camera is 'top'"),
        ("resolution", 9, r"resolution is 9, allowed is one of 8 \(40x30\), "),
        ("color_space", 17, "colorSpace is 17, allowed is one of .*: kDepthColorSpace needs a depth camera"),
        ("color_space", 27, "colorSpace is 27, allowed is one of 0, 1, "),
        ("parameter", 33, r"parameter is 33, allowed is one of 0 \(kCameraBrightnessID\), "),
    ],
)
def test_what_is_not_there_is_told_with_what_is(check, value, text):
    with pytest.raises(BadValue, match=text):
        getattr(load_cameras("V6"), check)(value)


@pytest.mark.parametrize("fps", [0, -1, 31, True, "5", math.nan])
def test_rates_have_limits(fps):
    tables = load_cameras("V6")
    with pytest.raises(BadValue, match="fps is .*, allowed is up to 30 frames a second, above 0"):
        tables.check_rate(0, tables.resolution(1), fps)


def test_the_largest_pictures_are_those_of_the_top_camera():
    tables = load_cameras("V6")
    tables.check_rate(0, tables.resolution(4), 1)
    with pytest.raises(BadValue, match="resolution is 4, allowed is one of 8, 7, 0, 1, 2, 3 with camera 1"):
        tables.check_rate(1, tables.resolution(4), 1)


def test_mistakes_in_the_file_are_told(content):
    content["versions"]["V6"]["parameters"]["kCameraHueID"]["default"] = 400
    with pytest.raises(ConfigError, match=r"kCameraHueID: default 400 is not within -180..180"):
        parse_cameras(content, "V6")
    with pytest.raises(ConfigError, match="no cameras of version 'V7'"):
        parse_cameras(content, "V7")
    del content["resolutions"]["kVGA"]
    with pytest.raises(ConfigError, match="resolutions.kVGA: is None, not 3 whole numbers"):
        parse_cameras(content, "V5")
    content["versions"]["V5"]["sensor"]["zoom"] = 1
    with pytest.raises(ConfigError):
        parse_cameras(content, "V5")
