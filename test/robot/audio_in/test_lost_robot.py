"""A robot that goes away and comes back: what ends of hearing, and what goes on."""

from __future__ import annotations

import threading

import module_goals
import pytest
from module_goals import ModuleGoals
from patient_robot import PatientRobot
from simulator import PATIENCE, Simulator

import naoqi
from nao_library_actions.msg import NaoAudioInGoal
from nao_library_modules.audio_in.audio_in_server import NaoAudioInput
from nao_library_msgs.msg import AudioInFunction as In
from nao_sim_bridge.core.simulation import Scene
from nao_sim_bridge.server.options import ServerOptions
from nao_sim_bridge.server.simulator_server import SimulatorServer


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


def test_a_lost_robot_ends_goals_and_one_that_comes_back_listens_again(robot, tmp_path, monkeypatch):
    monkeypatch.setattr(module_goals, "WatchedRobot", PatientRobot)
    robot.ALSpeechRecognition.setVocabulary(["theirs"], False)
    ears = ModuleGoals(NaoAudioInput, NaoAudioInGoal, robot)
    ears.succeed(In(function="startRecognition", vocabulary=["yes", "no"]))
    (subscriber, *_) = robot.ALSpeechRecognition.getSubscribersInfo()[0]
    goal = ears.send(In(function="listen", vocabulary=["stop"], timeout=1000.0))
    robot.advance(0.5)
    robot.server.stop()
    comes(lambda: not goal.active)
    goal.over()
    assert ears.module.server.end == "aborted"
    assert "went away" in ears.module.server.text or "connection broke" in ears.module.server.text

    port = robot.port
    robot.session.close()
    options = ServerOptions(Scene(posture="Stand"), port=port, paused=True, speed=float("inf"), record_dir=tmp_path)
    robot.server = SimulatorServer(options)
    robot.server.start()
    robot.lockstep.attach()
    assert ears.module.robot.connection.wait_connected(PATIENCE)
    recognition = robot.server.broker.service("ALSpeechRecognition")
    comes(lambda: [row[0] for row in recognition.getSubscribersInfo()] == [subscriber])
    ears.succeed(In(function="stopRecognition"))
    assert recognition.getSubscribersInfo() == []
    ears.close()
