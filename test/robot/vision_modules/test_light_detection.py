"""ALDarknessDetection and ALBacklightingDetection: what drawn pictures show of the light."""

from __future__ import annotations

import numpy as np
import pytest

DARK, DARKNESS = "DarknessDetection/DarknessDetected", "DarknessDetection/DarknessValue"
BACKLIT, BACKLIGHT = "BacklightingDetection/BacklightingDetected", "BacklightingDetection/BacklightingValue"
WALL = "{name: wall, box: [0.02, 2.0, 2.0], color: [0.0, 0.0, 0.0], position: [0.35, 0.0, 1.0], mass: 0.0}"


def backlit(percent):
    """A dim room with a window that is so much of the picture."""
    picture = np.full((240, 320, 3), 25, np.uint8)
    picture[: 240 * percent // 100] = 255
    return picture


def test_darkness_is_told_once_when_it_comes_however_long_the_camera_exposes(robot, witness):
    told, reader = witness(DARK), robot.ALDarknessDetection
    reader.subscribe("test")
    robot.advance(0.6)
    assert robot.value(DARKNESS) < 20 and told.values == []
    robot.NaoSimulation.placeObject(WALL)
    robot.advance(1.0)
    assert told.values == [robot.value(DARKNESS)] and told.values[0] > 60
    robot.NaoSimulation.removeObject("wall")
    robot.advance(0.5)
    assert robot.value(DARKNESS) < 20
    reader.setDarknessThreshold(100)
    robot.NaoSimulation.placeObject(WALL)
    robot.advance(0.5)
    assert robot.value(DARKNESS) > 60 and len(told.values) == 1
    reader.unsubscribe("test")
    assert not reader.isProcessing()


def test_the_older_toolbox_tells_the_light_when_it_is_asked(robot):
    ask = lambda what: robot.finish("ALVisionToolbox", what, after=0.2)  # noqa: E731
    assert 5 <= ask("isItDark") <= 100 and ask("backlighting") == 0
    robot.NaoSimulation.placeObject(WALL)
    assert 128 <= ask("isItDark") <= 255
    robot.ALVideoDevice.putImage(0, 320, 240, backlit(38).tobytes())
    assert ask("backlighting") == 2
    assert robot.server.simulation.cameras.streams == ()


@pytest.mark.parametrize("window, value", [(38, 2), (0, 0)])
def test_a_window_behind_a_dim_room_is_backlight(robot, witness, window, value):
    robot.ALVideoDevice.putImage(0, 320, 240, backlit(window).tobytes())
    told = witness(BACKLIT)
    robot.ALBacklightingDetection.subscribe("test")
    robot.advance(1.0)
    assert robot.value(BACKLIGHT) == value and told.values == [None] * (value == 2)
