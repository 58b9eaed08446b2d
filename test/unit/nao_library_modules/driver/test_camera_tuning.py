"""Parameters of the picture: set when somebody chose them, within the camera's range, and left alone otherwise."""

from __future__ import annotations

import logging

import pytest

from nao_library_modules.driver.camera_tuning import CameraTuning
from naoqi.errors import CallTimeout, NaoError, RobotError, RobotUnreachable, UnknownModule

BRIGHTNESS, CONTRAST, GAIN, AUTO_EXPOSITION, AUTO_WHITE, EXPOSURE = 0, 1, 6, 11, 12, 17
RANGES = {
    BRIGHTNESS: [-255, 255],
    CONTRAST: [0, 127],
    GAIN: [0, 1023],
    AUTO_EXPOSITION: [0, 1],
    AUTO_WHITE: [0, 1],
    EXPOSURE: [0, 65535],
}


class Device:
    """ALVideoDevice with a few parameters."""

    def __init__(self):
        self.values = {BRIGHTNESS: 5, CONTRAST: 32, GAIN: 16, AUTO_EXPOSITION: 1, AUTO_WHITE: 1, EXPOSURE: 40}
        self.sets = []
        self.silence = None

    def __call__(self, method, camera, number, *value):
        if self.silence is not None:
            raise self.silence
        if number not in self.values:
            raise RobotError("ALVideoDevice", method, f"no parameter {number}")
        if method == "getParameterRange":
            return RANGES[number]
        if method == "getParameter":
            return self.values[number]
        assert method == "setParameter"
        if number in (GAIN, EXPOSURE) and self.values[AUTO_EXPOSITION]:
            return False
        self.sets.append((camera, number, *value))
        self.values[number] = value[0]
        return True


@pytest.fixture
def device():
    return Device()


def test_values_are_set_the_automatic_ones_first(device):
    CameraTuning(device, {}).choose(1, {"exposure": 100, "contrast": 64, "auto_exposition": 0}, connected=True)
    assert device.sets == [(1, AUTO_EXPOSITION, 0), (1, EXPOSURE, 100), (1, CONTRAST, 64)]


def test_what_the_camera_chooses_itself_is_not_set(device):
    CameraTuning(device, {}).choose(0, {"gain": 100, "contrast": 64}, connected=True)
    assert device.sets == [(0, CONTRAST, 64)]


def test_values_out_of_range_are_told_and_nothing_is_set(device):
    tuning = CameraTuning(device, {})
    with pytest.raises(NaoError, match="contrast is 200: the robot's CameraTop takes 0 to 127"):
        tuning.choose(0, {"brightness": 9, "contrast": 200}, connected=True)
    tuning.set_again(0)
    assert device.sets == []


def test_what_was_chosen_is_set_on_a_robot_that_comes_later_and_on_the_next_one(device):
    tuning = CameraTuning(device, {"brightness": 9})
    tuning.choose(0, {"contrast": 64}, connected=False)
    assert device.sets == []
    for _ in range(2):
        tuning.set_again(0)
    assert device.sets == [(0, BRIGHTNESS, 9), (0, CONTRAST, 64)] * 2


def test_what_the_camera_lacks_is_left_out_with_one_warning(device, caplog):
    tuning = CameraTuning(device, {})
    with caplog.at_level(logging.WARNING):
        for value in (-60, -70):
            tuning.choose(0, {"white_balance": value, "contrast": 60, "auto_white_balance": 0}, connected=True)
    assert [record.getMessage() for record in caplog.records] == [
        "the robot's CameraTop has no white_balance, which is left out"
    ]
    assert (0, CONTRAST, 60) in device.sets


def test_a_camera_that_does_not_take_what_was_chosen_for_it_still_gives_pictures(device, caplog):
    tuning = CameraTuning(device, {"contrast": 200, "brightness": 9})
    tuning.set_again(0)
    assert device.sets == [(0, BRIGHTNESS, 9)]
    assert "contrast is 200" in caplog.text


def test_reading_tells_what_the_camera_has(device):
    assert CameraTuning(device, {}).read(0) == {
        "auto_exposition": 1,
        "auto_white_balance": 1,
        "exposure": 40,
        "gain": 16,
        "brightness": 5,
        "contrast": 32,
    }


@pytest.mark.parametrize(
    "silence",
    [
        RobotUnreachable("10.0.0.7", 9559, "not there"),
        UnknownModule("ALVideoDevice", "10.0.0.7:9559", [], ["ALMemory"]),
        CallTimeout("ALVideoDevice", "getParameter", 5.0),
    ],
    ids=["lost", "still starting", "busy"],
)
def test_a_robot_that_does_not_answer_is_no_camera_that_lacks_something(device, silence):
    tuning = CameraTuning(device, {"contrast": 60})
    device.silence = silence
    for call in (lambda: tuning.read(0), lambda: tuning.set_again(0)):
        with pytest.raises(type(silence)):
            call()
    device.silence = None
    tuning.set_again(0)
    assert device.sets == [(0, CONTRAST, 60)]
    assert tuning.read(0)["contrast"] == 60
