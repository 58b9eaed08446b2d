"""Cameras: formats and messages of pictures, compression, calibrations and where they are kept, settings, rates."""

from __future__ import annotations

import logging
import math
from dataclasses import replace

import cv2
import numpy as np
import pytest
from sensor_msgs.msg import CameraInfo

from nao_library_modules.driver.camera.camera_calibration import (
    Calibration,
    CameraInfos,
    camera_name,
    from_yaml,
    ideal,
    path_of,
    scaled,
    to_yaml,
    write,
)
from nao_library_modules.driver.camera.camera_images import (
    Picture,
    compress,
    from_info,
    header_of,
    read_picture,
    to_compressed,
    to_image,
    to_info,
)
from nao_library_modules.driver.camera.camera_settings import changed_tunings, fields_of, settled, stream_settings
from nao_library_modules.driver.camera.camera_stream import StreamSettings
from naoqi.errors import NaoError

NAME = "nao_camera_top"
HFOV, VFOV = FOV = math.radians(56.3), math.radians(43.7)
OTHER_FOV = math.radians(60.9), math.radians(47.6)
MEASURED = Calibration(
    640,
    480,
    (556.845, 0.0, 309.367, 0.0, 555.899, 230.592, 0.0, 0.0, 1.0),
    (-0.05452, 0.0692, -0.00241, -0.00112, 0.0),
    p=(551.59, 0.0, 308.96, 0.0, 0.0, 551.29, 228.71, 0.0, 0.0, 0.0, 1.0, 0.0),
    name=NAME,
)
# One robot's, as camera_calibration writes it.
FILE = """
image_width: 640
image_height: 480
camera_name: nao_camera_top
camera_matrix: {rows: 3, cols: 3, data: [556.845, 0, 309.367, 0, 555.899, 230.592, 0, 0, 1]}
distortion_model: plumb_bob
distortion_coefficients: {rows: 1, cols: 5, data: [-0.05452, 0.0692, -0.00241, -0.00112, 0]}
rectification_matrix: {rows: 3, cols: 3, data: [1, 0, 0, 0, 1, 0, 0, 0, 1]}
projection_matrix: {rows: 3, cols: 4, data: [551.59, 0, 308.96, 0, 0, 551.29, 228.71, 0, 0, 0, 1, 0]}
"""
HEADER = header_of(1700000000.0333333, "robot1/CameraTop_optical_frame")
PICTURE = Picture(5.0, 0, 4, 2, "bgr8", bytes(range(24)))


def refused(told, function, *arguments):
    with pytest.raises(NaoError, match=told):
        function(*arguments)


def image(space, width, height, layers, pixels, camera=0):
    return [width, height, layers, space, 7, 250000, pixels, camera, 0.49, 0.38, -0.49, -0.38]


@pytest.mark.parametrize(
    "space, encoding, layers", [(13, "bgr8", 3), (11, "rgb8", 3), (0, "mono8", 1), (10, "8UC3", 3), (6, "8UC1", 1)]
)
def test_colour_spaces_are_encodings(space, encoding, layers):
    pixels = bytes(range(24 * layers))
    picture = read_picture(image(space, 6, 4, layers, pixels, camera=1), 0)
    assert (picture.encoding, picture.step, picture.camera) == (encoding, 6 * layers, 1)
    assert (picture.width, picture.height, picture.time) == (6, 4, 7.25)
    assert picture.pixels is pixels


def test_yuv422_of_ros_has_colour_before_brightness_and_what_is_no_picture_is_told():
    picture = read_picture(image(9, 2, 2, 2, b"YUyVZWzX"), 0)
    assert (picture.encoding, picture.step, picture.pixels) == ("yuv422", 4, b"UYVyWZXz")
    assert read_picture(image(0, 2, 1, 1, b"ab")[:7], 1).camera == 1  # an answer without the camera
    refused("no picture but None", read_picture, None, 0)
    refused("colour space 17", read_picture, image(17, 2, 1, 2, b"abcd"), 0)
    refused("2x2 in bgr8 has 11 bytes, not 12", read_picture, image(13, 2, 2, 3, bytes(11)), 0)


def test_a_picture_is_a_message_without_a_copy_of_its_pixels():
    message = to_image(PICTURE, HEADER)
    assert message.data is PICTURE.pixels and message.header.stamp == HEADER.stamp
    assert (message.width, message.height, message.step, message.encoding) == (4, 2, 12, "bgr8")
    assert (HEADER.stamp.secs, HEADER.stamp.nsecs) == (1700000000, 33333000)  # to the microsecond
    assert header_of(0.9999999, "").stamp.to_sec() == 1.0
    message = to_compressed("bgr8; png compressed bgr8", b"file", HEADER)
    assert (message.format, message.data) == ("bgr8; png compressed bgr8", b"file")
    assert message.header.frame_id == "robot1/CameraTop_optical_frame"


ROWS, COLUMNS = np.mgrid[0:48, 0:64]
SCENE = np.dstack((COLUMNS * 4, ROWS * 5, 255 - COLUMNS * 2 - ROWS)).astype(np.uint8)
"""Blue, green and red that change slowly."""


def compressed(encoding, pixels, *how):
    kind, file = compress(Picture(0.0, 0, 64, 48, encoding, pixels.tobytes()), *how)
    return kind, cv2.imdecode(np.frombuffer(file, np.uint8), cv2.IMREAD_UNCHANGED), len(file)


def test_png_is_the_same_picture_and_jpeg_looks_the_same_and_quality_costs_bytes():
    for encoding, pixels, shown in (("bgr8", SCENE, SCENE), ("rgb8", SCENE[..., ::-1], SCENE)):
        kind, found, _ = compressed(encoding, pixels, "png", 80, 3)
        assert kind == f"{encoding}; png compressed bgr8"
        np.testing.assert_array_equal(found, shown)
    kind, found, _ = compressed("mono8", SCENE[..., 0], "png", 80, 3)
    assert kind == "mono8; png compressed "
    np.testing.assert_array_equal(found, SCENE[..., 0])
    kind, found, good = compressed("bgr8", SCENE, "jpeg", 95, 3)
    assert kind == "bgr8; jpeg compressed bgr8" and np.abs(found.astype(int) - SCENE).mean() < 6.0
    assert compressed("bgr8", SCENE, "jpeg", 30, 3)[2] < good < SCENE.nbytes
    with pytest.raises(NaoError, match="not 8UC3: choose another color_space"):
        compressed("8UC3", SCENE, "jpeg", 80, 3)


def test_the_ideal_camera_sees_its_field_of_view_and_scaling_keeps_distortion_and_the_last_rows():
    found = ideal(640, 480, HFOV, VFOV)
    fx, _, cx, _, fy, cy = found.k[:6]
    assert (fx, fy) == (pytest.approx(598.05, abs=0.1), pytest.approx(598.53, abs=0.1))
    assert (cx, cy) == (320.0, 240.0)
    # The edges of the picture are at the edges of the field of view.
    assert cx + fx * math.tan(HFOV / 2) == pytest.approx(640.0)
    assert cy - fy * math.tan(VFOV / 2) == pytest.approx(0.0)
    assert found.p == (fx, 0.0, cx, 0.0, 0.0, fy, cy, 0.0, 0.0, 0.0, 1.0, 0.0)
    assert found.d == (0.0,) * 5
    found = scaled(MEASURED, 320, 240)
    assert found.k == pytest.approx((278.4225, 0, 154.6835, 0, 277.9495, 115.296, 0, 0, 1))
    assert found.p == pytest.approx((275.795, 0, 154.48, 0, 0, 275.645, 114.355, 0, 0, 0, 1, 0))
    assert found.d == MEASURED.d and (found.width, found.height, found.name) == (320, 240, NAME)
    refused("640x480 is of no use for 1280x720", scaled, MEASURED, 1280, 720)
    refused("0x0", Calibration, 0, 0, (1.0,) * 9)


def test_calibrations_are_written_and_read():
    assert from_yaml(FILE) == MEASURED == from_yaml(to_yaml(MEASURED))
    assert "camera_matrix:\n  rows: 3\n  cols: 3\n  data: [556.845, " in to_yaml(MEASURED)
    found = from_yaml(FILE[: FILE.index("rectification_matrix")])
    assert found.r == (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
    assert found.p[:4] == (556.845, 0.0, 309.367, 0.0)  # that of its camera
    refused("no calibration", from_yaml, "just words")
    for good, bad, problem in (
        ("image_width: 640", "", "no image_width"),
        ("image_height: 480", "image_height: 0", "640x0 pixels"),
        ("556.845", "wide", "something else than numbers"),
        ("556.845", "0", "focal lengths above 0"),
        ("556.845", ".nan", "K of a calibration has 9 finite numbers"),
    ):
        refused(problem, from_yaml, FILE.replace(good, bad))


def test_a_calibration_is_a_message_and_back():
    info = to_info(MEASURED, 640, 480, HEADER)
    assert (info.width, info.height, info.distortion_model) == (640, 480, "plumb_bob")
    assert (list(info.K), list(info.P)) == (list(MEASURED.k), list(MEASURED.p))
    assert from_info(info) == replace(MEASURED, name="")
    nothing = to_info(None, PICTURE.width, PICTURE.height, HEADER)
    assert (nothing.width, nothing.height, nothing.K[0], list(nothing.D)) == (4, 2, 0.0, [])
    refused("focal lengths above 0", from_info, nothing)
    known = ideal(320, 240, *FOV)
    found = from_info(CameraInfo(width=320, height=240, K=list(known.k)))
    assert (found.p, found.r, found.model) == (known.p, known.r, "plumb_bob")


@pytest.fixture
def home(tmp_path, monkeypatch):
    monkeypatch.setenv("ROS_HOME", str(tmp_path / "home"))
    return tmp_path / "home"


@pytest.fixture
def infos(home, tmp_path):
    return CameraInfos(NAME, {"calibrations": str(tmp_path / "package")}.__getitem__)


def calibration(width=320, height=240, fov=OTHER_FOV):
    return replace(ideal(width, height, *fov), name=NAME)


def test_what_was_set_holds_in_later_runs_and_is_scaled_to_other_sizes(infos, home, caplog):
    assert infos.of(320, 240) is None
    for fov in (OTHER_FOV, FOV):
        infos.set_fov(*fov)
        assert infos.of(320, 240).k == ideal(320, 240, *fov).k
    assert "computed" in infos.source(320, 240)
    assert infos.set(calibration()) == home / "camera_info" / f"{NAME}.yaml"
    assert infos.of(320, 240).k == calibration().k
    later = CameraInfos(NAME, str)
    assert (later.of(320, 240).k, later.of(320, 240).name) == (calibration().k, NAME)
    with caplog.at_level(logging.WARNING):
        assert infos.of(640, 480).k == pytest.approx(calibration(640, 480).k)
        assert infos.of(640, 480) is infos.of(640, 480)
    assert caplog.text.count("scaled to 640x480") == 1
    assert infos.set(calibration(640, 480, FOV)).name == f"{NAME}_640x480.yaml"  # every size may have its own
    assert infos.of(640, 480).k == calibration(640, 480, FOV).k and infos.of(320, 240).k == calibration().k


def test_a_url_names_the_file_and_what_is_set_goes_there(infos, tmp_path):
    path = tmp_path / "package" / "share" / f"{NAME}.yaml"
    write(path, calibration())
    infos.set_url("package://calibrations/share/${NAME}.yaml")
    assert infos.of(320, 240).k == calibration().k
    assert infos.set(calibration(fov=FOV)) == path
    infos.set_url(f"file://{path}")
    refused(r"missing.yaml cannot be read", infos.set_url, f"file://{tmp_path}/missing.yaml")
    assert infos.of(320, 240).k == calibration(fov=FOV).k  # the one before holds
    assert path_of("file://${ROS_HOME}/a%20b.yaml", NAME, str) == tmp_path / "home" / "a b.yaml"
    assert camera_name("/robot 1/nao_camera_top") == "robot_1_nao_camera_top"
    for url in ("http://host/a.yaml", "/a.yaml", "file://a.yaml", "package://", "package://a"):
        refused("camera_info_url is", path_of, url, NAME, lambda package: "/")


@pytest.mark.parametrize("content", [b"{", b"\xff\xfe", b"image_width: .inf\nimage_height: 1\n", b"[" * 9999])
def test_a_file_that_is_no_calibration_is_kept_when_one_is_set(infos, home, caplog, content):
    path = home / "camera_info" / f"{NAME}.yaml"
    path.parent.mkdir(parents=True)
    path.write_bytes(content)
    infos.set_fov(*FOV)
    assert infos.of(320, 240).k == ideal(320, 240, *FOV).k and str(path) in caplog.text
    assert infos.set(calibration()) == path and infos.of(320, 240).k == calibration().k
    assert (path.parent / f"{NAME}.yaml.broken").read_bytes() == content


def values(**changes):
    return {**{field.name: field.default for field in fields_of(1, 15.0, True, 0, False)}, **changes}


def test_what_the_robot_is_asked_for():
    alone = {field.name: field.default for field in fields_of(2, 10.0, False, 1, alone=True)}
    assert set(alone) == {*values(), "source"}
    assert (alone["source"], alone["resolution"], alone["frame_rate"]) == (1, 2, 10.0)
    assert stream_settings(values(), 1) == StreamSettings(1, 1, 13, 15)
    assert stream_settings(values(source=0, frame_rate=7.6, color_space=9), 1) == StreamSettings(0, 1, 9, 8)
    for change, automatic in (
        ({"exposure": 100}, "auto_exposition"),
        ({"gain": 100}, "auto_exposition"),
        ({"white_balance": 4000}, "auto_white_balance"),
    ):
        after = settled(values(), values(**change))
        assert after == values(**change, **{automatic: 0})  # a fixed value ends the automatic, unless that is asked for
        assert changed_tunings(values(), after) == {**change, automatic: 0}
        assert settled(values(**{automatic: 0}), values(**{automatic: 1}, **change))[automatic] == 1
    assert settled(values(), values(frame_rate=7.6))["frame_rate"] == 8.0
    refused("resolution is 5: one of 0 .160x120., 1 .320x240.", stream_settings, values(resolution=5), 0)
    refused("color_space is 14: one of 0 .Yuv", stream_settings, values(color_space=14), 0)
    refused("source is 2: one of 0 .top., 1 .bottom.", stream_settings, values(source=2), 0)
