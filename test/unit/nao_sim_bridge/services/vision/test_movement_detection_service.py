"""ALMovementDetection over the network, with things that glide by."""

from __future__ import annotations

import math

import pytest

DETECTED, NONE, INFO = (f"MovementDetection/{name}" for name in ("MovementDetected", "NoMovement", "MovementInfo"))
BOX = "{name: walker, box: [0.1, 0.1, 0.2], color: [0.1, 0.2, 0.8], position: [1.5, 0.5, 0.5]}"


@pytest.fixture
def movement(stiff_robot):
    movement = stiff_robot.ALMovementDetection
    movement.subscribe("test")
    yield movement
    movement.unsubscribe("test")
    movement.setColorSensitivity(0.8)


@pytest.fixture
def walker(stiff_robot):
    simulation = stiff_robot.NaoSimulation
    simulation.placeObject(BOX)
    return lambda y, duration: simulation.moveObject("walker", [1.5, y, 0.5], [0.0, 0.0, 0.0], duration, _async=True)


@pytest.fixture
def last(stiff_robot):
    """Simulated time at which an event was raised last, s."""

    def last(event):
        _, seconds, micros = stiff_robot.ALMemory.getTimestamp(event)
        return seconds + 1e-6 * micros

    return last


def test_what_glides_by_is_told_and_where(stiff_robot, movement, walker, last):
    stiff_robot.advance(1.0)
    assert last(NONE) > stiff_robot.now.time - 0.15
    walker(-0.5, 2.0)
    stiff_robot.advance(1.0)
    assert last(DETECTED) > stiff_robot.now.time - 0.15
    stamp, clusters, in_torso, in_robot, camera = stiff_robot.ALMemory.getData(INFO)
    (x, y), (left, top, width, height), (of_picture, of_rectangle) = clusters[0]
    assert x == pytest.approx(math.atan2(0.05, 1.45), abs=0.08)
    assert left > x > left - width and top < y < top + height
    assert 0.0 < of_picture < 0.05 and of_picture < of_rectangle <= 1.0
    assert len(in_torso) == len(in_robot) == 6 and camera == 0
    assert stamp[0] + 1e-6 * stamp[1] <= stiff_robot.now.time


def test_what_has_come_to_rest_moves_no_more(stiff_robot, movement, walker, last):
    stiff_robot.advance(0.5)
    walker(0.0, 0.5)
    stiff_robot.advance(2.0)
    assert last(DETECTED) < stiff_robot.now.time - 1.0
    assert last(NONE) > stiff_robot.now.time - 0.15


def test_a_robot_that_turns_its_head_sees_no_movement(stiff_robot, movement, walker, last):
    stiff_robot.advance(1.0)
    before = stiff_robot.now.time
    stiff_robot.ALMotion.setAngles("HeadYaw", 0.5, 0.1)
    stiff_robot.advance(0.6)
    assert last(NONE) < before + 0.2  # it cannot know
    stiff_robot.advance(2.0)
    assert last(NONE) > stiff_robot.now.time - 0.15
    assert _told_since(stiff_robot, before) == 0


def _told_since(robot, time):
    history = robot.ALMemory.getEventHistory(DETECTED)
    return sum(1 for _, seconds, micros in history if seconds + 1e-6 * micros > time)


def test_an_insensitive_robot_does_not_mind(stiff_robot, movement, walker):
    movement.setColorSensitivity(0.0)
    assert movement.getColorSensitivity() == 0.0
    stiff_robot.advance(0.5)
    before = stiff_robot.now.time
    walker(-0.5, 20.0)
    stiff_robot.advance(1.0)
    assert _told_since(stiff_robot, before) == 0


def test_reset_begins_anew(stiff_robot, movement, last):
    stiff_robot.advance(1.0)
    movement.resetDetection()
    before = last(NONE)
    stiff_robot.advance(0.15)
    assert last(NONE) == before
    stiff_robot.advance(0.5)
    assert last(NONE) > before


def test_settings_are_kept_and_checked(movement):
    with pytest.raises(RuntimeError, match="setDepthSensitivity a NAO has no depth camera"):
        movement.setDepthSensitivity(0.5)
    assert movement.getDepthSensitivity() > 0.0
    with pytest.raises(RuntimeError, match="sensitivity is 1.5, allowed is 0 to 1"):
        movement.setColorSensitivity(1.5)
    assert movement.getMemoryKeyList() == [INFO] and movement.getEventList() == [DETECTED, NONE]
