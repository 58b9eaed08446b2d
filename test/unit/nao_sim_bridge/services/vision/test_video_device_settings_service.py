"""ALVideoDevice over the network: parameters, cameras, pictures from outside, angles."""

from __future__ import annotations

import math

import numpy as np
import pytest
from naoqi_images import pixels

import vision_definitions as vd

TOP, BOTTOM = 0, 1
HFOV, VFOV = math.radians(56.3), math.radians(43.7)


# --- parameters ---------------------------------------------------------------------------------------------------


def test_parameters_change_the_picture(video, image):
    handle = video.subscribeCamera("looker", TOP, vd.kQQVGA, vd.kRGBColorSpace, 30)
    for number in (vd.kCameraAutoExpositionID, vd.kCameraAutoWhiteBalanceID):
        assert video.setCameraParameter(handle, number, 0) is True
    plain = pixels(image(handle)).astype(int)
    video.setParameter(TOP, vd.kCameraBrightnessID, 40)
    brighter = pixels(image(handle)).astype(int)
    free = (plain > 5) & (plain < 210)
    assert (brighter - plain)[free].mean() == pytest.approx(40, abs=1)
    video.setParameter(TOP, vd.kCameraBrightnessID, 0)
    video.setParameter(TOP, vd.kCameraHFlipID, 1)
    assert np.abs(pixels(image(handle)).astype(int)[:, ::-1] - plain).mean() < 3
    assert video.setAllCameraParametersToDefault(handle) is True
    assert video.getCameraParameter(handle, vd.kCameraAutoExpositionID) == 1
    image(handle)
    assert video.getParameter(TOP, vd.kCameraAverageLuminanceID) == pytest.approx(135, abs=6)


def test_facts_about_parameters(video):
    handle = video.subscribeCamera("looker", BOTTOM, vd.kQVGA, 11, 15)
    assert video.getParameterRange(TOP, vd.kCameraContrastID) == [0, 255]
    assert video.getCameraParameterRange(handle, vd.kCameraHueID) == [-180, 180]
    video.setCameraParameter(handle, vd.kCameraContrastID, 50)
    assert dict(video.getCameraParameterInfo(handle, vd.kCameraContrastID)) == {
        "name": "kCameraContrastID",
        "value": 50,
        "min": 0,
        "max": 255,
        "default": 32,
    }
    assert video.getParameter(TOP, vd.kCameraContrastID) == 32
    assert video.setCameraParameterToDefault(handle, vd.kCameraContrastID) is True
    assert video.getParameter(BOTTOM, vd.kCameraContrastID) == 32


def test_parameters_of_old_programs(video):
    video.setParam(vd.kCameraContrastID, 40)
    video.setParam(vd.kCameraContrastID, 41, BOTTOM)
    assert video.getParam(vd.kCameraContrastID) == 40 and video.getParam(vd.kCameraContrastID, BOTTOM) == 41
    video.setParamDefault(vd.kCameraContrastID)
    assert video.getParam(vd.kCameraContrastID) == 32
    video.setParam(vd.kCameraSetDefaultParamsID, 1, BOTTOM)
    assert video.getParam(vd.kCameraContrastID, BOTTOM) == 32


@pytest.mark.parametrize(
    "method, arguments, text",
    [
        ("setParameter", (0, 1, 256), "kCameraContrastID is 256, allowed is 0 to 255"),
        ("setParameter", (0, 99, 1), r"parameter is 99, allowed is one of 0 \(kCameraBrightnessID\)"),
        ("setParameter", (0, 17, 5), "while kCameraAutoExpositionID is 1; set it to 0 first"),
        ("getParameter", (3, 1), "camera is 3"),
        ("getParameterRange", (0, 33), "parameter is 33"),
        ("setAllParametersToDefault", (5,), "camera is 5"),
    ],
)
def test_wrong_parameters_are_told(video, method, arguments, text):
    with pytest.raises(RuntimeError, match=f"ALVideoDevice::{method} .*{text}"):
        getattr(video, method)(*arguments)


# --- cameras ------------------------------------------------------------------------------------------------------


def test_what_cameras_there_are(video):
    assert video.getCameraIndexes() == [0, 1]
    assert [video.getCameraName(camera) for camera in (TOP, BOTTOM)] == ["CameraTop", "CameraBottom"]
    assert video.getCameraModel(TOP) == video.getCameraModelID() == vd.kOV5640
    assert video.hasDepthCamera() is False
    assert video.getHorizontalFOV(TOP) == video.getHorizontalAperture(TOP) == pytest.approx(HFOV)
    assert video.getVerticalFOV(BOTTOM) == video.getVerticalAperture(BOTTOM) == pytest.approx(VFOV)


def test_a_camera_runs_while_somebody_looks(video):
    assert not video.isCameraOpen(TOP) and not video.isCameraStarted(TOP)
    handle = video.subscribeCamera("looker", TOP, vd.kQVGA, 11, 15)
    assert video.isCameraOpen(TOP) and video.isCameraStarted(TOP) and not video.isCameraOpen(BOTTOM)
    video.setParameter(TOP, vd.kCameraKeepAliveID, 1)
    video.unsubscribe(handle)
    assert video.isCameraOpen(TOP) and video.isCameraStarted(TOP)
    video.setParameter(TOP, vd.kCameraKeepAliveID, 0)
    assert not video.isCameraOpen(TOP)


def test_a_camera_that_is_stopped_gives_no_pictures(robot, video, image):
    handle = video.subscribeCamera("looker", TOP, vd.kQQVGA, 0, 30)
    image(handle)
    waiting = robot.post("ALVideoDevice", "getImageRemote", handle)
    robot.handed_over("ALVideoDevice")
    assert video.stopCamera(TOP) is True
    assert "camera 0 gives no pictures, it is stopped: startCamera lets it go on" in waiting.error()
    assert video.isCameraOpen(TOP) and not video.isCameraStarted(TOP)
    with pytest.raises(RuntimeError, match="camera 0 gives no pictures, it is stopped"):
        video.getImageRemote(handle)
    assert video.startCamera(TOP) is True
    assert image(handle)[0] == 160


def test_a_camera_that_is_closed_has_to_be_opened_and_started(video, image):
    handle = video.subscribeCamera("looker", TOP, vd.kQQVGA, 0, 30)
    assert video.closeCamera(TOP) is True
    assert not video.isCameraOpen(TOP)
    with pytest.raises(RuntimeError, match="it is closed: openCamera and startCamera"):
        video.getImageRemote(handle)
    with pytest.raises(RuntimeError, match="camera 0 is closed; open it with openCamera first"):
        video.startCamera(TOP)
    assert video.openCamera(TOP) is True
    with pytest.raises(RuntimeError, match="it is stopped"):
        video.getImageRemote(handle)
    video.startCamera(TOP)
    assert image(handle)[0] == 160


def test_frame_grabbers(video):
    assert video.isFrameGrabberOff() is True
    assert video.startFrameGrabber(BOTTOM) is True
    assert video.isFrameGrabberOff(BOTTOM) is False and video.isFrameGrabberOff() is True
    assert video.isCameraStarted(BOTTOM) is True
    assert video.startFrameGrabber() is True and video.isCameraStarted(TOP) is True
    assert video.stopFrameGrabber(BOTTOM) is True and video.isFrameGrabberOff(BOTTOM) is True
    assert video.stopFrameGrabber() is True


def test_a_new_subscriber_lets_a_stopped_camera_run(video, image):
    video.closeCamera(TOP)
    assert image(video.subscribeCamera("looker", TOP, vd.kQQVGA, 0, 30))[0] == 160


# --- pictures from outside ----------------------------------------------------------------------------------------


def test_pictures_from_outside_are_what_the_camera_sees(video, proxy, image):
    handle = video.subscribeCamera("looker", TOP, vd.kQQVGA, vd.kRGBColorSpace, 30)
    for number in (vd.kCameraAutoExpositionID, vd.kCameraAutoWhiteBalanceID):
        video.setParameter(TOP, number, 0)
    assert video.getExpectedImageParameters(TOP) == [vd.kQQVGA, 30]
    assert video.getExpectedImageParameters() == [vd.kQQVGA, 30]
    picture = np.zeros((240, 320, 3), np.uint8)
    picture[:, :160] = (200, 20, 60)
    assert proxy.putImage(TOP, 320, 240, picture.tobytes()) is True
    seen = pixels(image(handle))
    assert seen[:, :78].reshape(-1, 3).mean(axis=0) == pytest.approx((200, 20, 60), abs=1)
    assert seen[:, 82:].mean() < 2
    assert video.setSimCamInputSize(40, 30) is True
    assert proxy.putImage(np.full((30, 40, 3), 99, np.uint8).tobytes()) is True
    assert pixels(image(handle)).mean() == pytest.approx(99, abs=0.5)
    assert video.resetCamera(TOP) is True
    assert pixels(image(handle)).std() > 5


@pytest.mark.parametrize(
    "arguments, text",
    [
        ((0, 4, 4, bytes(47)), r"length of imageBuffer is 47, allowed is 48: 3 bytes \(RGB\) a pixel, 4x4"),
        ((0, 1, 4, bytes(12)), "width is 1"),
        ((2, 4, 4, bytes(48)), "camera is 2"),
        ((5,), r"imageBuffer is 5, allowed is \d+ raw bytes"),
        ((0, 4000, 4000, bytes(48)), "at most 4915200 pixels"),
    ],
)
def test_wrong_pictures_are_told(proxy, arguments, text):
    with pytest.raises(RuntimeError, match=text):
        proxy.putImage(*arguments)


# --- angles -------------------------------------------------------------------------------------------------------


def test_angles_and_places(video):
    assert video.getAngularPositionFromImagePosition(TOP, [0.5, 0.5]) == pytest.approx([0.0, 0.0])
    assert video.getAngularPositionFromImagePosition(TOP, [0.0, 1.0]) == pytest.approx([HFOV / 2, VFOV / 2])
    alpha, beta = video.getAngPosFromImgPos([0.3, 0.8])
    assert video.getImagePositionFromAngularPosition(TOP, [alpha, beta]) == pytest.approx([0.3, 0.8])
    assert video.getImgPosFromAngPos([alpha, beta]) == pytest.approx([0.3, 0.8])
    assert video.getAngularSizeFromImageSize(BOTTOM, [1.0, 1.0]) == pytest.approx([HFOV, VFOV])
    assert video.getAngSizeFromImgSize([1.0, 1.0]) == pytest.approx([HFOV, VFOV])
    width, height = video.getImageSizeFromAngularSize(TOP, [0.2, 0.1])
    assert video.getImgSizeFromAngSize([0.2, 0.1]) == pytest.approx([width, height])
    info = [alpha, beta, 0.2, 0.1]
    assert video.getImageInfoFromAngularInfo(TOP, info) == pytest.approx([0.3, 0.8, width, height])
    assert video.getImgInfoFromAngInfo(info) == pytest.approx([0.3, 0.8, width, height])
    in_pixels = [0.3 * 640, 0.8 * 480, width * 640, height * 480]
    assert video.getImageInfoFromAngularInfoWithResolution(TOP, info, vd.kVGA) == pytest.approx(in_pixels, rel=1e-5)
    assert video.getImgInfoFromAngInfoWithRes(info, vd.kVGA) == pytest.approx(in_pixels, rel=1e-5)
    assert video.resolutionToSizes(vd.kVGA) == [640, 480]
    assert video.sizesToResolution(320, 240) == vd.kQVGA and video.sizesToResolution(3, 4) == -1
    for wrong in ([0.1], [0.1, 2.0], [math.nan, 0.0]):
        with pytest.raises(RuntimeError, match="AngularPosition"):
            video.getImagePositionFromAngularPosition(TOP, wrong)
