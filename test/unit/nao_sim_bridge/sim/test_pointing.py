"""The mouse in the window: the line of sight through a pixel, and the sensor that it meets."""

from __future__ import annotations

import numpy as np
import pybullet
import pytest

from nao_sim_bridge.sim.kinematics import link_transforms, quaternion_matrix, rpy_matrix, transform
from nao_sim_bridge.sim.render.pointer import Pointer, ray_through
from nao_sim_bridge.sim.touch_names import CHEST_BUTTON, HEAD, SENSORS

EYE, TARGET = (1.2, -0.7, 0.6), (0.0, 0.0, 0.3)


@pytest.fixture
def matrices():
    return (
        pybullet.computeViewMatrix(EYE, TARGET, (0.0, 0.0, 1.0)),
        pybullet.computeProjectionMatrixFOV(60.0, 4.0 / 3.0, 0.1, 50.0),
    )


def pixel(point, view, projection):
    """Where a point of the world is in the picture: x and y from the upper left corner, 0..1."""
    to_camera, to_clip = (np.array(matrix).reshape(4, 4).T for matrix in (view, projection))
    x, y, _, w = to_clip @ to_camera @ [*point, 1.0]
    return 0.5 + 0.5 * x / w, 0.5 - 0.5 * y / w


@pytest.mark.parametrize("point", [TARGET, (0.2, 0.3, 0.1), (0.1, -0.4, 0.5), (-2.0, 1.0, 0.0)])
def test_the_line_of_sight_through_a_pixel_meets_what_is_seen_there(matrices, point):
    ray = ray_through(*matrices, *pixel(point, *matrices))
    assert ray.eye == pytest.approx(EYE)
    wanted = np.subtract(point, EYE)
    assert ray.direction == pytest.approx(wanted / np.linalg.norm(wanted))


def ray_at(one, name):
    """From a place outside the robot that looks at a sensor, nearly straight."""
    place = next(place for place in one.model.touch if place.name == name)
    torso = transform(quaternion_matrix(one.now.torso.orientation), one.now.torso.position)
    link = torso @ link_transforms(one.model, one.now.positions)[place.parent_link]
    eye = (link @ [*(place.position + rpy_matrix(place.rpy) @ (0.7, 0.1, 0.2)), 1.0])[:3]
    direction = (link @ [*place.position, 1.0])[:3] - eye
    return tuple(eye), tuple(direction / np.linalg.norm(direction))


# Legs hide the inner sides of the hands.
SEEN = [name for name in (CHEST_BUTTON, *SENSORS) if name not in ("LHand/Touch/Left", "RHand/Touch/Right")]


@pytest.mark.parametrize("name", SEEN)
def test_pointing_at_a_sensor_touches_it_until_the_button_is_released(bench, name):
    one = bench("StandInit")
    one.robot.point_at(ray_at(one, name))
    assert one.run(0.1).touched == {name}
    one.robot.point_at(None)
    assert one.simulation.tick().touched == frozenset()


def test_pointing_elsewhere_lets_go(bench):
    one = bench()
    one.run(0.2)
    one.robot.point_at(ray_at(one, CHEST_BUTTON))
    one.robot.point_at((EYE, (0.0, 1.0, 0.0)))
    assert one.simulation.tick().touched == frozenset()


def test_what_hides_a_sensor_is_pointed_at_instead(bench, world_file):
    one = bench(world=world_file("{name: wall, box: [0.02, 2, 2], position: [0.4, 0, 1]}"))
    one.run(0.2)
    one.robot.point_at(ray_at(one, CHEST_BUTTON))
    assert one.simulation.tick().touched == frozenset()


def test_fingers_stay_when_somebody_points(bench):
    one = bench()
    one.run(0.2)
    one.robot.press([HEAD[2]])
    one.robot.point_at(ray_at(one, CHEST_BUTTON))
    assert one.simulation.tick().touched == {HEAD[2], CHEST_BUTTON}


# --- the mouse --------------------------------------------------------------------------------------------------------


class Mouse:
    """Stands for PyBullet with a window: what it reports of mouse and keyboard."""

    def __init__(self, matrices):
        self.events, self.keys, self.matrices = [], {}, matrices

    def getMouseEvents(self, physicsClientId):  # noqa: N802, N803  PyBullet's names
        events, self.events = self.events, []
        return tuple(events)

    def getKeyboardEvents(self, physicsClientId):  # noqa: N802, N803
        return self.keys

    def getDebugVisualizerCamera(self, physicsClientId):  # noqa: N802, N803
        return (640, 480, *self.matrices)

    def configureDebugVisualizer(self, flag, enable, physicsClientId):  # noqa: N802, N803
        self.picking = bool(enable)


@pytest.fixture
def mouse(monkeypatch, matrices):
    mouse = Mouse(matrices)
    for name in ("getMouseEvents", "getKeyboardEvents", "getDebugVisualizerCamera", "configureDebugVisualizer"):
        monkeypatch.setattr(pybullet, name, getattr(mouse, name))
    return mouse


MOVE, BUTTON, DOWN, UP = 1, 2, 3, 4


def test_the_mouse_points_as_long_as_its_button_is_pressed(mouse, matrices):
    pointer = Pointer(0)
    assert not mouse.picking
    middle, aside = ray_through(*matrices, 0.5, 0.5), ray_through(*matrices, 0.25, 0.75)
    mouse.events = [(MOVE, 100.0, 100.0, -1, 0)]
    assert pointer.news() == []
    mouse.events = [(BUTTON, 320.0, 240.0, 0, DOWN), (MOVE, 160.0, 360.0, -1, 0)]
    assert pointer.news() == [middle, aside]
    mouse.events = [(BUTTON, 160.0, 360.0, 0, UP), (MOVE, 0.0, 0.0, -1, 0)]
    assert pointer.news() == [None]


def test_other_buttons_and_turns_of_the_view_touch_nothing(mouse):
    pointer = Pointer(0)
    mouse.events = [(BUTTON, 320.0, 240.0, 1, DOWN), (BUTTON, 320.0, 240.0, 1, UP)]
    assert pointer.news() == []
    mouse.keys = {pybullet.B3G_CONTROL: pybullet.KEY_IS_DOWN}
    mouse.events = [(BUTTON, 320.0, 240.0, 0, DOWN), (MOVE, 0.0, 0.0, -1, 0), (BUTTON, 0.0, 0.0, 0, UP)]
    assert pointer.news() == []
