"""ALVideoDevice over the network: pictures, subscribers, files."""

from __future__ import annotations

import math
import os
import queue
import subprocess
import sys

import numpy as np
import pytest
import qi
from naoqi_images import pixels

import vision_definitions as vd

TOP, BOTTOM = 0, 1
HFOV, VFOV = math.radians(56.3), math.radians(43.7)


# --- pictures -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "camera, resolution, color_space, size, layers",
    [
        (TOP, vd.kQVGA, vd.kRGBColorSpace, (320, 240), 3),
        (BOTTOM, vd.kQQVGA, vd.kBGRColorSpace, (160, 120), 3),
        (TOP, vd.kVGA, vd.kYUV422ColorSpace, (640, 480), 2),
        (TOP, vd.kQQQVGA, vd.kYuvColorSpace, (80, 60), 1),
    ],
)
def test_a_picture_is_naoqis_container_with_raw_bytes(
    robot, video, image, camera, resolution, color_space, size, layers
):
    handle = video.subscribeCamera("looker", camera, resolution, color_space, 30)
    taken = image(handle)
    assert len(taken) == 12
    assert taken[:4] == (*size, layers, color_space)
    assert taken[4] + taken[5] * 1e-6 == pytest.approx(robot.now.time, abs=1 / 30)
    assert isinstance(taken[6], (bytes, bytearray)) and len(taken[6]) == size[0] * size[1] * layers
    assert taken[7] == camera
    assert taken[8:] == pytest.approx((HFOV / 2, VFOV / 2, -HFOV / 2, -VFOV / 2))
    assert pixels(taken).std() > 5, "there is something to see"


def test_a_picture_through_the_proxy_of_the_sdk(robot, video, proxy):
    handle = proxy.subscribeCamera("script", TOP, vd.kQVGA, vd.kRGBColorSpace, 30)
    robot.advance(0.1)
    taken = proxy.getImageRemote(handle)
    assert isinstance(taken[6], bytes) and len(taken[6]) == 230400
    assert proxy.releaseImage(handle) is True
    assert proxy.unsubscribe(handle) is True


def test_blue_and_red_change_places_from_rgb_to_bgr(video, image):
    for number in (vd.kCameraAutoExpositionID, vd.kCameraAutoWhiteBalanceID):
        video.setParameter(TOP, number, 0)
    rgb = video.subscribeCamera("rgb", TOP, vd.kQVGA, vd.kRGBColorSpace, 30)
    bgr = video.subscribeCamera("bgr", TOP, vd.kQVGA, vd.kBGRColorSpace, 30)
    first = image(rgb)
    second = image(bgr, after=0)
    assert first[4:6] == second[4:6], "the same moment"
    assert np.array_equal(pixels(first), pixels(second)[..., ::-1])


def test_two_subscribers_have_their_own_sizes_and_rates(robot, video, image):
    fast = video.subscribeCamera("fast", TOP, vd.kQQVGA, vd.kYuvColorSpace, 30)
    slow = video.subscribeCamera("slow", TOP, vd.kQVGA, vd.kYuvColorSpace, 10)
    stamps = {fast: [], slow: []}
    future = robot.post("ALVideoDevice", "getImageRemote", slow)
    robot.handed_over("ALVideoDevice")
    for _ in range(12):
        taken = image(fast)
        stamps[fast].append(taken[4] * 1000000 + taken[5])
        if future.isFinished():
            taken = future.value()
            assert taken[0] == 320
            stamps[slow].append(taken[4] * 1000000 + taken[5])
            future = robot.post("ALVideoDevice", "getImageRemote", slow)
            robot.handed_over("ALVideoDevice")
    assert np.diff(stamps[fast]) == pytest.approx([33333] * 11, abs=1)
    assert np.diff(stamps[slow]) == pytest.approx([100000] * (len(stamps[slow]) - 1), abs=1)
    assert len(stamps[slow]) >= 3
    assert video.getFrameRate(TOP) == 30


def test_a_picture_that_is_asked_for_too_soon_waits_for_the_next_one(robot, video, image):
    handle = video.subscribeCamera("looker", TOP, vd.kQQVGA, vd.kYuvColorSpace, 5)
    first = image(handle)
    future = robot.post("ALVideoDevice", "getImageRemote", handle)
    robot.handed_over("ALVideoDevice")
    robot.advance(0.19)
    assert not future.isFinished()
    robot.advance(0.02)
    second = robot.answer(future)
    assert second[4] + second[5] * 1e-6 - (first[4] + first[5] * 1e-6) == pytest.approx(0.2, abs=1e-4)


def test_a_call_that_waits_can_be_cancelled_and_takes_nothing(robot, video, image):
    handle = video.subscribeCamera("looker", TOP, vd.kQQVGA, vd.kYuvColorSpace, 30)
    image(handle)
    future = robot.post("ALVideoDevice", "getImageRemote", handle)
    robot.handed_over("ALVideoDevice")
    future.cancel()
    assert future.wait(5000) and future.isCanceled()
    assert image(handle)[0] == 160


def test_both_cameras_at_once(robot, video, image):
    handle = video.subscribeCameras("both", [BOTTOM, TOP], [vd.kQVGA, vd.kQQVGA], [vd.kRGBColorSpace, 0], 15)
    bottom, top = image(handle, "getImagesRemote")
    assert (bottom[7], bottom[0], bottom[2]) == (BOTTOM, 320, 3)
    assert (top[7], top[0], top[2]) == (TOP, 160, 1)
    assert bottom[4:6] == top[4:6]
    assert video.getActiveCameras(handle) == [BOTTOM, TOP]
    assert video.getResolutions(handle) == [vd.kQVGA, vd.kQQVGA]
    assert video.getColorSpaces(handle) == [vd.kRGBColorSpace, 0]
    assert video.setResolutions(handle, [vd.kQQVGA, vd.kQQVGA]) == [True, True]
    assert video.setColorSpaces(handle, [0, 0]) == [True, True]
    assert video.setActiveCameras(handle, [TOP, BOTTOM]) == [True, True]
    assert [(one[7], one[0], one[2]) for one in image(handle, "getImagesRemote", after=0.1)] == [
        (TOP, 160, 1),
        (BOTTOM, 160, 1),
    ]
    assert video.setCamerasParameter(handle, vd.kCameraHueID, [10, 20]) == [True, True]
    assert video.getCamerasParameter(handle, vd.kCameraHueID) == [10, 20]
    assert video.setCamerasParameterToDefault(handle, vd.kCameraHueID) == [True, True]
    assert video.getCamerasParameter(handle, vd.kCameraHueID) == [0, 0]
    assert video.releaseImages(handle) == [True, True]
    with pytest.raises(RuntimeError, match="looks through several cameras; use getImagesRemote"):
        video.getImageRemote(handle)


def test_raw_pictures_are_what_the_cameras_give(video, image):
    native = video.subscribeCamera("native", TOP, vd.kQVGA, vd.kYUV422ColorSpace, 30)
    taken = image(native, "getDirectRawImageRemote")
    assert taken[2:4] == (2, vd.kYUV422ColorSpace)
    assert video.releaseDirectRawImage(native) is True
    several = video.subscribeCameras("several", [TOP], [vd.kQVGA], [vd.kYUV422ColorSpace], 30)
    assert len(image(several, "getDirectRawImagesRemote")) == 1
    assert video.releaseDirectRawImages(several) == [True]
    rgb = video.subscribeCamera("rgb", TOP, vd.kQVGA, vd.kRGBColorSpace, 30)
    with pytest.raises(
        RuntimeError, match=r"'rgb_0' asked for colour space 11, raw images are those of 9 \(YUV422\) only"
    ):
        video.getDirectRawImageRemote(rgb)


@pytest.mark.parametrize("kind", ["Image", "Images", "DirectRawImage", "DirectRawImages"])
def test_addresses_are_refused(video, kind):
    with pytest.raises(RuntimeError, match=f"inside the robot's own process; use get{kind}Remote"):
        getattr(video, f"get{kind}Local")("looker_0")


# --- subscribers --------------------------------------------------------------------------------------------------


def test_handles(video):
    handles = [video.subscribeCamera("looker", TOP, vd.kQVGA, 11, 15) for _ in range(2)]
    handles.append(video.subscribe("old", vd.kQVGA, 11, 15))
    assert handles == ["looker_0", "looker_1", "old_0"]
    assert sorted(video.getSubscribers()) == sorted(handles)
    assert video.unsubscribe("looker_0") is True
    video.unsubscribeAllInstances("looker")
    assert video.getSubscribers() == ["old_0"]
    video.onClientDisconnected("ClientDisconnected", "old", "")
    assert video.getSubscribers() == []


def test_the_seventh_of_a_name_is_refused(video):
    for _ in range(6):
        video.subscribeCamera("looker", TOP, vd.kQVGA, 11, 15)
    with pytest.raises(RuntimeError, match="ALVideoDevice::subscribeCamera name is 'looker', allowed is another one"):
        video.subscribeCamera("looker", TOP, vd.kQVGA, 11, 15)


def test_a_client_that_dies_is_cleaned_up(robot, video, image, monkeypatch):
    """Its process is killed while it waits for a picture; time stands still meanwhile."""
    program = (
        "import sys; from naoqi import ALProxy; video = ALProxy('ALVideoDevice', '127.0.0.1', int(sys.argv[1]));"
        "handle = video.subscribeCamera('dead', 0, 1, 11, 5); print(handle, flush=True); video.getImageRemote(handle)"
    )
    path = os.pathsep.join(sys.path)
    command = [sys.executable, "-c", program, str(robot.server.broker.port)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env={**os.environ, "PYTHONPATH": path}) as client:
        handle = next(line.strip() for line in client.stdout if line.startswith("dead"))
        client.kill()
    alive = video.subscribeCamera("alive", TOP, vd.kQVGA, 11, 5)
    robot.advance(0.5)  # the call of the dead client, if it came through, has had its picture
    assert image(alive, after=0.3)[0] == 320
    assert set(video.getSubscribers()) == {handle, alive}
    subscribers = robot.server._video.subscribers
    now = subscribers._clock()
    monkeypatch.setattr(subscribers, "_clock", lambda: now + 50.0)
    assert image(alive, after=0.3)[0] == 320
    monkeypatch.setattr(subscribers, "_clock", lambda: now + 70.0)
    assert video.getSubscribers() == [alive]
    assert [stream.name for stream in robot.server.simulation.cameras.streams] == [alive]


def test_a_module_that_leaves_is_cleaned_up_at_once(robot, video, monkeypatch, patience):
    subscribers = robot.server._video.subscribers
    remove_all, gone = subscribers.remove_all, queue.Queue()
    monkeypatch.setattr(subscribers, "remove_all", lambda name: gone.put((name, remove_all(name))))
    client = qi.Session()
    client.connect(f"tcp://127.0.0.1:{robot.server.broker.port}")
    client.listen("tcp://127.0.0.1:0")
    client.registerService("LookingModule", type("LookingModule", (), {})())
    for name in ("LookingModule", "other"):
        client.service("ALVideoDevice").subscribeCamera(name, TOP, vd.kQVGA, 11, 15)
    client.close()
    assert gone.get(timeout=patience) == ("LookingModule", 1)
    assert video.getSubscribers() == ["other_0"]


@pytest.mark.parametrize(
    "method, arguments",
    [
        ("getImageRemote", ()),
        ("releaseImage", ()),
        ("unsubscribe", ()),
        ("setResolution", (1,)),
        ("getColorSpace", ()),
        ("setCameraParameter", (0, 1)),
    ],
)
def test_unknown_handles_are_told(video, method, arguments):
    video.subscribeCamera("looker", TOP, vd.kQVGA, 11, 15)
    with pytest.raises(
        RuntimeError, match=f"ALVideoDevice::{method} 'nobody_0' is not subscribed; subscribed is 'looker_0'"
    ):
        getattr(video, method)("nobody_0", *arguments)


@pytest.mark.parametrize(
    "arguments, text",
    [
        (("looker", 2, 1, 11, 15), "camera is 2, allowed is one of 0"),
        (("looker", 0, 5, 11, 15), "resolution is 5, allowed is one of"),
        (("looker", 0, 1, 17, 15), "needs a depth camera"),
        (("looker", 0, 1, 11, 0), "fps is 0, allowed is 1 to 30"),
        (("looker", 1, 4, 11, 1), "resolution is 4, allowed is one of .* with camera 1"),
        (("", 0, 1, 11, 15), "name is '', allowed is a name"),
    ],
)
def test_wrong_subscriptions_are_told(video, arguments, text):
    with pytest.raises(RuntimeError, match=text):
        video.subscribeCamera(*arguments)
    assert video.getSubscribers() == []


@pytest.mark.parametrize("arguments", [([0], [1, 1], [11], 15), (0, [1], [11], 15), (["top"], [1], [11], 15)])
def test_wrong_lists_are_told(video, arguments):
    with pytest.raises(RuntimeError, match="allowed is a list of"):
        video.subscribeCameras("looker", *arguments)


def test_what_a_subscriber_sees_can_be_changed(robot, video, image):
    handle = video.subscribeCamera("looker", TOP, vd.kQVGA, vd.kRGBColorSpace, 15)
    assert video.setResolution(handle, vd.kQQVGA) and video.setColorSpace(handle, 0) and video.setFrameRate(handle, 30)
    assert video.setActiveCamera(handle, BOTTOM)
    assert (video.getResolution(handle), video.getColorSpace(handle), video.getFrameRate(handle)) == (0, 0, 30)
    assert video.getActiveCamera(handle) == BOTTOM and video.getActiveCamera() == TOP
    assert (video.getGVMResolution(handle), video.getGVMColorSpace(handle), video.getGVMFrameRate(handle)) == (0, 0, 30)
    assert image(handle)[:4] == (160, 120, 1, 0)
    assert video.getResolution(BOTTOM) == 0 and video.getFrameRate(BOTTOM) == 30 and video.getColorSpace(BOTTOM) == 9


def test_the_active_camera_is_that_of_old_programs(video, image):
    assert video.setActiveCamera(BOTTOM) is True
    assert video.getActiveCamera() == BOTTOM
    handle = video.subscribe("old", vd.kQQVGA, vd.kYuvColorSpace, 10)
    assert image(handle)[7] == BOTTOM
    assert (video.getVIMResolution(), video.getVIMColorSpace(), video.getVIMFrameRate()) == (0, 9, 10)
    video.setParam(vd.kCameraSelectID, TOP)
    assert video.getParam(vd.kCameraSelectID) == TOP == video.getActiveCamera()


# --- files --------------------------------------------------------------------------------------------------------


def test_raw_pictures_go_to_a_file(robot, video):
    handle = video.subscribeCamera("looker", TOP, vd.kQQVGA, vd.kYuvColorSpace, 30)
    assert video.recordVideo(handle, "films/raw.bin", 4, 2) is True
    with pytest.raises(RuntimeError, match="'looker_0' records already"):
        video.recordVideo(handle, "films/other.bin", 4, 2)
    robot.advance(0.11)  # frames at 0, 1/30, 2/30, 3/30: two of them are recorded
    assert video.stopVideo(handle) is True
    path = robot.server.files.folder / "films" / "raw.bin"
    assert path.stat().st_size == 2 * 160 * 120
    assert np.frombuffer(path.read_bytes(), np.uint8).std() > 5
    with pytest.raises(RuntimeError, match="'looker_0' does not record; recording is nobody"):
        video.stopVideo(handle)


@pytest.mark.parametrize(
    "arguments, text",
    [
        (("../outside", 4, 1), "is not inside"),
        (("raw.bin", 0, 1), "totalNumber is 0"),
        (("raw.bin", 4, 0), "period is 0"),
    ],
)
def test_wrong_recordings_are_told(video, arguments, text):
    handle = video.subscribeCamera("looker", TOP, vd.kQQVGA, vd.kYuvColorSpace, 30)
    with pytest.raises(RuntimeError, match=text):
        video.recordVideo(handle, *arguments)
