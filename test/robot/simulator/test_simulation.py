"""What only a simulator has: time, resets, pushes, fingers, ground truth, pictures, things that come and go."""

import io
import re

import numpy as np
import pytest
from PIL import Image
from simulator import PATIENCE

from nao_sim_bridge.base.errors import BadValue

BALL = "{name: b, ball: 0.03, position: [0.6, 0.2, 0.03]}"


@pytest.fixture
def simulation(robot):
    return robot.NaoSimulation


@pytest.fixture
def refused(simulation):
    """Checks that calls are refused: rows of method, arguments and words of the text."""

    def check(*rows):
        for method, *arguments, words in rows:
            with pytest.raises(RuntimeError) as caught:
                simulation.call(method, *arguments)
            assert re.match(f"NaoSimulation::{method} .*{words}", str(caught.value), re.DOTALL), str(caught.value)

    return check


def test_time_passes_as_it_is_asked_to(robot, simulation, refused):
    assert simulation.isPaused() is True and simulation.time() == 0.0
    assert simulation.advance(0.5) == pytest.approx(0.5, abs=1e-3) == simulation.time()
    simulation.resume()
    assert simulation.isPaused() is False
    assert robot.server.runner.wait_for_tick(robot.server.runner.ticks, PATIENCE) is not None
    simulation.pause()
    assert simulation.isPaused() is True
    for asked, speed in ((2.5, 2.5), (0.0, 0.0)):
        simulation.setSpeed(asked)
        assert simulation.speed() == speed
    refused(
        *(("setSpeed", s, "speed is .*, allowed is a finite number, 0 to 1e.06 .* infinity") for s in (-1.0, 1e-12)),
        ("advance", -0.5, "seconds is -0.5, allowed is 0 or more, finite"),
        *(("advance", s, "seconds is .*, allowed is a finite number") for s in (1e9, float("inf"), float("nan"))),
    )


def test_a_push_throws_it_over_and_a_reset_sets_it_up_and_ends_its_motions(stiff_robot, simulation):
    stiff_robot.advance(0.5)
    x, y, z, *orientation = simulation.torsoPose()
    assert (x, y, z) == pytest.approx((0.0, 0.0, 0.331), abs=0.005)
    assert orientation == pytest.approx([0.0, 0.0, 0.0, 1.0], abs=0.01)
    calls = [
        stiff_robot.post("ALMotion", "angleInterpolation", "HeadYaw", 1.0, 5.0, True),
        stiff_robot.post("ALLeds", "fade", "FaceLeds", 0.0, 5.0),
    ]
    for module in ("ALMotion", "ALLeds"):
        stiff_robot.handed_over(module)
    simulation.push([60.0, 0.0, 0.0], 0.2, "torso")
    stiff_robot.advance(2.0)
    assert simulation.torsoPose()[2] < 0.12
    before = simulation.time()
    simulation.reset()
    assert simulation.torsoPose()[2] == pytest.approx(0.331, abs=0.005) and simulation.time() == before
    assert [stiff_robot.answer(call) for call in calls] == [None, None]
    assert stiff_robot.ALMotion.getAngles("HeadYaw", False) == [0.0]


@pytest.fixture
def sensed(robot):
    """Begins anew with other seeds and noise, and answers what the inertial unit has told after a while."""

    def sense(reset=robot.server.reset, **changes):
        robot.server.vary(**changes)
        reset()
        robot.advance(0.2)
        return robot.now.imu

    yield sense
    robot.server.vary(seed=0, payload=0.0, sensor_noise=0.0)


def test_seed_noise_and_payload_count_from_the_next_reset_on(robot, sensed):
    first = sensed(seed=3, sensor_noise=1.0)
    assert sensed(seed=4) != first
    assert sensed(seed=3) == first == sensed(robot.server.factory_reset)
    with pytest.raises(BadValue, match="payload is -1.0, allowed is 0 to"):
        robot.server.vary(seed=5, payload=-1.0)
    assert sensed() == first


def test_fingers_pictures_and_what_cannot_be(robot, simulation, refused):
    for sensors in (["Head/Touch/Front"], []):
        simulation.press(sensors)
        robot.advance(0.01)
        assert robot.now.touched == frozenset(sensors)
    image = Image.open(io.BytesIO(bytes(simulation.picture("front", 64, 80))))
    assert (image.format, image.size) == ("PNG", (64, 80)) and len(set(image.convert("RGB").getdata())) > 50
    refused(
        ("push", [1.0, 2.0], 0.1, "torso", r"force is .*, allowed is \[x, y, z\] in N"),
        ("push", [1.0, 2.0, 3.0], -0.1, "torso", "duration is -0.1.*, allowed is 0 to 60"),
        ("press", ["Head/Touch/Frnt"], "unknown touch sensor 'Head/Touch/Frnt': did you mean 'Head/Touch/Front'"),
        ("picture", "frnt", 64, 64, "unknown view 'frnt': did you mean 'front'"),
    )


def picture(simulation):
    return np.asarray(Image.open(io.BytesIO(bytes(simulation.picture("far", 320, 240)))).convert("RGB")).astype(int)


def blue(pixels):
    """How many pixels are blue; some are always, by the robot's lights."""
    return int(np.sum(pixels[..., 2] - pixels[..., 0] > 80))


def test_things_are_placed_moved_and_removed(robot, simulation):
    simulation.placeObject(BALL)
    assert simulation.objects()["b"] == pytest.approx([0.6, 0.2, 0.03, 0.0, 0.0, 0.0])
    assert simulation.objectPoses()["b"] == pytest.approx([0.6, 0.2, 0.03, 0.0, 0.0, 0.0, 1.0])
    simulation.moveObject("b", [0.7, -0.2, 0.03], [0.0, 0.0, 1.0], 0.0)
    assert simulation.objects()["b"] == pytest.approx([0.7, -0.2, 0.03, 0.0, 0.0, 1.0], abs=1e-6)
    simulation.removeObject("b")
    simulation.placeObject("{name: f, ball: 0.04, position: [0.4, 0.4, 0.5]}")
    simulation.placeObject("{name: p, person: anna, position: [1.5, 1.0, 0]}")
    move = robot.post("NaoSimulation", "moveObject", "p", [1.5, -1.0, 0.0], [], 2.0)
    robot.settled()
    simulation.advance(1.0)
    assert simulation.objects()["p"][1] == pytest.approx(0.0, abs=0.02) and move.isRunning()
    simulation.advance(1.1)
    robot.answer(move)
    assert simulation.objects()["p"][1] == pytest.approx(-1.0, abs=1e-3)
    assert simulation.objectPoses()["f"][2] == pytest.approx(0.04, abs=0.005)  # it has fallen
    assert set(simulation.objects()) == {"f", "p"}


def test_what_is_placed_is_seen_and_gone_after_a_reset_and_what_was_removed_is_back(simulation):
    simulation.reset("lab")
    empty, chair = picture(simulation), simulation.objects()["chair_left"]
    simulation.placeObject("{name: wall, box: [0.1, 0.1, 0.6], position: [0.3, -0.6, 0.3], color: [0, 0, 1]}")
    assert blue(picture(simulation)) > blue(empty) + 500
    simulation.removeObject("table")
    simulation.moveObject("chair_left", [0.0, 1.5, 0.0], [], 0.0)
    assert "table" not in simulation.objects() and simulation.objects()["chair_left"] != chair
    simulation.reset()
    assert "wall" not in simulation.objects() and "table" in simulation.objects()
    assert simulation.objects()["chair_left"] == pytest.approx(chair, abs=0.01)
    assert blue(picture(simulation)) < blue(empty) + 100


def test_what_cannot_be_placed_or_moved_is_refused(simulation, refused):
    simulation.placeObject(BALL)
    before = simulation.objects()
    refused(
        ("placeObject", "{name: b", "description is .*allowed is an entry of a world file: "),
        ("placeObject", "{name: c, bal: 1, position: [0, 0, 0]}", "unknown key 'bal': did you mean 'ball'"),
        (
            "placeObject",
            "{name: c, ball: 1, position: &a [*a]}",
            "more than 200000 values, or more than 50 levels deep",
        ),
        ("placeObject", "{name: c, ball: 0.1, position: [0, 0, 0.3]}", "inside the robot"),
        ("moveObject", "bal", [1.0, 0.0, 0.0], [], 0.0, r"unknown object 'bal': .* \(there are: b\)"),
        ("moveObject", "b", [1.0, 0.0, 0.0], [], -1.0, "duration is -1.0"),
    )
    assert simulation.objects() == before
