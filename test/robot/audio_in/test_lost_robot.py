"""A robot that goes away and comes back: what ends of hearing and speaking, and what goes on."""

from __future__ import annotations

import threading

import module_goals
import pytest
from bent_robot import BentRobot
from module_goals import ModuleGoals
from simulator import PATIENCE, Simulator
from sounds import RATE, put, tone, write
from spoken_words import RATE as SPEECH_RATE
from spoken_words import spoken

import naoqi
from nao_library_actions.msg import NaoAudioInGoal, NaoAudioOutGoal
from nao_library_modules.audio_in import NaoAudioInput
from nao_library_modules.audio_out import NaoAudioOutput
from nao_library_msgs.msg import AudioInFunction as In
from nao_library_msgs.msg import AudioOutFunction as Out
from nao_sim_bridge.server import ServerOptions, SimulatorServer
from nao_sim_bridge.sim.simulation import Scene
from nao_sim_bridge.sim.sound.samples import Sound


@pytest.fixture
def robot(tmp_path):
    """A robot of this test's own, which may die."""
    simulator = Simulator(tmp_path, speed=float("inf"))
    yield simulator
    naoqi.connection(*simulator.address, wait=False).close()
    simulator.server.stop()


def comes(condition):
    for _ in range(200):
        if condition():
            return
        threading.Event().wait(PATIENCE / 200)
    pytest.fail("it does not come")


def test_a_lost_robot_ends_goals_and_one_that_comes_back_listens_again_and_has_loaded_nothing(
    robot, tmp_path, monkeypatch
):
    monkeypatch.setattr(module_goals, "WatchedRobot", BentRobot)
    monkeypatch.setattr(BentRobot, "patient", True)
    robot.ALSpeechRecognition.setVocabulary(["theirs"], False)
    ears, mouth = ModuleGoals(NaoAudioInput, NaoAudioInGoal, robot), ModuleGoals(NaoAudioOutput, NaoAudioOutGoal, robot)
    write(robot, "one.wav", tone(440.0, 0.2))
    mouth.succeed(Out(function="loadFile", str_param="one.wav"), Out(function="say", str_param="Hello."))
    ears.succeed(In(function="startRecognition", vocabulary=["yes", "no"]))
    (subscriber, *_) = robot.ALSpeechRecognition.getSubscribersInfo()[0]
    goals = [
        ears.send(In(function="listen", vocabulary=["stop"], timeout=1000.0)),
        mouth.send(Out(function="playFileInLoop", str_param="one.wav"), Out(function="waitUntilSilent")),
    ]
    robot.advance(0.5)
    robot.server.stop()
    for goal in goals:
        comes(lambda goal=goal: not goal.active)
        goal.over()
    for one in (ears, mouth):
        assert one.module.server.end == "aborted"
        assert "went away" in one.module.server.text or "connection broke" in one.module.server.text

    port = robot.port
    robot.session.close()
    options = ServerOptions(Scene(posture="Stand"), port=port, paused=True, speed=float("inf"), record_dir=tmp_path)
    robot.server = SimulatorServer(options)
    robot.server.start()
    robot.lockstep.attach()
    assert ears.module.robot.connection.wait_connected(PATIENCE)
    recognition = robot.server.broker.service("ALSpeechRecognition")
    comes(lambda: [row[0] for row in recognition.getSubscribersInfo()] == [subscriber])
    robot.advance(1.0)
    words = Sound(spoken("yes").astype("float32"), SPEECH_RATE).at_rate(RATE)
    put(robot, (1.0, 0.0, 0.5), words.samples[:, 0])
    robot.advance(words.duration + 1.5)
    comes(lambda: [value[0] for _, value in ears.edge.events if value[0]] == ["yes"])
    ears.succeed(In(function="stopRecognition"))
    assert recognition.getSubscribersInfo() == []
    text = mouth.refused(Out(function="play", str_param="one.wav"))
    assert "'one.wav' is not loaded: loadFile comes first" in text
    goal = mouth.send(Out(function="say", str_param="Hello again to everybody."))
    while goal.active:
        robot.advance(0.05)
        robot.proxy("ALMemory").ping()
    assert goal.finish().state == "succeeded" and "again" in [told.word for told in goal.feedback]
    for one in (ears, mouth):
        one.close()
