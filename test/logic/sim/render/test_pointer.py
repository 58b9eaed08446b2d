"""The mouse in the window: the line of sight through a pixel, and how long it points."""

from __future__ import annotations

import numpy as np
import pybullet
import pytest

from nao_sim_bridge.base.engine import Engine
from nao_sim_bridge.render.window import Pointer, ray_through

EYE, TARGET = (1.2, -0.7, 0.6), (0.0, 0.0, 0.3)
MATRICES = (
    pybullet.computeViewMatrix(EYE, TARGET, (0.0, 0.0, 1.0)),
    pybullet.computeProjectionMatrixFOV(60.0, 4.0 / 3.0, 0.1, 50.0),
)
MOVE, BUTTON, DOWN, UP = 1, 2, 3, 4


@pytest.mark.parametrize("point", [TARGET, (0.2, 0.3, 0.1), (0.1, -0.4, 0.5), (-2.0, 1.0, 0.0)])
def test_the_line_of_sight_through_a_pixel_meets_what_is_seen_there(point):
    to_camera, to_clip = (np.array(matrix).reshape(4, 4).T for matrix in MATRICES)
    x, y, _, w = to_clip @ to_camera @ [*point, 1.0]
    ray, wanted = ray_through(*MATRICES, 0.5 + 0.5 * x / w, 0.5 - 0.5 * y / w), np.subtract(point, EYE)
    assert ray.eye == pytest.approx(EYE) and ray.direction == pytest.approx(wanted / np.linalg.norm(wanted))


class Mouse(Engine):
    """An engine as one with a window: what it reports of mouse and keyboard."""

    def __init__(self):
        super().__init__()
        self.events, self.keys, self.picking = [], {}, True

    def getMouseEvents(self):  # PyBullet's names
        events, self.events = self.events, []
        return tuple(events)

    def getKeyboardEvents(self):
        return self.keys

    def getDebugVisualizerCamera(self):
        return (640, 480, *MATRICES)

    def configureDebugVisualizer(self, flag, enable):
        self.picking = bool(enable)


@pytest.fixture
def mouse():
    mouse = Mouse()
    yield mouse
    mouse.disconnect()


def test_the_mouse_points_as_long_as_its_button_is_pressed(mouse):
    pointer, middle, aside = Pointer(mouse), ray_through(*MATRICES, 0.5, 0.5), ray_through(*MATRICES, 0.25, 0.75)
    assert not mouse.picking
    for events, news in (
        ([(MOVE, 100.0, 100.0, -1, 0)], []),
        ([(BUTTON, 320.0, 240.0, 0, DOWN), (MOVE, 160.0, 360.0, -1, 0)], [middle, aside]),
        ([(BUTTON, 160.0, 360.0, 0, UP), (MOVE, 0.0, 0.0, -1, 0)], [None]),
        ([(BUTTON, 320.0, 240.0, 1, DOWN), (BUTTON, 320.0, 240.0, 1, UP)], []),
    ):
        mouse.events = events
        assert pointer.news() == news
    mouse.keys = {mouse.B3G_CONTROL: mouse.KEY_IS_DOWN}  # turns the view
    mouse.events = [(BUTTON, 320.0, 240.0, 0, DOWN), (MOVE, 0.0, 0.0, -1, 0), (BUTTON, 0.0, 0.0, 0, UP)]
    assert pointer.news() == []
