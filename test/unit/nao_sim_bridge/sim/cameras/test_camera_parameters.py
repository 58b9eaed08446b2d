"""How the cameras are set, and what they then see. Pictures are plain."""

from __future__ import annotations

import numpy as np
import pytest

from nao_sim_bridge.sim.errors import BadValue

TOP, BOTTOM = 0, 1
AUTO_EXPOSURE, EXPOSURE, GAIN, KEEP_ALIVE, LUMINANCE = 11, 17, 6, 35, 39


def test_parameters_are_those_of_the_frame_at_its_time(head):
    stream = head.open(every=True, keep=5)
    head.run()
    head.cameras.set_parameter(TOP, AUTO_EXPOSURE, 0)
    head.cameras.set_parameter(TOP, EXPOSURE, 8)
    head.run(4)
    first, second = head.take(stream), head.take(stream)
    assert first.array().mean() > 1.5 * second.array().mean()
    assert head.pictures.shots[0].parameters[AUTO_EXPOSURE] == 1


def test_automatics_tell_what_they_chose_and_leave_it_behind(head):
    head.pictures.color = (60, 60, 60)
    stream = head.open()
    head.run()
    head.take(stream)
    exposure, gain = head.cameras.parameter(TOP, EXPOSURE), head.cameras.parameter(TOP, GAIN)
    assert exposure == 128 and gain > 16
    assert head.cameras.parameter(TOP, LUMINANCE) == pytest.approx(135, abs=3)
    assert head.cameras.parameter(BOTTOM, EXPOSURE) == 32
    head.cameras.set_parameter(TOP, AUTO_EXPOSURE, 0)
    assert (head.cameras.parameter(TOP, EXPOSURE), head.cameras.parameter(TOP, GAIN)) == (exposure, gain)
    head.run(4)
    assert head.take(stream).array().mean() == pytest.approx(135, abs=3)
    head.cameras.reset_parameters(TOP)
    assert head.cameras.parameter(TOP, AUTO_EXPOSURE) == 1


@pytest.mark.parametrize(
    "number, value, text",
    [
        (0, 256, "kCameraBrightnessID is 256, allowed is -255 to 255"),
        (0, True, "kCameraBrightnessID is True"),
        (0, 1.5, "kCameraBrightnessID is 1.5"),
        (EXPOSURE, 10, "kCameraExposureID is 10, allowed is no value while kCameraAutoExpositionID is 1"),
        (LUMINANCE, 10, "kCameraAverageLuminanceID is 10, allowed is no value: it can only be read"),
        (33, 3000, "parameter is 33"),
    ],
)
def test_what_a_parameter_cannot_be_is_told(head, number, value, text):
    with pytest.raises(BadValue, match=text):
        head.cameras.set_parameter(TOP, number, value)


def test_keep_alive(head):
    assert not head.cameras.kept_alive(TOP)
    head.cameras.set_parameter(TOP, KEEP_ALIVE, 1)
    assert head.cameras.kept_alive(TOP) and not head.cameras.kept_alive(BOTTOM)


def test_pictures_from_outside_take_the_place_of_the_world(head):
    picture = np.zeros((480, 640, 3), np.uint8)
    picture[:, 320:] = 255
    head.cameras.show(TOP, picture)
    for number in (AUTO_EXPOSURE, 12):
        head.cameras.set_parameter(TOP, number, 0)
    stream, other = head.open(resolution=1), head.open(camera=BOTTOM)
    head.run()
    seen = head.take(stream).array()
    assert seen.shape == (240, 320, 3)
    assert seen[:, :150].mean() < 3 and seen[:, 170:].mean() > 250
    head.take(other)
    assert [shot.camera for shot in head.pictures.shots] == [BOTTOM]
    head.cameras.show(TOP, None)
    head.run(4)
    head.take(stream)
    assert len(head.pictures.shots) == 2


def test_the_cameras_of_an_older_robot(head_of):
    head = head_of(version="V5")
    stream = head.open(color_space=11)
    head.pictures.color = (130, 122, 116)
    head.run()
    frame = head.take(stream)
    assert np.degrees((frame.hfov, frame.vfov)) == pytest.approx((60.9, 47.6))
    white_balance, automatic = 33, 12
    seen = head.cameras.parameter(TOP, white_balance)
    assert seen < 4600, "the light is warm"
    head.cameras.set_parameter(TOP, automatic, 0)
    assert head.cameras.parameter(TOP, white_balance) == seen
    head.cameras.set_parameter(TOP, white_balance, 6500)
    assert head.cameras.parameter(TOP, white_balance) == 6500
    with pytest.raises(BadValue, match="resolution is 4"):
        head.open(resolution=4)
    with pytest.raises(BadValue, match="parameter is 40"):
        head.cameras.parameter(TOP, 40)
