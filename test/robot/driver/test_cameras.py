"""Cameras on the robot: pictures while somebody looks, tuning of the picture, and modules that look for something."""

from __future__ import annotations

import threading
from dataclasses import replace

import pytest

from nao_library_modules.core.health import Level
from nao_library_modules.core.robot import Robot
from nao_library_modules.driver.base import lazy_subscription
from nao_library_modules.driver.base.lazy_subscription import Extractor
from nao_library_modules.driver.camera import camera_stream
from nao_library_modules.driver.camera.camera_settings import CameraTuning
from nao_library_modules.driver.camera.camera_stream import CameraStream, StreamSettings
from nao_library_modules.driver.sensors.nao_vision import FACES, MOVEMENT
from naoqi.errors import NaoError

NAME = "ros_nao_camera_top"


@pytest.fixture(autouse=True)
def _impatient(monkeypatch):
    """What runs on demand is looked after at once."""
    for name, seconds in (("RETRY", 0.02), ("FIRST_RETRY", 0.02), ("LOOK_PERIOD", 0.02)):
        monkeypatch.setattr(lazy_subscription, name, seconds)
    monkeypatch.setattr(camera_stream, "FAILURE_PAUSE", 0.02)


@pytest.fixture
def video(robot):
    device = robot.ALVideoDevice
    for handle in device.getSubscribers():
        device.unsubscribe(handle)
    yield device
    for camera in (0, 1):
        device.resetCamera(camera)


@pytest.fixture
def seen():
    return []


@pytest.fixture
def stream(video, driver_robot, clock, seen, closing):
    settings = StreamSettings(0, 1, 13, 15)
    return closing(CameraStream(driver_robot, NAME, settings, clock, lambda *picture: seen.append(picture)))


def ours(video):
    return [handle for handle in video.getSubscribers() if handle.startswith(NAME)]


def test_pictures_come_with_their_times_while_somebody_looks(stream, robot, video, seen, until, eventually):
    assert stream.report().message == "no subscriber" and not ours(video)
    stream.want(True)
    until(lambda: seen, step=1 / 60)
    report = stream.report()
    assert (report.level, report.message, report.values["size"]) == (Level.OK, "pictures come", "320x240")
    until(lambda: len(seen) >= 5, step=1 / 15)
    picture = seen[-1][0]
    assert (picture.width, picture.height, picture.encoding, picture.camera) == (320, 240, "bgr8", 0)
    times = [picture.time for picture, _ in seen]
    assert times == sorted(set(times)) and times[-1] <= robot.now.time
    taken = [time for _, time in seen]
    assert taken == sorted(set(taken)) and all(time >= own for time, own in zip(taken, times))
    stream.want(False)
    eventually(lambda: not ours(video))


def test_pictures_that_are_taken_up_too_slowly_are_told_with_the_rate_reached(
    video, driver_robot, clock, closing, until, caplog
):
    gate = threading.Semaphore(0)
    settings = StreamSettings(0, 0, 13, 30)
    stream = closing(CameraStream(driver_robot, NAME, settings, clock, lambda *picture: gate.acquire()))
    stream.want(True)
    # One every half second.
    until(lambda: gate.release() or stream.report().level == Level.WARN, limit=60.0, step=0.5)
    gate.release(1000)
    report = stream.report()
    assert report.message == f"only {report.values['rate reached (1/s)']} of 30 pictures a second"
    assert float(report.values["rate reached (1/s)"]) < 4.0 and report.values["rate asked for (1/s)"] == "30"
    assert len([message for message in caplog.messages if "of 30 pictures a second" in message]) == 1


def test_without_a_robot_there_are_no_pictures_and_it_says_why(clock, closing):
    settings = StreamSettings(0, 1, 13, 15)
    stream = closing(CameraStream(Robot("127.0.0.1", 9), NAME, settings, clock, lambda *picture: None))
    stream.want(True)
    assert stream.report().message == "no pictures: the robot is not connected"


def test_settings_change_while_pictures_come_and_what_the_robot_refuses_leaves_all_as_it_was(
    stream, video, seen, until
):
    stream.change(StreamSettings(0, 0, 13, 30))  # before: those of the beginning
    stream.want(True)
    until(lambda: seen, step=1 / 15)
    assert seen[0][0].width == 160
    handles = ours(video)
    stream.change(StreamSettings(0, 1, 0, 15))
    until(lambda: seen[-1][0].encoding == "mono8", step=1 / 15)
    assert seen[-1][0].width == 320 and ours(video) == handles
    with pytest.raises(NaoError):
        stream.change(StreamSettings(0, 0, 99, 30))
    assert stream.settings == StreamSettings(0, 1, 0, 15) and video.getResolution(handles[0]) == 1
    stream.change(replace(stream.settings, camera=1))
    until(lambda: seen[-1][0].camera == 1, step=1 / 15)
    assert len(ours(video)) == 1


def test_pictures_come_again_after_a_loss_or_when_the_robot_has_ended_the_subscription(
    stream, driver_robot, video, seen, until
):
    other = video.subscribeCamera("other", 0, 1, 13, 15)
    handle = "first"
    while handle:  # leftovers of a node that was killed, which make room
        try:
            handle = video.subscribeCamera(NAME, 0, 1, 13, 15)
        except RuntimeError:
            break
    stream.want(True)
    until(lambda: seen, step=1 / 15)
    assert len(ours(video)) == 1 and other in video.getSubscribers()
    video.unsubscribe(other)
    for harm in (driver_robot.lose, lambda: video.unsubscribe(ours(video)[0])):
        harm()
        count = len(seen)
        until(lambda count=count: len(seen) > count + 1, step=1 / 15)
        until(lambda: stream.report().level is not Level.ERROR, step=1 / 15)


BRIGHTNESS, CONTRAST, GAIN, AUTO_EXPOSITION, EXPOSURE = 0, 1, 6, 11, 17


@pytest.fixture
def ask(driver_robot, video):
    """Calls a method of ALVideoDevice."""
    return lambda *call: driver_robot.proxy("ALVideoDevice").call_async(*call).result(timeout=60.0)


def test_values_are_set_the_automatic_ones_first_and_what_the_camera_chooses_itself_is_not(ask, video):
    tuning = CameraTuning(ask, {})
    tuning.choose(1, {"exposure": 100, "contrast": 40, "auto_exposition": 0}, connected=True)
    assert [video.getParameter(1, number) for number in (EXPOSURE, CONTRAST, AUTO_EXPOSITION)] == [100, 40, 0]
    gain = video.getParameter(0, GAIN)
    CameraTuning(ask, {}).choose(0, {"gain": gain + 50, "contrast": 50}, connected=True)
    assert (video.getParameter(0, GAIN), video.getParameter(0, CONTRAST)) == (gain, 50)
    found = tuning.read(1)
    assert (found["exposure"], found["contrast"], found["auto_exposition"]) == (100, 40, 0)


def test_values_out_of_range_are_told_and_nothing_is_set(ask, video, caplog):
    highest = video.getParameterRange(0, CONTRAST)[1]
    before = video.getParameter(0, BRIGHTNESS)
    words = f"contrast is {highest + 1}: the robot's CameraTop takes"
    tuning = CameraTuning(ask, {})
    with pytest.raises(NaoError, match=words):
        tuning.choose(0, {"brightness": 9, "contrast": highest + 1}, connected=True)
    tuning.set_again(0)
    assert video.getParameter(0, BRIGHTNESS) == before
    tuning = CameraTuning(ask, {"contrast": highest + 1, "brightness": 9})
    tuning.set_again(0)  # at the start it still gives pictures
    assert words in caplog.text and video.getParameter(0, BRIGHTNESS) == 9


def test_what_was_chosen_is_set_on_a_robot_that_comes_later_and_on_the_next_one(ask, video):
    tuning = CameraTuning(ask, {"brightness": 9})
    tuning.choose(0, {"contrast": 40}, connected=False)
    assert video.getParameter(0, CONTRAST) != 40
    for _ in range(2):
        tuning.set_again(0)
        assert (video.getParameter(0, BRIGHTNESS), video.getParameter(0, CONTRAST)) == (9, 40)
        video.resetCamera(0)


@pytest.fixture
def make(robot, driver_robot, closing):
    seen = []

    def make(kind, **options):
        detection = closing(Extractor(driver_robot, kind, "ros_nao_vision", seen.append, **options))
        detection.seen = seen
        return detection

    return make


def test_events_come_while_a_detection_is_on_and_switching_twice_changes_nothing(make, robot, eventually):
    def raised(value):
        robot.ALMemory.raiseEvent("FaceDetected", [value])

    def lookers():
        return [name for name, *_ in robot.ALFaceDetection.getSubscribersInfo()]

    prepared = []
    faces = make(FACES, prepare=lambda: prepared.append(lookers()))
    faces.disable()
    raised("before")
    for _ in range(2):
        faces.enable()
    assert lookers() == ["ros_nao_vision"] and faces.report().message == "on" and prepared == [[]]
    raised("while")
    eventually(lambda: faces.seen)
    for _ in range(2):
        faces.disable()
    raised("after")
    assert lookers() == [] and faces.report().message == "off" and faces.seen == [["while"]]
    assert "somebody" not in faces.call("getLearnedFacesList")
    faces.enable()
    faces.close()
    assert lookers() == []


def test_a_lost_robot_looks_again_once_and_without_one_it_is_not_switched_on(make, robot, driver_robot, eventually):
    prepared = []
    faces = make(FACES, prepare=lambda: prepared.append(1))
    faces.enable()
    driver_robot.lose()
    eventually(lambda: faces.report().message == "on" and len(prepared) == 2)
    eventually(lambda: faces.seen or robot.ALMemory.raiseEvent("FaceDetected", ["warm"]))
    count = len(faces.seen)
    robot.ALMemory.raiseEvent("FaceDetected", ["again"])
    eventually(lambda: ["again"] in faces.seen)
    assert faces.seen[count:].count(["again"]) == 1

    def refuse():
        raise NaoError("no camera")

    refusing = make(MOVEMENT, prepare=refuse)
    with pytest.raises(NaoError, match="no camera"):
        refusing.enable()
    assert refusing.report().message == "off" and not robot.ALMovementDetection.getSubscribersInfo()
