"""Pictures come while they are wanted, at the pace of the robot; after changes, failures and a lost robot as well."""

from __future__ import annotations

import queue
from dataclasses import replace

import fake_sound
import pytest
from set_clock import SetClock

from nao_library_modules.driver import camera_stream, demand
from nao_library_modules.driver.camera_stream import BEGIN_LIMIT, SILENCE_LIMIT, CameraStream
from nao_library_modules.driver.camera_subscriber import StreamSettings
from nao_library_modules.health import Level
from naoqi.errors import NaoError, RobotError

NAME = "ros_nao_camera_top"
SIZES = {0: (160, 120), 1: (320, 240)}
LAYERS = {13: 3, 0: 1}
MOST_OF_A_NAME = 2


class Device:
    """ALVideoDevice: a picture comes when the test gives one."""

    def __init__(self, make_call):
        self._make_call = make_call
        self._asked = queue.Queue()
        self.subscribers = {}
        self.calls = []
        self.asked = []
        self.refused = ""
        self.before_setting = lambda: None
        self.broken = ""
        self.answer = None

    def subscribeCamera(self, name, camera, resolution, space, rate):
        handles = [f"{name}_{number}" for number in range(MOST_OF_A_NAME)]
        free = next((handle for handle in handles if handle not in self.subscribers), None)
        if free is None or self.refused == "subscribeCamera":
            raise RobotError("ALVideoDevice", "subscribeCamera", f"{name} has too many")
        self.subscribers[free] = [camera, resolution, space, rate]
        self.calls.append("subscribe")
        return free

    def unsubscribe(self, handle):
        self.calls.append("unsubscribe")
        if self.subscribers.pop(handle, None) is None:
            raise RobotError("ALVideoDevice", "unsubscribe", f"no subscriber {handle}")
        return True

    def getSubscribers(self):
        return list(self.subscribers)

    def _set(self, handle, place, value):
        self.before_setting()
        if self.refused == value:
            return False
        if handle not in self.subscribers:
            raise RobotError("ALVideoDevice", "set", f"no subscriber {handle}")
        self.subscribers[handle][place] = value
        return True

    def setResolution(self, handle, value):
        return self._set(handle, 1, value)

    def setColorSpace(self, handle, value):
        return self._set(handle, 2, value)

    def setFrameRate(self, handle, value):
        return self._set(handle, 3, value)

    def getImageRemote(self, handle):
        if handle not in self.subscribers or self.broken:
            raise RobotError("ALVideoDevice", "getImageRemote", self.broken or f"no subscriber {handle}")
        call = self._make_call("ALVideoDevice.getImageRemote")
        self.asked.append(call)
        self._asked.put(call)
        return call

    def next_call(self):
        """The call for a picture that waits."""
        while True:
            call = self._asked.get(timeout=5.0)
            if not call.done():
                return call

    def give(self, time, handle=f"{NAME}_0"):
        """Answer the call that waits with a picture that was taken at `time`."""
        call = self.next_call()
        camera, resolution, space, _ = self.subscribers[handle]
        width, height = SIZES[resolution]
        pixels = bytes(width * height * LAYERS[space])
        microseconds = round(time * 1e6)
        stamp = divmod(microseconds, 1000000)
        call.end(self.answer or [width, height, LAYERS[space], space, *stamp, pixels, camera, 0.5, 0.4, -0.5, -0.4])


@pytest.fixture
def device(make_call):
    return Device(make_call)


@pytest.fixture
def robot(make_call, device):
    return fake_sound.Robot(make_call, ALVideoDevice=device)


@pytest.fixture
def clock():
    clock = SetClock()
    clock.time = 500.0
    return clock


@pytest.fixture
def seen():
    return []


@pytest.fixture
def prepared():
    return []


class Wall:
    """Time of the computer, which tells how often somebody looked at it."""

    def __init__(self):
        self.time = 1000.0
        self.looks = 0

    def now(self):
        self.looks += 1
        return self.time


@pytest.fixture
def wall():
    return Wall()


@pytest.fixture
def stream(robot, device, clock, seen, prepared, wall, monkeypatch):
    monkeypatch.setattr(demand, "RETRY", 0.01)
    monkeypatch.setattr(demand, "FIRST_RETRY", 0.01)
    monkeypatch.setattr(demand, "LOOK_PERIOD", 0.01)
    monkeypatch.setattr(camera_stream, "FAILURE_PAUSE", 0.01)
    stream = CameraStream(
        robot,
        NAME,
        StreamSettings(0, 1, 13, 15),
        clock,
        lambda picture, time: seen.append((picture, time)),
        lambda: prepared.append(list(device.calls)),
        wall.now,
    )
    yield stream
    stream.close()
    assert not stream._thread.is_alive()


def test_the_robot_is_asked_only_while_somebody_looks(stream, device, eventually, prepared):
    assert stream.report().message == "nobody looks"
    stream.want(True)
    eventually(lambda: device.asked)
    assert device.subscribers == {f"{NAME}_0": [0, 1, 13, 15]} and prepared == [[]]
    stream.want(False)
    eventually(lambda: device.subscribers == {})
    eventually(lambda: [call.canceled for call in device.asked] == [True])
    assert stream.report().message == "nobody looks"


def test_the_end_of_the_node_ends_the_subscription(stream, device, eventually):
    stream.want(True)
    eventually(lambda: device.asked)
    stream.close()
    assert device.subscribers == {} and device.calls == ["subscribe", "unsubscribe"]


def test_pictures_come_with_their_times_one_call_at_a_time(stream, device, clock, seen, eventually):
    stream.want(True)
    for number in range(5):
        clock.time = 500.0 + number / 15.0 + 0.02
        device.give(7.0 + number / 15.0)
        eventually(lambda count=number + 1: len(seen) == count)
    assert [picture.time for picture, _ in seen] == pytest.approx([7.0 + number / 15.0 for number in range(5)])
    assert [time for _, time in seen] == pytest.approx([500.02 + number / 15.0 for number in range(5)])
    assert (seen[0][0].width, seen[0][0].encoding) == (320, "bgr8")
    assert sum(not call.done() for call in device.asked) <= 1


def test_a_picture_that_was_there_before_is_not_shown_again(stream, device, seen, eventually):
    stream.want(True)
    for time in (7.0, 7.0, 7.0, 7.1):
        device.give(time)
    eventually(lambda: len(seen) == 2)
    assert [picture.time for picture, _ in seen] == pytest.approx([7.0, 7.1])


def test_settings_change_without_a_gap(stream, device, seen, eventually):
    stream.want(True)
    device.give(7.0)
    stream.change(StreamSettings(0, 0, 0, 30))
    assert device.subscribers == {f"{NAME}_0": [0, 0, 0, 30]}
    device.give(7.1)
    eventually(lambda: len(seen) == 2)
    assert (seen[1][0].width, seen[1][0].encoding) == (160, "mono8")
    assert device.calls == ["subscribe"]


def test_settings_that_change_before_are_those_of_the_beginning(stream, device, eventually):
    stream.change(StreamSettings(0, 0, 0, 30))
    stream.want(True)
    eventually(lambda: device.subscribers == {f"{NAME}_0": [0, 0, 0, 30]})


def test_what_the_robot_refuses_is_told_and_all_is_as_before(stream, device, eventually):
    stream.want(True)
    eventually(lambda: device.asked)
    device.refused = 30
    with pytest.raises(NaoError, match="refuses the frame_rate 30 for its CameraTop"):
        stream.change(StreamSettings(0, 0, 0, 30))
    assert device.subscribers == {f"{NAME}_0": [0, 1, 13, 15]}
    assert stream.settings == StreamSettings(0, 1, 13, 15)


def test_settings_that_meet_the_end_of_a_subscription_are_those_of_the_next_one(stream, device, eventually):
    def stop_looking():
        stream.want(False)
        eventually(lambda: device.subscribers == {})

    stream.want(True)
    eventually(lambda: device.asked)
    device.before_setting = stop_looking
    stream.change(StreamSettings(0, 0, 0, 30))
    stream.want(True)
    eventually(lambda: device.subscribers == {f"{NAME}_0": [0, 0, 0, 30]})
    assert device.calls == ["subscribe", "unsubscribe", "subscribe"]


def test_another_camera_is_another_subscription(stream, device, seen, eventually):
    stream.want(True)
    device.give(7.0)
    stream.change(replace(stream.settings, camera=1))
    eventually(lambda: device.subscribers == {f"{NAME}_0": [1, 1, 13, 15]})
    device.give(7.2)
    eventually(lambda: len(seen) == 2)
    assert seen[1][0].camera == 1


def test_a_lost_robot_that_comes_back_shows_pictures_again(stream, robot, device, seen, eventually):
    stream.want(True)
    device.give(7.0)
    eventually(lambda: len(seen) == 1)
    robot.lose()
    eventually(lambda: stream.report().level is Level.ERROR)
    device.subscribers.clear()  # it was switched off and on
    robot.come_back()
    device.give(1.0)
    eventually(lambda: len(seen) == 2)
    assert stream.report().level is Level.OK
    assert device.calls.count("subscribe") == 2


def test_a_subscription_that_the_robot_has_ended_is_made_again(stream, device, seen, eventually):
    stream.want(True)
    device.give(7.0)
    call = device.next_call()
    device.subscribers.clear()
    call.end(error=RobotError("ALVideoDevice", "getImageRemote", "no such subscriber"))
    device.give(7.5)
    eventually(lambda: len(seen) == 2)
    eventually(lambda: stream.report().level is Level.OK)


def test_what_is_no_picture_is_told_and_tried_again(stream, device, seen, eventually, caplog):
    device.answer = [320, 240, 2, 17, 7, 0, b"", 0]
    stream.want(True)
    for time in (7.0, 7.1):
        device.give(time)
    eventually(lambda: stream.report().level is Level.ERROR)
    assert "colour space 17" in stream.report().message
    device.answer = None
    device.give(7.2)
    eventually(lambda: len(seen) == 1)
    assert caplog.text.count("colour space 17") == 1


def test_leftovers_of_a_node_that_was_killed_make_room(stream, device, eventually):
    device.subscribers = {f"{NAME}_0": [0, 1, 13, 15], f"{NAME}_1": [0, 1, 13, 15], "other_0": [1, 1, 13, 15]}
    stream.want(True)
    eventually(lambda: "subscribe" in device.calls)
    assert list(device.subscribers) == ["other_0", f"{NAME}_0"]


def test_a_robot_that_takes_no_subscriber_is_told(stream, device, eventually):
    device.refused = "subscribeCamera"
    stream.want(True)
    eventually(lambda: "too many" in stream.report().message)
    assert stream.report().level is Level.ERROR


def test_silence_is_told_and_asked_about(stream, device, clock, wall, seen, eventually, caplog):
    stream.want(True)
    device.give(7.0)
    eventually(lambda: len(seen) == 1)
    wall.time += 2 * SILENCE_LIMIT
    looks = wall.looks
    eventually(lambda: wall.looks > looks + 3)
    assert device.calls == ["subscribe"], "no picture is due while the robot's time stands still"
    clock.time += 2 * SILENCE_LIMIT
    eventually(lambda: device.calls[:3] == ["subscribe", "unsubscribe", "subscribe"])
    assert "no picture has come" in caplog.text


def test_the_first_picture_may_take_longer(stream, device, clock, wall, eventually):
    stream.want(True)
    eventually(lambda: device.asked)
    for time, calls in ((BEGIN_LIMIT - 1.0, 1), (2.0, 3)):
        clock.time += time
        wall.time += time
        looks = wall.looks
        eventually(lambda looks=looks: wall.looks > looks + 3)
        eventually(lambda calls=calls: len(device.calls) == calls)


def test_the_report_tells_the_rate_that_is_reached(stream, device, seen, eventually):
    stream.want(True)
    for number in range(20):
        device.give(7.0 + number / 10.0)
    eventually(lambda: len(seen) == 20)
    report = stream.report()
    assert report.level is Level.WARN and report.message == "only 10.0 of 15 pictures a second"
    stream.change(replace(stream.settings, frame_rate=10))
    assert stream.report().message == "pictures come"
    assert stream.report().values["size"] == "320x240"


def test_a_sink_that_fails_does_not_end_the_pictures(robot, device, clock, eventually, monkeypatch):
    monkeypatch.setattr(camera_stream, "FAILURE_PAUSE", 0.01)
    seen = []

    def sink(picture, _):
        seen.append(picture.time)
        if len(seen) == 1:
            raise ValueError("a mistake")

    stream = CameraStream(robot, NAME, StreamSettings(0, 1, 13, 15), clock, sink)
    try:
        stream.want(True)
        device.give(7.0)
        device.give(7.1)
        eventually(lambda: len(seen) == 2)
    finally:
        stream.close()
