"""ALDarknessDetection and ALBacklightingDetection: what drawn pictures show of the light."""

from __future__ import annotations

import numpy as np
import pytest

DARK, DARKNESS = "DarknessDetection/DarknessDetected", "DarknessDetection/DarknessValue"
BACKLIT, BACKLIGHT = "BacklightingDetection/BacklightingDetected", "BacklightingDetection/BacklightingValue"
WALL = "{name: wall, box: [0.02, 2.0, 2.0], color: [0.0, 0.0, 0.0], position: [0.35, 0.0, 1.0], mass: 0.0}"


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


@pytest.mark.parametrize("window, value", [(38, 2), (0, 0)])
def test_a_window_behind_a_dim_room_is_backlight(robot, witness, window, value):
    picture = np.full((240, 320, 3), 25, np.uint8)
    picture[: 240 * window // 100] = 255
    robot.ALVideoDevice.putImage(0, 320, 240, picture.tobytes())
    told = witness(BACKLIT)
    robot.ALBacklightingDetection.subscribe("test")
    robot.advance(1.0)
    assert robot.value(BACKLIGHT) == value and told.values == [None] * (value == 2)
