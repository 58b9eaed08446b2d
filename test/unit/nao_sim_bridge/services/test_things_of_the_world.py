"""Things that clients of the simulator place in the world, move and remove."""

from __future__ import annotations

import io
import json

import numpy as np
import pytest
from PIL import Image

BALL = "{name: b, ball: 0.03, position: [0.6, 0.2, 0.03]}"


@pytest.fixture
def simulation(robot):
    return robot.NaoSimulation


def picture(simulation):
    return np.asarray(Image.open(io.BytesIO(bytes(simulation.picture("far", 320, 240)))).convert("RGB")).astype(int)


def blue(pixels):
    """How many pixels are blue; some are always, by the robot's lights."""
    return int(np.sum(pixels[..., 2] - pixels[..., 0] > 80))


def test_a_thing_is_placed_moved_and_removed(simulation):
    before = simulation.objects()
    simulation.placeObject(BALL)
    assert simulation.objects()["b"] == pytest.approx([0.6, 0.2, 0.03, 0.0, 0.0, 0.0])
    assert simulation.objectPoses()["b"] == pytest.approx([0.6, 0.2, 0.03, 0.0, 0.0, 0.0, 1.0])
    simulation.moveObject("b", [0.7, -0.2, 0.03], [0.0, 0.0, 1.0], 0.0)
    assert simulation.objects()["b"] == pytest.approx([0.7, -0.2, 0.03, 0.0, 0.0, 1.0], abs=1e-6)
    simulation.removeObject("b")
    assert simulation.objects() == before
    assert "b" not in simulation.objectPoses()


def test_json_is_as_good_as_yaml(simulation):
    simulation.placeObject(json.dumps({"name": "m", "landmark": 64, "position": [0.8, 0.0, 0.5], "stand": True}))
    assert simulation.objects()["m"] == pytest.approx([0.8, 0.0, 0.5, 0.0, 0.0, 0.0], abs=1e-6)


def test_a_move_that_takes_time_ends_when_the_thing_is_there(robot, simulation):
    simulation.placeObject("{name: p, person: anna, position: [1.5, 1.0, 0]}")
    move = simulation.moveObject("p", [1.5, -1.0, 0.0], [], 2.0, _async=True)
    robot.settled()
    simulation.advance(1.0)
    assert simulation.objects()["p"][1] == pytest.approx(0.0, abs=0.02)
    assert move.isRunning()
    simulation.advance(1.1)
    move.value()
    assert simulation.objects()["p"][1] == pytest.approx(-1.0, abs=1e-3)


def test_what_is_placed_is_seen_in_pictures_and_gone_after_a_reset(simulation):
    empty = picture(simulation)
    simulation.placeObject("{name: wall, box: [0.1, 0.1, 0.6], position: [0.3, -0.6, 0.3], color: [0, 0, 1]}")
    shown = picture(simulation)
    assert blue(shown) > blue(empty) + 500
    simulation.reset()
    assert "wall" not in simulation.objects()
    assert blue(picture(simulation)) < blue(empty) + 100


def test_an_image_comes_from_the_folder_for_recordings(robot, simulation):
    folder = robot.server.files.folder
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "things_of_the_world_test.png"
    Image.new("RGB", (40, 20), (10, 200, 10)).save(path)
    try:
        simulation.placeObject(f"{{name: i, image: {path.name}, position: [1.0, 0.0, 0.5]}}")
    finally:
        path.unlink()
    assert "i" in simulation.objects()
    assert picture(simulation).shape == (240, 320, 3), "also without the file"
    with pytest.raises(RuntimeError, match="is not inside"):
        simulation.placeObject("{name: j, image: ../../etc/passwd, position: [1.0, 0.0, 0.5]}")
    with pytest.raises(RuntimeError, match="no file 'nowhere.png'"):
        simulation.placeObject("{name: j, image: nowhere.png, position: [1.0, 0.0, 0.5]}")


@pytest.mark.parametrize(
    "description, message",
    [
        ("", "object: is None, not a mapping"),
        ("{name: b", "description is .*allowed is an entry of a world file: "),
        ("[1, 2]", r"object: is \[1, 2\], not a mapping"),
        ("{name: b, bal: 1, position: [0, 0, 0]}", "unknown key 'bal', did you mean 'ball'"),
        ("{name: b, landmark: 65, position: [0, 0, 0]}", "object.landmark: landmark is '65', allowed is one of 64"),
        ("{name: &a b, ball: 1, position: *a}", "aliases are not allowed here"),
        ("a" * 20001, "20000 characters at most"),
        ("{name: floor, ball: 0.03, position: [1, 0, 0]}", "name is 'floor', allowed is"),
        ("{name: b, ball: 0.1, position: [0, 0, 0.3]}", "inside the robot"),
    ],
)
def test_what_cannot_be_placed_is_refused(simulation, description, message):
    before = simulation.objects()
    with pytest.raises(RuntimeError, match=f"NaoSimulation::placeObject .*{message}"):
        simulation.placeObject(description)
    assert simulation.objects() == before


def test_what_is_not_there_cannot_be_moved_or_removed(simulation):
    simulation.placeObject(BALL)
    with pytest.raises(RuntimeError, match=r"moveObject unknown object 'bal': .* \(there are: b\)"):
        simulation.moveObject("bal", [1.0, 0.0, 0.0], [], 0.0)
    with pytest.raises(RuntimeError, match="removeObject unknown object 'ball'"):
        simulation.removeObject("ball")
    with pytest.raises(RuntimeError, match="moveObject position is"):
        simulation.moveObject("b", [1.0, 0.0], [], 0.0)
    with pytest.raises(RuntimeError, match="moveObject duration is -1.0"):
        simulation.moveObject("b", [1.0, 0.0, 0.0], [], -1.0)
