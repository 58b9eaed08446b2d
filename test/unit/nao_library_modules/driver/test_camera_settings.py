"""Parameters of a camera: names of naoqi_camera, values that go together."""

from __future__ import annotations

import pytest

from nao_library_modules.driver.camera_settings import changed_tunings, fields_of, settled, stream_settings
from nao_library_modules.driver.camera_subscriber import StreamSettings
from naoqi.errors import NaoError

NAMES = {
    "resolution",
    "frame_rate",
    "color_space",
    "camera_info_url",
    "use_ros_time",
    "auto_exposition",
    "auto_exposure_algo",
    "exposure",
    "gain",
    "brightness",
    "contrast",
    "saturation",
    "hue",
    "sharpness",
    "auto_white_balance",
    "white_balance",
}


def values(**changes):
    return {**{field.name: field.default for field in fields_of(1, 15.0, True, 0, False)}, **changes}


def test_names_are_those_of_naoqi_camera():
    assert {field.name for field in fields_of(1, 15.0, True, 0, alone=False)} == NAMES
    alone = {field.name: field for field in fields_of(2, 10.0, False, 1, alone=True)}
    assert set(alone) == NAMES | {"source"}
    assert (alone["source"].default, alone["resolution"].default, alone["frame_rate"].default) == (1, 2, 10.0)


def test_what_the_robot_is_asked_for():
    assert stream_settings(values(), 1) == StreamSettings(1, 1, 13, 15)
    assert stream_settings(values(source=0, frame_rate=7.6, color_space=9), 1) == StreamSettings(0, 1, 9, 8)


@pytest.mark.parametrize(
    "change, text",
    [
        ({"resolution": 5}, "resolution is 5: one of 0 .160x120., 1 .320x240."),
        ({"color_space": 14}, "color_space is 14: one of 0 .Yuv"),
        ({"source": 2}, "source is 2: one of 0 .top., 1 .bottom."),
    ],
)
def test_numbers_that_stand_for_nothing_are_told(change, text):
    with pytest.raises(NaoError, match=text):
        stream_settings(values(**change), 0)


@pytest.mark.parametrize(
    "change, automatic",
    [
        ({"exposure": 100}, "auto_exposition"),
        ({"gain": 100}, "auto_exposition"),
        ({"white_balance": 4000}, "auto_white_balance"),
    ],
)
def test_a_fixed_value_ends_the_automatic(change, automatic):
    after = settled(values(), values(**change))
    assert after == values(**change, **{automatic: 0})
    assert changed_tunings(values(), after) == {**change, automatic: 0}


def test_who_asks_for_the_automatic_gets_it():
    before = values(auto_exposition=0)
    assert settled(before, values(auto_exposition=1, exposure=7))["auto_exposition"] == 1
    assert settled({}, values(exposure=7))["auto_exposition"] == 1


def test_rates_are_whole_numbers():
    assert settled(values(), values(frame_rate=7.6))["frame_rate"] == 8.0
