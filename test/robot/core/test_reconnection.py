"""A robot that goes away and comes back: what ends, and what every module finds again."""

from __future__ import annotations

import threading

import pytest
from genpy import Duration
from module_goals import ModuleGoals
from simulator import PATIENCE, Simulator

import naoqi
from nao_library_actions.msg import NaoLedGoal, NaoMotionGoal, NaoTactileGoal
from nao_library_modules.lights.lights_server import NaoLights
from nao_library_modules.motion.motion_server import NaoMotion
from nao_library_modules.tactile.tactile_server import NaoTactile
from nao_library_msgs.msg import LedFunction, MotionFunction, TactileFunction
from nao_sim_bridge.core.simulation import Scene
from nao_sim_bridge.server.options import ServerOptions
from nao_sim_bridge.server.simulator_server import SimulatorServer


@pytest.fixture
def mortal(tmp_path):
    simulator = Simulator(tmp_path / "first", speed=float("inf"))
    yield simulator
    naoqi.connection(*simulator.address, wait=False).close()
    simulator.server.stop()


def replace_server(simulator, folder):
    """Another robot at the same address, which knows nothing of the first one's clients."""
    port = simulator.port
    simulator.session.close()
    simulator.server = SimulatorServer(
        ServerOptions(Scene(posture="Stand"), port=port, paused=True, speed=float("inf"), record_dir=folder)
    )
    simulator.server.start()
    simulator.lockstep.attach()


def comes(condition, what):
    for _ in range(200):
        if condition():
            return
        threading.Event().wait(PATIENCE / 200)
    pytest.fail(f"{what} does not come")


class Runner:
    def __init__(self):
        self.started = threading.Event()

    def run(self, behavior, parameters, done):
        self.started.set()

    def close(self):
        pass


def test_what_a_lost_robot_ends_and_one_that_comes_back_is_told(mortal, tmp_path):
    runner = Runner()
    lights = ModuleGoals(NaoLights, NaoLedGoal, mortal)
    motion = ModuleGoals(NaoMotion, NaoMotionGoal, mortal, motion_dir=tmp_path)
    tactile = ModuleGoals(NaoTactile, NaoTactileGoal, mortal, runner=runner)
    mortal.ALLeds.createGroup("Theirs", ["Brain0"])
    lights.succeed(
        LedFunction(function="subscribeToEvent", str_param="A"), LedFunction(function="on", lights=["Theirs"])
    )
    motion.succeed(MotionFunction(function="getAngles", names=["Head"]))
    tactile.succeed(
        TactileFunction(function="onTouch", sensors=["chest"], behavior="hello"),
        TactileFunction(function="setSonarEnabled", enable=True),
    )
    goal = lights.send(LedFunction(function="on", lights=["Brain0"], time=Duration(1000)))
    mortal.advance(0.5)
    nao = lights.node.reports["NaoLights NAO"]
    assert nao().message == "well" and {"battery", "power", "cpu"} < set(nao().values)
    mortal.server.stop()
    comes(lambda: not goal.active, "the end of the goal")
    goal.over()
    server = lights.module.server
    assert server.end == "aborted" and server.text.startswith("function 1 (on): the robot at 127.0.0.1:")
    assert " went away: " in server.text
    report = lights.node.reports["NaoLights robot"]()
    assert report.message.startswith("lost: ")
    assert nao().message == "well", "as it was when it answered"

    connection = lights.module.robot.connection
    replace_server(mortal, tmp_path / "second")
    assert connection.wait_connected(PATIENCE) and connection.generation == 2
    memory, sonar = mortal.server.memory, mortal.server.broker.service("ALSonar")
    lights.succeed(LedFunction(function="on", lights=["Brain0"]))
    assert "unknown light 'Theirs'" in lights.refused(LedFunction(function="on", lights=["Theirs"]))
    comes(lambda: len(sonar.getSubscribersInfo()) == 1, "the sonars' subscription")
    comes(lambda: memory.raise_event("A", 1) or ("A", 1) in lights.node.events, "the event")
    mortal.server.press(["ChestBoard/Button"])
    mortal.advance(0.3)
    assert runner.started.wait(PATIENCE)
    motion.succeed(MotionFunction(function="setStiffnesses", names=["Body"], angles=[1.0]))
    goal = motion.send(MotionFunction(function="angleInterpolation", names=["HeadYaw"], angles=[1.0], times=[20.0]))
    mortal.advance(0.5)
    memory.raise_event("ALMotion/RobotIsFalling", True)
    goal.finish()
    assert goal.state == "aborted" and "the robot fell" in goal.text
    for module in (lights, motion, tactile):
        module.close()
