"""ALVideoDevice over the network: pictures, subscribers, parameters, cameras, angles, files."""

import math

import numpy as np
import pytest
from disks import room

import vision_definitions as vd

TOP, BOTTOM = 0, 1
HFOV, VFOV = math.radians(56.3), math.radians(43.7)
RGB, BGR, YUV422, GREY = vd.kRGBColorSpace, vd.kBGRColorSpace, vd.kYUV422ColorSpace, vd.kYuvColorSpace
AUTO = (vd.kCameraAutoExpositionID, vd.kCameraAutoWhiteBalanceID)


@pytest.mark.parametrize(
    "camera, resolution, space, size, layers",
    [(TOP, vd.kQVGA, RGB, (320, 240), 3), (BOTTOM, vd.kQQVGA, BGR, (160, 120), 3)]
    + [(TOP, vd.kVGA, YUV422, (640, 480), 2), (TOP, vd.kQQQVGA, GREY, (80, 60), 1)],
)
def test_a_picture_is_naoqis_container_with_raw_bytes(robot, video, image, camera, resolution, space, size, layers):
    taken = image(video.subscribeCamera("looker", camera, resolution, space, 30))
    assert len(taken) == 12 and taken[:4] == [*size, layers, space] and taken[7] == camera
    assert taken[4] + taken[5] * 1e-6 == pytest.approx(robot.now.time, abs=1 / 30)
    assert isinstance(taken[6], (bytes, bytearray)) and len(taken[6]) == size[0] * size[1] * layers
    assert taken[8:] == pytest.approx([HFOV / 2, VFOV / 2, -HFOV / 2, -VFOV / 2])
    assert np.frombuffer(bytes(taken[6]), np.uint8).std() > 5, "there is something to see"


def test_blue_and_red_change_places_from_rgb_to_bgr_of_the_same_moment(robot, video, pixels):
    for number in AUTO:
        video.setParameter(TOP, number, 0)
    handles = [video.subscribeCamera(name, TOP, vd.kQVGA, space, 30) for name, space in (("rgb", RGB), ("bgr", BGR))]
    robot.advance(1 / 30)
    rgb, bgr = (pixels(handle, after=0) for handle in handles)
    assert np.array_equal(rgb, bgr[..., ::-1])


def test_both_cameras_at_once(video, image):
    handle = video.subscribeCameras("both", [BOTTOM, TOP], [vd.kQVGA, vd.kQQVGA], [RGB, GREY], 15)
    bottom, top = image(handle, "getImagesRemote")
    assert [(one[7], one[0], one[2]) for one in (bottom, top)] == [(BOTTOM, 320, 3), (TOP, 160, 1)]
    assert bottom[4:6] == top[4:6]
    assert video.setResolutions(handle, [vd.kQQVGA] * 2) == video.setColorSpaces(handle, [GREY] * 2) == [True, True]
    assert video.setActiveCameras(handle, [TOP, BOTTOM]) == [True, True]
    seen = image(handle, "getImagesRemote", after=0.1)
    assert [(one[7], one[0], one[2]) for one in seen] == [(TOP, 160, 1), (BOTTOM, 160, 1)]
    with pytest.raises(RuntimeError, match="looks through several cameras; use getImagesRemote"):
        video.getImageRemote(handle)


def test_handles_of_one_name(video):
    handles = [video.subscribeCamera("looker", TOP, vd.kQVGA, RGB, 15) for _ in range(6)]
    assert handles == [f"looker_{number}" for number in range(6)]
    with pytest.raises(RuntimeError, match="ALVideoDevice::subscribeCamera name is 'looker', allowed is another one"):
        video.subscribeCamera("looker", TOP, vd.kQVGA, RGB, 15)
    assert video.subscribe("old", vd.kQVGA, RGB, 15) == "old_0"
    video.unsubscribeAllInstances("looker")
    assert video.getSubscribers() == ["old_0"]
    video.onClientDisconnected("ClientDisconnected", "old", "")
    assert video.getSubscribers() == []


def test_what_a_subscriber_sees_can_be_changed_and_the_active_camera_is_that_of_old_programs(video, image):
    handle = video.subscribeCamera("looker", TOP, vd.kQVGA, RGB, 15)
    assert video.setResolution(handle, vd.kQQVGA) and video.setColorSpace(handle, 0) and video.setFrameRate(handle, 30)
    assert video.setActiveCamera(handle, BOTTOM)
    assert (video.getResolution(handle), video.getColorSpace(handle), video.getFrameRate(handle)) == (0, 0, 30)
    assert video.getActiveCamera(handle) == BOTTOM and video.getActiveCamera() == TOP
    assert image(handle)[:4] == [160, 120, 1, 0]
    assert video.getResolution(BOTTOM) == 0 and video.getFrameRate(BOTTOM) == 30 and video.getColorSpace(BOTTOM) == 9
    assert video.setActiveCamera(BOTTOM) is True and video.getActiveCamera() == BOTTOM
    assert image(video.subscribe("old", vd.kQQVGA, GREY, 10))[7] == BOTTOM
    video.setParam(vd.kCameraSelectID, TOP)
    assert video.getParam(vd.kCameraSelectID) == TOP == video.getActiveCamera()


def test_parameters_change_the_picture_and_go_back(robot, video, pixels):
    handle = video.subscribeCamera("looker", TOP, vd.kQQVGA, RGB, 30)
    for number in AUTO:
        assert video.setCameraParameter(handle, number, 0) is True
    plain = pixels(handle)
    video.setParameter(TOP, vd.kCameraBrightnessID, 40)
    brighter = pixels(handle)
    assert (brighter - plain)[(plain > 5) & (plain < 210)].mean() == pytest.approx(40, abs=1)
    video.setParameter(TOP, vd.kCameraBrightnessID, 0)
    video.setParameter(TOP, vd.kCameraHFlipID, 1)
    assert np.abs(pixels(handle)[:, ::-1] - plain).mean() < 3
    assert video.setAllCameraParametersToDefault(handle) is True
    assert video.getCameraParameter(handle, vd.kCameraAutoExpositionID) == 1
    pixels(handle)
    assert video.getParameter(TOP, vd.kCameraAverageLuminanceID) == pytest.approx(135, abs=6)


def test_a_camera_runs_while_somebody_looks_or_it_is_kept_alive_or_started(video):
    def states(*camera):
        return video.isCameraOpen(*camera), video.isCameraStarted(*camera)

    assert states(TOP) == (False, False)
    handle = video.subscribeCamera("looker", TOP, vd.kQVGA, RGB, 15)
    assert states(TOP) == (True, True) and states(BOTTOM) == (False, False)
    video.setParameter(TOP, vd.kCameraKeepAliveID, 1)
    video.unsubscribe(handle)
    assert states(TOP) == (True, True)
    video.setParameter(TOP, vd.kCameraKeepAliveID, 0)
    assert states(TOP) == (False, False)
    assert video.isFrameGrabberOff() is True and video.startFrameGrabber(BOTTOM) is True
    assert video.isFrameGrabberOff(BOTTOM) is False and video.isFrameGrabberOff() is True
    assert states(BOTTOM)[1] and video.startFrameGrabber() is True and states(TOP)[1]
    assert video.stopFrameGrabber(BOTTOM) is True and video.isFrameGrabberOff(BOTTOM) is True


def test_a_camera_that_is_stopped_or_closed_gives_no_pictures(robot, video, image):
    handle = video.subscribeCamera("looker", TOP, vd.kQQVGA, 0, 30)
    image(handle)
    waiting = robot.post("ALVideoDevice", "getImageRemote", handle)
    robot.handed_over("ALVideoDevice")
    assert video.stopCamera(TOP) is True
    assert "camera 0 gives no pictures, it is stopped: startCamera lets it go on" in waiting.error()
    assert video.isCameraOpen(TOP) and not video.isCameraStarted(TOP)
    assert video.startCamera(TOP) is True and image(handle)[0] == 160
    assert video.closeCamera(TOP) is True and not video.isCameraOpen(TOP)
    with pytest.raises(RuntimeError, match="it is closed: openCamera and startCamera"):
        video.getImageRemote(handle)
    assert image(video.subscribeCamera("other", TOP, vd.kQQVGA, 0, 30))[0] == 160, "a new subscriber lets it run"


def test_pictures_from_outside_are_what_the_camera_sees(robot, video, pixels):
    proxy, handle = robot.proxy("ALVideoDevice"), video.subscribeCamera("looker", TOP, vd.kQQVGA, RGB, 30)
    for number in AUTO:
        video.setParameter(TOP, number, 0)
    assert video.getExpectedImageParameters(TOP) == video.getExpectedImageParameters() == [vd.kQQVGA, 30]
    assert video.getExpectedImageParameters(BOTTOM) == [vd.kQVGA, 5]
    picture = np.zeros((240, 320, 3), np.uint8)
    picture[:, :160] = (200, 20, 60)
    assert proxy.putImage(TOP, 320, 240, picture.tobytes()) is True
    seen = pixels(handle)
    assert seen[:, :78].reshape(-1, 3).mean(axis=0) == pytest.approx((200, 20, 60), abs=1)
    assert seen[:, 82:].mean() < 2
    assert video.resetCamera(TOP) is True and pixels(handle).std() > 5


def test_raw_pictures_go_to_a_file(robot, video):
    handle = video.subscribeCamera("looker", TOP, vd.kQQVGA, GREY, 30)
    assert video.recordVideo(handle, "films/raw.bin", 4, 2) is True
    with pytest.raises(RuntimeError, match="'looker_0' records already"):
        video.recordVideo(handle, "films/other.bin", 4, 2)
    robot.advance(0.11)  # frames at 0, 1/30, 2/30, 3/30: two of them are recorded
    assert video.stopVideo(handle) is True
    path = robot.server.files.folder / "films" / "raw.bin"
    assert path.stat().st_size == 2 * 160 * 120 and np.frombuffer(path.read_bytes(), np.uint8).std() > 5


def test_raw_pictures_that_had_no_room_are_told_of_at_the_end_and_the_next_ones_go_to_a_file(robot, video):
    handle = video.subscribeCamera("looker", TOP, vd.kQQVGA, GREY, 30)
    with room(30000):
        video.recordVideo(handle, "raw.bin", 100, 1)
        robot.advance(0.2)
        with pytest.raises(RuntimeError, match="raw.bin cannot be written: File too large, .* MB free in"):
            video.stopVideo(handle)
    assert (robot.server.files.folder / "raw.bin").stat().st_size == 160 * 120
    assert video.recordVideo(handle, "raw.bin", 2, 1) is True
    robot.advance(0.2)
    assert (robot.server.files.folder / "raw.bin").stat().st_size == 2 * 160 * 120


def test_calls_that_tell_success_are_false_for_a_handle_that_nobody_has(robot, video):
    handle = video.subscribeCamera("looker", TOP, vd.kQVGA, RGB, 15)
    calls = (
        ("unsubscribe",),
        ("releaseImage",),
        ("setCameraParameter", 18, 1),
        ("setResolution", 1),
        ("setFrameRate", 5),
    )
    assert [getattr(video, name)("looker", *rest) for name, *rest in calls] == [False] * len(calls)
    assert video.getSubscribers() == [handle] and video.getActiveCamera(handle) == TOP


def test_the_parameter_that_was_the_active_camera_selects_it(robot, video):
    handle = video.subscribeCamera("looker", TOP, vd.kQVGA, RGB, 15)
    assert video.setCameraParameter(handle, vd.kCameraSelectID, 1) is True
    assert video.getActiveCamera(handle) == 1


def test_a_rate_above_that_of_the_camera_is_that_of_the_camera(robot, video):
    handle = video.subscribeCamera("looker", TOP, vd.kQVGA, RGB, 60)
    assert video.getFrameRate(handle) == 30
    assert video.setFrameRate(handle, 10) is video.setFrameRate(handle, 100) is True
    assert video.getFrameRate(handle) == 30


NOBODY = "'nobody_0' is not subscribed; subscribed is 'looker_0'"
REFUSED = [
    ("getImageRemote", ("nobody_0",), NOBODY),
    ("subscribeCamera", ("looker", 2, 1, 11, 15), "camera is 2, allowed is one of 0"),
    ("subscribeCamera", ("looker", 0, 5, 11, 15), "resolution is 5, allowed is one of"),
    ("subscribeCamera", ("looker", 0, 1, 17, 15), "needs a depth camera"),
    ("subscribeCamera", ("looker", 0, 1, 11, 0), "fps is 0, allowed is 1 to 30"),
    ("subscribeCameras", ("looker", [0], [1, 1], [11], 15), "resolutions .* allowed is a list of 1 whole numbers"),
    *((f"get{k}Local", ("looker_0",), f"own process; use get{k}Remote") for k in ("Image", "Images")),
    ("recordVideo", ("looker_0", "../outside", 4, 1), "is not inside"),
    ("recordVideo", ("looker_0", "raw.bin", 0, 1), "totalNumber is 0"),
    ("setParameter", (0, 1, 256), "kCameraContrastID is 256, allowed is 0 to 255"),
    *(("getParameter", (3, 1), "camera is 3"), ("getParameterRange", (0, 33), "parameter is 33")),
    ("putImage", (0, 4, 4, bytes(47)), r"length of imageBuffer is 47, allowed is 48: 3 bytes \(RGB\) a pixel, 4x4"),
    *(("getImagePositionFromAngularPosition", (TOP, wrong), "AngularPosition") for wrong in ([0.1], [0.1, 2.0])),
]


def test_what_an_automatic_chooses_cannot_be_set(video):
    gain, exposure, automatic = 6, 17, 11
    assert [video.setParameter(TOP, number, 40) for number in (gain, exposure)] == [False, False]
    assert video.setParameter(TOP, automatic, 0) and video.setParameter(TOP, gain, 40)
    assert video.getParameter(TOP, gain) == 40


def test_what_is_refused_names_what_is_allowed_and_changes_nothing(robot, video):
    video.subscribeCamera("looker", TOP, vd.kQVGA, RGB, 15)
    proxy = robot.proxy("ALVideoDevice")
    for method, arguments, text in REFUSED:
        with pytest.raises(RuntimeError, match=rf"ALVideoDevice\.{method} failed: .*{text}"):
            getattr(proxy, method)(*arguments)
    assert video.getSubscribers() == ["looker_0"] and video.getParameter(TOP, 1) == 32
