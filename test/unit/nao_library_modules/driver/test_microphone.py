"""The microphones are heard while somebody wants to; blocks keep format, time and order."""

from __future__ import annotations

from array import array

import fake_sound
import pytest
from set_clock import SetClock

from nao_library_modules.driver import demand, microphone
from nao_library_modules.driver.microphone import SILENCE_LIMIT, Microphone
from naoqi.errors import BrokerError, NaoError

NAME = "ros_naoqi_microphone"
FRAMES = 2720


class Device:
    """ALAudioDevice; `send` calls the module of the node as the robot does."""

    def __init__(self):
        self.calls = []
        self.subscribers = []
        self.format = None

    def setClientPreferences(self, name, rate, channels, deinterleaved):
        self.format = (name, rate, channels, deinterleaved)

    def subscribe(self, name):
        self.calls.append("subscribe")
        self.subscribers.append(name)

    def unsubscribe(self, name):
        self.calls.append("unsubscribe")
        self.subscribers.remove(name)


class Broker:
    """ALBroker and the modules it serves."""

    def __init__(self, connection):
        self.connection = connection
        self.receiver = None
        self.failures = 0
        self.down = False

    def make(self, name, listen_ip, listen_port, robot_ip, robot_port):
        assert (listen_ip, listen_port, robot_ip, robot_port) == ("", 0, "10.0.0.7", 9559)
        return self

    def register(self, name, take):
        if self.failures:
            self.failures -= 1
            raise BrokerError("broker", f"the robot has a module {name!r} already; choose another name")
        self.receiver = take
        self.connection.modules.append(name)
        return self

    def getIP(self):
        return "10.0.0.1"

    def getPort(self):
        return 40000

    def shutdown(self):
        self.down = True


@pytest.fixture
def device():
    return Device()


@pytest.fixture
def memory():
    return fake_sound.Memory()


@pytest.fixture
def robot(make_call, device, memory):
    return fake_sound.Robot(make_call, ALAudioDevice=device, ALMemory=memory)


@pytest.fixture
def broker(robot, monkeypatch):
    monkeypatch.setattr(demand, "RETRY", 0.01)
    monkeypatch.setattr(demand, "FIRST_RETRY", 0.01)
    monkeypatch.setattr(demand, "LOOK_PERIOD", 0.01)
    broker = Broker(robot.connection)
    monkeypatch.setattr(microphone, "ALBroker", broker.make)
    monkeypatch.setattr(microphone, "SoundReceiver", broker.register)
    return broker


@pytest.fixture
def clock():
    clock = SetClock()
    clock.time = 100.0
    return clock


@pytest.fixture
def blocks():
    return []


@pytest.fixture
def wall():
    return [1000.0]


@pytest.fixture
def heard(robot, broker, clock, blocks, wall):
    heard = Microphone(robot, NAME, clock, blocks.append, lambda: wall[0])
    yield heard
    heard.close()


def test_the_robot_sends_only_while_somebody_listens(heard, device, broker, eventually):
    assert broker.receiver is None and device.subscribers == []
    heard.want(True)
    eventually(lambda: device.subscribers == [NAME])
    assert device.format == (NAME, 16000, 3, 0)
    heard.want(False)
    eventually(lambda: device.subscribers == [])
    assert heard.report().message == "nobody listens"


def test_blocks_keep_samples_times_and_places(heard, device, broker, clock, blocks, memory, eventually):
    memory.values["RobotConfig/Head/Version"] = "6.0.0"
    heard.want(True)
    eventually(lambda: device.subscribers)
    samples = array("h", range(-FRAMES // 2, FRAMES // 2))
    clock.time = 200.27
    broker.receiver(1, FRAMES, [7, 100000], samples.tobytes())
    (block,) = blocks
    assert (block.rate, block.places, list(block.samples)) == (16000, (0,), list(samples))
    assert block.time.robot == pytest.approx(7.1) and block.time.ros == pytest.approx(200.1)


def test_another_rate_is_asked_for_at_once(heard, device, broker, blocks, eventually):
    heard.want(True)
    eventually(lambda: device.subscribers)
    heard.set_rate(48000)
    eventually(lambda: device.calls == ["subscribe", "unsubscribe", "subscribe"])
    assert device.format == (NAME, 48000, 0, 0)
    broker.receiver(4, 8160, [7, 0], bytes(4 * 8160 * 2))
    assert (blocks[0].rate, len(blocks[0].places)) == (48000, 4)


@pytest.mark.parametrize("rate", [0, 22050, 44100])
def test_other_rates_are_refused(heard, rate):
    with pytest.raises(NaoError, match=rf"{rate}: 16000 \(1 channel\) or 48000 \(4 channels\)"):
        heard.set_rate(rate)


def test_lost_blocks_are_counted(heard, device, broker, eventually):
    heard.want(True)
    eventually(lambda: device.subscribers)
    for second in (0.0, 0.17, 0.68):
        broker.receiver(1, FRAMES, [0, round(1e6 * second)], bytes(2 * FRAMES))
    assert heard.report().values["lost blocks"] == "2"
    assert heard.report().values["blocks"] == "3"


def test_a_broken_block_is_an_error_of_that_call(heard, device, broker, eventually):
    heard.want(True)
    eventually(lambda: device.subscribers)
    with pytest.raises(NaoError, match="3 bytes"):
        broker.receiver(1, FRAMES, [0, 0], b"abc")


def test_a_name_that_is_still_taken_is_tried_again(heard, device, broker, eventually):
    broker.failures = 3
    heard.want(True)
    eventually(lambda: device.subscribers == [NAME])


def test_after_a_loss_it_waits_until_the_robot_knows_the_module_again(heard, robot, device, eventually):
    heard.want(True)
    eventually(lambda: device.subscribers)
    robot.lose()
    robot.connection.modules.clear()
    device.subscribers.clear()
    assert "cannot be heard" in heard.report().message
    robot.come_back()
    eventually(lambda: "does not know the module" in heard.report().message)
    assert device.subscribers == []
    robot.connection.modules.append(NAME)  # the broker does that
    eventually(lambda: device.subscribers == [NAME])


def test_silence_of_a_robot_that_cannot_reach_us_is_told_and_tried_again(
    heard, device, broker, clock, wall, eventually
):
    heard.want(True)
    eventually(lambda: device.subscribers)
    broker.receiver(1, FRAMES, [0, 0], bytes(2 * FRAMES))
    wall[0] += SILENCE_LIMIT + 1.0
    assert heard.report().message == "heard"  # a simulation that stands still sends nothing
    clock.advance(SILENCE_LIMIT + 1.0)
    eventually(lambda: device.calls[:3] == ["subscribe", "unsubscribe", "subscribe"])
    assert "10.0.0.1:40000" in heard.report().message
    broker.receiver(1, FRAMES, [9, 0], bytes(2 * FRAMES))
    assert heard.report().message == "heard"


def test_its_end_leaves_nothing_on_the_robot(robot, broker, clock, device, eventually):
    heard = Microphone(robot, NAME, clock, lambda block: None)
    heard.want(True)
    eventually(lambda: device.subscribers)
    heard.close()
    assert device.subscribers == [] and broker.down
