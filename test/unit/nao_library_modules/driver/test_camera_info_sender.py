"""The calibration that the options of send_camera_info describe."""

from __future__ import annotations

import math

import pytest

from nao_library_modules.driver.camera_calibration import ideal, to_yaml
from nao_library_modules.driver.camera_info_sender import parser, read_calibration
from naoqi.errors import NaoError

KNOWN = ideal(640, 480, math.radians(60.9), math.radians(47.6))


@pytest.fixture
def path(tmp_path):
    path = tmp_path / "camera.yaml"
    path.write_text(to_yaml(KNOWN), encoding="utf-8")
    return path


def read(*words):
    return read_calibration(parser().parse_args(["top", *map(str, words)]))


def test_a_file_is_sent_as_it_is_or_for_another_size(path):
    assert read(path) == KNOWN
    small = read(path, "--size", "320x240")
    assert (small.width, small.k[0]) == (320, KNOWN.k[0] / 2)


def test_a_field_of_view_is_a_calibration():
    assert read("--fov", 60.9, 47.6).k == pytest.approx(KNOWN.k)
    assert read("--fov", 60.9, 47.6, "--size", "320x240").width == 320


@pytest.mark.parametrize(
    "words, text",
    [
        ((), "either a file or --fov"),
        (("a.yaml", "--fov", 60, 47), "either a file or --fov"),
        (("missing.yaml",), "missing.yaml cannot be read"),
        (("--fov", 0, 47), "above 0 and below 180 degrees"),
        (("--fov", 60, 200), "above 0 and below 180 degrees"),
    ],
)
def test_what_is_wrong_is_told(words, text):
    with pytest.raises(NaoError, match=text):
        read(*words)


def test_a_file_that_is_no_calibration_is_told(path):
    path.write_text("nothing", encoding="utf-8")
    with pytest.raises(NaoError, match="camera.yaml is no calibration"):
        read(path)


@pytest.mark.parametrize("words", [("--size", "320"), ("--size", "0x240"), ("--size", "wide")])
def test_sizes_are_width_and_height(words, capsys):
    with pytest.raises(SystemExit):
        read("--fov", 60, 47, *words)
    assert "--size" in capsys.readouterr().err
