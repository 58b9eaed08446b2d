"""ALVisionRecognition: a poster is learnt from its file and recognised on the wall."""

from __future__ import annotations

import math

import numpy as np
import pytest
from PIL import Image

from nao_sim_bridge.cameras.optics import CameraOptics
from nao_sim_bridge.world.painting.poster import paint_poster

EVENT = "PictureDetected"
WIDTH, AWAY, LEFT, UP = 0.3, 1.0, 0.1, 0.48


@pytest.fixture
def pictures(robot):
    for name in ("city", "planets"):
        Image.fromarray(paint_poster(name)).save(robot.server.files.folder / f"{name}.png")
    Image.new("RGB", (200, 200), (90, 90, 90)).save(robot.server.files.folder / "plain.png")
    return robot.ALVisionRecognition


def test_a_learnt_picture_is_told_with_its_names_and_its_outline_until_it_goes(robot, pictures, place, witness):
    assert pictures.learnFromFile("planets.png", "sky", [], True, False) is True
    assert pictures.learnFromFile("/home/nao/city.png", "town", ["my wall"], True) is True and pictures.getSize() == 2
    told = witness(EVENT)
    place("wall", AWAY, LEFT, UP, poster="city", size=WIDTH)
    pictures.subscribe("test")
    robot.advance(1.0)
    assert len(told.values) == pytest.approx(5, abs=1)
    (stamp, (picture,)) = told.values[-1]
    labels, found, ratio, outline = picture
    assert labels == ["town", "my wall"] and found >= 8 and 0.0 < ratio <= 1.0
    assert stamp[0] + stamp[1] / 1e6 == pytest.approx(told.times[-1], abs=1e-5)
    camera = robot.ALMotion.getPosition("CameraTop", 2, True)
    x, y, _ = robot.ALMotion.getRobotPosition(True)
    ahead, aside = AWAY - x - camera[0], LEFT - y - camera[1]
    middle = np.mean(outline, axis=0)
    assert middle[0] == pytest.approx(math.atan2(aside, ahead), abs=0.03)
    corners = sorted(alpha for alpha, _ in outline)
    assert corners[-1] - corners[0] == pytest.approx(WIDTH / ahead, rel=0.12)
    robot.NaoSimulation.removeObject("wall")
    robot.advance(0.6)
    assert told.values[-1] == [] and told.values.count([]) == 1


def test_a_file_is_looked_at_as_well_and_as_many_are_told_as_wanted(robot, pictures, witness):
    told = witness(EVENT)
    pictures.learnFromFile("city.png", "town", [])
    pictures.learnFromFile("planets.png", "sky", [])
    both = Image.new("RGB", (640, 480), (140, 140, 140))
    for name, x in (("city", 10), ("planets", 330)):
        both.paste(Image.fromarray(paint_poster(name)).resize((240, 320)), (x, 80))
    both.save(robot.server.files.folder / "both.jpg")
    assert pictures.getMaxOutObjs() == 1
    pictures.detectFromFile("both.jpg")
    pictures.setMaxOutObjs(2)
    pictures.detectFromFile("both.jpg")
    assert [len(seen) for _, seen in told.values] == [1, 2]
    assert {labels[0] for labels, *_ in told.values[1][1]} == {"town", "sky"}
    optics = CameraOptics("V6", 0)
    outlines = {labels[0]: np.mean(outline, axis=0) for labels, _, _, outline in told.values[1][1]}
    assert outlines["town"] == pytest.approx(optics.angles(130 / 640, 0.5), abs=0.02)


def test_what_is_learnt_goes_into_the_database_of_the_call(robot, pictures):
    calls = [
        robot.post("ALVisionRecognition", "learnFromFile", f"{name}.png", name, []) for name in ("city", "planets")
    ]
    robot.handed_over("ALVisionRecognition")
    pictures.changeDatabase("", "other")
    assert [robot.answer(call) for call in calls] == [True, True] and pictures.getSize() == 0
    pictures.changeDatabase("", "")
    assert pictures.getSize() == 2


def test_databases_are_kept_apart_and_what_cannot_be_learnt_is_told(robot, pictures):
    assert pictures.learnFromFile("city.png", "town", [])
    assert (
        pictures.learnFromFile("city.png", "city", []) is False
        and pictures.learnFromFile("plain.png", "wall", []) is False
    )
    assert pictures.learnFromFile("/home/nao/city.png", "city", []) is False
    assert pictures.learnFromFile("~/city.png", "city", [], True, True) and pictures.getSize() == 1
    assert pictures.changeDatabase("/home/nao/mine", "toys") and pictures.getSize() == 0
    assert pictures.getParam("db_path") == "/home/nao/mine" and pictures.getParam("db_name") == "toys"
    assert pictures.changeDatabase("", "") and pictures.getParam("db_name") == "current" and pictures.getSize() == 1
    pictures.clearCurrentDatabase()
    assert pictures.getSize() == 0
    for method, arguments, words in (
        ("learnFromFile", ("none.png", "x", []), "no file 'none.png'"),
        ("learnFromFile", ("city.png", " ", []), "name is ' ', allowed is the name of the thing"),
        ("detectFromFile", ("../up.png",), "up.png"),
        ("changeDatabase", ("", "a/b"), "allowed is a name without a folder"),
        ("setMaxOutObjs", (11,), "maxOutObjs is 11, allowed is a whole number, 1 to 10"),
        ("getParam", ("path",), "unknown parameter 'path'"),
        ("setParam", ("scoreThreshold", 1.0), "changeDatabase has the rest"),
    ):
        with pytest.raises(RuntimeError, match=f"^ALVisionRecognition::{method} .*{words}"):
            pictures.call(method, *arguments)
