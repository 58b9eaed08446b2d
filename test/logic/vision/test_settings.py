"""Names of cameras, parameters and resolutions."""

from __future__ import annotations

import pytest

from nao_library_modules.core.errors import BadGoal
from nao_library_modules.core.nao_facts import BOTTOM, TOP, camera_number
from nao_library_modules.vision.cameras import camera_name, parameter_number, resolution_name, resolution_of


def test_spellings_of_a_parameter():
    for text, number in (
        *((text, 0) for text in ("brightness", "Brightness", "kCameraBrightnessID", "camera_brightness", " 0 ")),
        ("auto_exposure", 11), ("exposition", 17), ("exposure", 17), ("HFlip", 7), ("auto_white_balance", 12),
        ("43", 43),
    ):  # fmt: skip
        assert parameter_number(text) == number
    for text, problem in (
        ("brigthness", "did you mean 'Brightness'"), ("64", "'64' is no parameter"),
        ("kCameraFrameRateID", "setFrameRate and its like"), ("18", "setActiveCamera"),
    ):  # fmt: skip
        with pytest.raises(BadGoal, match=problem):
            parameter_number(text)


def test_spellings_of_a_resolution():
    assert {resolution_name(text) for text in ("VGA", "vga", "kVGA", "2", "640x480", "640 x 480")} == {"VGA"}
    with pytest.raises(BadGoal, match="'641x480' is no resolution.*VGA .or 2, 640x480."):
        resolution_name("641x480")
    assert (resolution_of(4), resolution_of(77)) == ("16VGA", "77")


def test_cameras_have_numbers_and_names():
    named = [camera_name(text, "bottom") for text in ("top", "0", "1", "Bottom", "")]
    assert named == ["top", "top", "bottom", "bottom", "bottom"]
    told = [camera_number(camera) for camera in (0, 1, "CameraTop", "CameraBottom", 2, "Depth")]
    assert told == [TOP, BOTTOM, TOP, BOTTOM, None, None]
