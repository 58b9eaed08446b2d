"""What only a simulator has, over the network: time, reset, pushes, fingers, ground truth, pictures."""

from __future__ import annotations

import io

import pytest
from PIL import Image

from nao_sim_bridge.server import ServerOptions, SimulatorServer
from nao_sim_bridge.sim.simulation import Scene


@pytest.fixture
def simulation(shared_robot):
    return shared_robot.NaoSimulation


# --- time -------------------------------------------------------------------------------------------------------------


def test_time_passes_when_it_is_asked_to(simulation):
    before = simulation.time()
    after = simulation.advance(0.5)
    assert after == pytest.approx(before + 0.5, abs=1e-3)
    assert simulation.time() == pytest.approx(after)


def test_a_robot_that_started_paused_stands_still(simulation):
    assert simulation.isPaused() is True
    before = simulation.time()
    for _ in range(3):
        simulation.isPaused()
    assert simulation.time() == before


def test_time_can_be_let_go_and_held_again(robot, patience):
    robot.NaoSimulation.resume()
    assert robot.NaoSimulation.isPaused() is False
    assert robot.server.runner.wait_for_tick(robot.now.tick, patience) is not None
    robot.NaoSimulation.pause()
    assert robot.NaoSimulation.isPaused() is True
    robot.settled()
    before = robot.NaoSimulation.time()
    robot.settled()
    assert robot.NaoSimulation.time() == before


def test_the_speed_can_be_changed(simulation):
    simulation.setSpeed(2.5)
    assert simulation.speed() == 2.5
    simulation.setSpeed(0.0)
    assert simulation.speed() == 0.0
    simulation.setSpeed(1.0)
    with pytest.raises(RuntimeError, match="NaoSimulation::setSpeed speed is -1.0, allowed is above 0"):
        simulation.setSpeed(-1.0)
    assert simulation.speed() == 1.0


@pytest.mark.parametrize("seconds", [-0.5, float("inf"), float("nan")])
def test_an_impossible_time_is_refused(simulation, seconds):
    with pytest.raises(RuntimeError, match="NaoSimulation::advance seconds is .*, allowed is 0 or more, finite"):
        simulation.advance(seconds)


# --- the robot in the world -------------------------------------------------------------------------------------------


def test_the_true_pose_of_the_torso(stiff_robot):
    stiff_robot.advance(0.5)
    x, y, z, *orientation = stiff_robot.NaoSimulation.torsoPose()
    assert (x, y) == pytest.approx((0.0, 0.0), abs=0.005)
    assert z == pytest.approx(0.331, abs=0.005)
    assert orientation == pytest.approx([0.0, 0.0, 0.0, 1.0], abs=0.01)


def test_a_push_throws_it_over_and_a_reset_sets_it_up(stiff_robot):
    stiff_robot.NaoSimulation.push([60.0, 0.0, 0.0], 0.2, "torso")
    stiff_robot.advance(2.0)
    assert stiff_robot.NaoSimulation.torsoPose()[2] < 0.12
    before = stiff_robot.NaoSimulation.time()
    stiff_robot.NaoSimulation.reset()
    assert stiff_robot.NaoSimulation.torsoPose()[2] == pytest.approx(0.331, abs=0.005)
    assert stiff_robot.NaoSimulation.time() == before


def test_a_link_can_be_pushed(stiff_robot):
    stiff_robot.advance(0.2)
    stiff_robot.ALMotion.setStiffnesses("RArm", 0.0)
    stiff_robot.NaoSimulation.push([8.0, 0.0, 0.0], 0.3, "r_wrist")
    stiff_robot.advance(0.3)
    assert stiff_robot.ALMotion.getAngles(["RShoulderPitch"], True)[0] < 1.2


def test_a_reset_ends_motions_and_their_calls(stiff_robot):
    futures = [
        stiff_robot.post("ALMotion", "angleInterpolation", "HeadYaw", 1.0, 5.0, True),
        stiff_robot.post("ALLeds", "fade", "FaceLeds", 0.0, 5.0),
    ]
    for module in ("ALMotion", "ALLeds"):
        stiff_robot.handed_over(module)
    stiff_robot.advance(0.2)
    stiff_robot.NaoSimulation.reset()
    for future in futures:
        stiff_robot.answer(future)
    assert stiff_robot.ALMotion.getAngles("HeadYaw", False) == [0.0]


def test_fingers_press_sensors(robot):
    robot.NaoSimulation.press(["Head/Touch/Front"])
    robot.advance(0.01)
    assert robot.now.touched == {"Head/Touch/Front"}
    robot.NaoSimulation.press([])
    robot.advance(0.01)
    assert robot.now.touched == frozenset()


@pytest.mark.parametrize(
    "method, arguments, message",
    [
        ("push", ([1.0, 2.0], 0.1, "torso"), r"force is .*, allowed is \[x, y, z\] in N"),
        ("push", ([1.0, 2.0, 3.0], -0.1, "torso"), "duration is -0.1.*, allowed is 0 to 60"),
        ("push", ([1.0, 2.0, 3.0], 100.0, "torso"), "duration is 100.0, allowed is 0 to 60"),
        ("push", ([1.0, 2.0, float("nan")], 0.1, "torso"), r"force\[2\] is nan, allowed is a finite number"),
        ("push", ([1.0, 2.0, 3.0], 0.1, "torsoo"), "unknown link 'torsoo': did you mean 'torso'"),
        ("press", (["Head/Touch/Frnt"],), "unknown touch sensor 'Head/Touch/Frnt': did you mean 'Head/Touch/Front'"),
        ("picture", ("front", 0, 100), r"picture size is \(0, 100\), allowed is 1 to 4096 pixels each way"),
    ],
)
def test_wrong_arguments_name_what_is_allowed(simulation, method, arguments, message):
    with pytest.raises(RuntimeError, match=f"NaoSimulation::{method} {message}"):
        getattr(simulation, method)(*arguments)


def test_objects_of_the_world_tell_their_poses(world_file, patience, client_of):
    path = world_file("{name: ball, sphere: 0.04, position: [0.4, 0.1, 0.5], mass: 0.1}")
    server = SimulatorServer(ServerOptions(Scene(world=path), port=0, paused=True))
    server.start()
    client = client_of(server)
    assert client.NaoSimulation.objectPoses() == {"ball": pytest.approx([0.4, 0.1, 0.5, 0.0, 0.0, 0.0, 1.0])}
    client.advance(1.0)
    assert client.NaoSimulation.objectPoses()["ball"][2] == pytest.approx(0.04, abs=0.005)
    client.close()
    server.stop()


def test_a_picture_shows_the_robot(robot):
    png = bytes(robot.NaoSimulation.picture("front", 64, 80))
    image = Image.open(io.BytesIO(png))
    assert (image.format, image.size) == ("PNG", (64, 80))
    assert len(set(image.convert("RGB").getdata())) > 50
