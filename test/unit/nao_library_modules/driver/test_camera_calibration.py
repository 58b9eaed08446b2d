"""Calibrations: computed, scaled, written and read."""

from __future__ import annotations

import math

import pytest

from nao_library_modules.driver.camera_calibration import Calibration, from_yaml, ideal, scaled, to_yaml
from naoqi.errors import NaoError

HFOV, VFOV = math.radians(56.3), math.radians(43.7)
# One robot's, as camera_calibration writes it.
FILE = """
image_width: 640
image_height: 480
camera_name: nao_camera_top
camera_matrix:
  rows: 3
  cols: 3
  data: [556.845, 0, 309.367, 0, 555.899, 230.592, 0, 0, 1]
distortion_model: plumb_bob
distortion_coefficients:
  rows: 1
  cols: 5
  data: [-0.05452, 0.0692, -0.00241, -0.00112, 0]
rectification_matrix:
  rows: 3
  cols: 3
  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]
projection_matrix:
  rows: 3
  cols: 4
  data: [551.59, 0, 308.96, 0, 0, 551.29, 228.71, 0, 0, 0, 1, 0]
"""


def test_the_ideal_camera_sees_its_field_of_view():
    found = ideal(640, 480, HFOV, VFOV)
    fx, _, cx, _, fy, cy = found.k[:6]
    assert (fx, fy) == (pytest.approx(598.05, abs=0.1), pytest.approx(598.53, abs=0.1))
    assert (cx, cy) == (320.0, 240.0)
    # The edges of the picture are at the edges of the field of view.
    assert cx + fx * math.tan(HFOV / 2) == pytest.approx(640.0)
    assert cy - fy * math.tan(VFOV / 2) == pytest.approx(0.0)
    assert found.p == (fx, 0.0, cx, 0.0, 0.0, fy, cy, 0.0, 0.0, 0.0, 1.0, 0.0)
    assert found.d == (0.0,) * 5


def test_scaling_an_ideal_camera_is_an_ideal_camera():
    assert scaled(ideal(640, 480, HFOV, VFOV), 160, 120).k == pytest.approx(ideal(160, 120, HFOV, VFOV).k)


def test_scaling_keeps_distortion_and_the_last_rows():
    found = scaled(from_yaml(FILE), 320, 240)
    assert found.k == pytest.approx((278.4225, 0, 154.6835, 0, 277.9495, 115.296, 0, 0, 1))
    assert found.p == pytest.approx((275.795, 0, 154.48, 0, 0, 275.645, 114.355, 0, 0, 0, 1, 0))
    assert found.d == (-0.05452, 0.0692, -0.00241, -0.00112, 0.0)
    assert (found.width, found.height, found.name) == (320, 240, "nao_camera_top")


def test_another_shape_of_the_picture_is_refused():
    with pytest.raises(NaoError, match="640x480 is of no use for 1280x720"):
        scaled(from_yaml(FILE), 1280, 720)


def test_what_is_written_is_read():
    found = from_yaml(FILE)
    assert from_yaml(to_yaml(found)) == found
    assert "camera_matrix:\n  rows: 3\n  cols: 3\n  data: [556.845, " in to_yaml(found)


@pytest.mark.parametrize(
    "text, problem",
    [
        ("a: [", "no YAML"),
        ("just words", "no calibration"),
        (FILE.replace("image_width: 640", ""), "no image_width"),
        (FILE.replace("camera_matrix", "camera_matrices"), "no camera_matrix"),
        (FILE.replace("image_height: 480", "image_height: 0"), "640x0 pixels"),
        (FILE.replace("556.845", "wide"), "something else than numbers"),
        (FILE.replace("556.845", "0"), "focal lengths above 0"),
        (FILE.replace("556.845", ".nan"), "K of a calibration has 9 finite numbers"),
        (FILE.replace("[556.845, 0, ", "[556.845, "), "K of a calibration has 9 finite numbers"),
    ],
)
def test_what_is_no_calibration_is_told(text, problem):
    with pytest.raises(NaoError, match=problem):
        from_yaml(text)


def test_a_file_without_projection_and_rectification_has_those_of_its_camera():
    text = FILE[: FILE.index("rectification_matrix")]
    found = from_yaml(text)
    assert found.r == (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
    assert found.p[:4] == (556.845, 0.0, 309.367, 0.0)


def test_a_size_is_needed():
    with pytest.raises(NaoError, match="0x0"):
        Calibration(0, 0, (1.0,) * 9)
