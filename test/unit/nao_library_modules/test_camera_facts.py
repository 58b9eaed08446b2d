"""Cameras are known by their numbers and their names."""

import pytest

import vision_definitions as vision
from nao_library_modules.camera_facts import BOTTOM, RESOLUTIONS, SIZES, TOP, camera_number
from nao_library_modules.vision_cameras import PARAMETERS


@pytest.mark.parametrize(
    "told, number", [(0, TOP), (1, BOTTOM), ("CameraTop", TOP), ("CameraBottom", BOTTOM), (2, None), ("Depth", None)]
)
def test_a_camera_is_told_by_number_or_name(told, number):
    assert camera_number(told) == number


def test_sizes_grow_with_the_names():
    pixels = [width * height for width, height in SIZES.values()]
    assert pixels == sorted(set(pixels))


def test_numbers_are_those_of_the_sdk():
    assert (TOP, BOTTOM) == (vision.kTopCamera, vision.kBottomCamera)
    for name, (number, *_) in RESOLUTIONS.items():
        assert number == getattr(vision, f"k{name}")
    for name, number in PARAMETERS.items():
        assert number == getattr(vision, f"kCamera{name}ID")
