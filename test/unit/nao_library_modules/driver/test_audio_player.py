"""Files are played and recorded to their end, one recording at a time; what goes wrong is an error of that call."""

from __future__ import annotations

import threading

import fake_sound
import pytest
from set_clock import SetClock

from nao_library_modules.driver.audio_player import AudioPlayer
from nao_library_modules.driver.audio_requests import RecordingRequest
from nao_library_modules.errors import Preempted
from nao_library_modules.interrupt import Interrupt
from naoqi.errors import NaoError, RobotError, RobotUnreachable, UnknownModule

LIMIT = 5.0
REQUEST = RecordingRequest("/home/nao/a.wav", 5, "wav", 48000, (1, 1, 1, 1))


class Player:
    def __init__(self, make_call):
        self._make_call = make_call
        self.begun = threading.Event()

    def playFile(self, name):
        if "missing" in name:
            raise RobotError("ALAudioPlayer", "playFile", f"no file {name}")
        self.call = self._make_call("ALAudioPlayer.playFile")
        self.begun.set()
        return self.call

    def stopAll(self):
        self.call.end()


class Recorder:
    def __init__(self):
        self.calls = []

    def startMicrophonesRecording(self, *arguments):
        self.calls.append(arguments)

    def stopMicrophonesRecording(self):
        self.calls.append("stop")


class Device:
    volume = 50

    def getOutputVolume(self):
        return self.volume

    def setOutputVolume(self, volume):
        self.volume = volume


@pytest.fixture
def robot(make_call):
    services = {"ALAudioPlayer": Player(make_call), "ALAudioRecorder": Recorder(), "ALAudioDevice": Device()}
    return fake_sound.Robot(make_call, **services)


@pytest.fixture
def clock():
    return SetClock()


@pytest.fixture
def interrupt():
    return Interrupt()


@pytest.fixture
def player(robot, clock, interrupt):
    return AudioPlayer(robot, clock, interrupt)


def wait(thread, outcome):
    thread.join(LIMIT)
    assert not thread.is_alive()
    return outcome[0]


def test_playing_ends_with_the_file(player, robot, in_thread):
    thread, outcome = in_thread(player.play, "/home/nao/a.wav")
    service = robot.services["ALAudioPlayer"]
    assert service.begun.wait(LIMIT)
    assert thread.is_alive()
    service.call.end()
    assert wait(thread, outcome) is None


def test_the_robots_own_words_say_what_is_wrong(player, robot):
    with pytest.raises(RobotError, match="no file"):
        player.play("/home/nao/missing.wav")
    del robot.services["ALAudioPlayer"]
    with pytest.raises(UnknownModule):
        player.play("/home/nao/a.wav")


def test_playing_is_silenced_with_the_node(player, robot, interrupt, in_thread):
    thread, outcome = in_thread(player.play, "/home/nao/a.wav")
    assert robot.services["ALAudioPlayer"].begun.wait(LIMIT)
    interrupt.stop()
    assert isinstance(wait(thread, outcome), Preempted)
    assert robot.services["ALAudioPlayer"].call.canceled


def test_a_recording_takes_its_time_of_the_robot(player, robot, clock, in_thread):
    calls = robot.services["ALAudioRecorder"].calls
    thread, outcome = in_thread(player.record, REQUEST)
    clock.somebody_waits(REQUEST.seconds)
    assert calls == [("/home/nao/a.wav", "wav", 48000, [1, 1, 1, 1])]
    with pytest.raises(NaoError, match="one at a time"):
        player.record(REQUEST)
    clock.advance(4.9)
    assert "stop" not in calls
    clock.advance(0.2)
    assert wait(thread, outcome) is None
    assert calls[1:] == ["stop"]


def test_a_recording_that_is_interrupted_is_completed_on_the_robot(player, robot, clock, interrupt, in_thread):
    thread, outcome = in_thread(player.record, REQUEST)
    clock.somebody_waits(REQUEST.seconds)
    interrupt.stop()
    assert isinstance(wait(thread, outcome), Preempted)
    assert robot.services["ALAudioRecorder"].calls[1:] == ["stop"]


def test_a_recording_ends_with_an_error_when_the_robot_is_lost_and_the_next_one_works(player, robot, clock, in_thread):
    thread, outcome = in_thread(player.record, REQUEST)
    clock.somebody_waits(REQUEST.seconds)
    robot.lose()
    assert isinstance(wait(thread, outcome), RobotUnreachable)
    robot.come_back()
    thread, outcome = in_thread(player.record, REQUEST)
    clock.somebody_waits(REQUEST.seconds)
    clock.advance(6.0)
    assert wait(thread, outcome) is None


def test_volume(player):
    player.set_volume(70)
    assert player.volume() == 70
