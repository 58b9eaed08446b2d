"""ALMotion's Cartesian methods, masses and the support polygon over the network."""

from __future__ import annotations

import pytest

TORSO, WORLD, ROBOT = 0, 1, 2
POSITION = 7


def hand(robot, space=TORSO):
    return robot.ALMotion.getPosition("LArm", space, True)[:3]


def test_a_transform_says_the_same_as_a_position(robot):
    pose = robot.ALMotion.getTransform("LArm", ROBOT, True)
    position = robot.ALMotion.getPosition("LArm", ROBOT, True)
    assert len(pose) == 16
    assert [pose[3], pose[7], pose[11]] == pytest.approx(position[:3])


def test_a_standing_robot_carries_its_mass_over_its_feet(robot):
    x, y, z = robot.ALMotion.getCOM("Body", ROBOT, True)
    corners = robot.ALMotion.getSupportPolygon(ROBOT, True)
    assert min(c[0] for c in corners) < x < max(c[0] for c in corners)
    assert y == pytest.approx(0.0, abs=0.01)
    assert 0.2 < z < 0.35
    assert robot.ALMotion.getMass("Body") == pytest.approx(robot.server.simulation.model.total_mass)


@pytest.mark.parametrize("space", [TORSO, WORLD, ROBOT])
def test_a_hand_goes_where_it_is_sent(stiff_robot, space):
    target = stiff_robot.ALMotion.getPosition("LArm", space, True)
    target[0], target[2] = target[0] + 0.03, target[2] + 0.04
    stiff_robot.ALMotion.setPositions("LArm", space, target, 0.5, POSITION)
    stiff_robot.advance(2.0)
    assert hand(stiff_robot, space) == pytest.approx(target[:3], abs=0.006)


def test_a_relative_path_shifts_the_hand_in_time(stiff_robot):
    before = hand(stiff_robot)
    change = [0.02, 0.0, 0.04, 0.0, 0.0, 0.0]
    stiff_robot.finish("ALMotion", "positionInterpolation", "LArm", TORSO, change, POSITION, [1.0], False, after=1.1)
    assert hand(stiff_robot) == pytest.approx([before[0] + 0.02, before[1], before[2] + 0.04], abs=0.006)


def test_the_world_is_where_the_robot_stood_at_its_start(robot):
    feet = [robot.ALMotion.getPosition(name, WORLD, True) for name in ("LLeg", "RLeg")]
    assert [sum(both) / 2 for both in zip(*feet)] == pytest.approx([0.0] * 6, abs=0.01)


def test_the_torso_moves_over_feet_that_stay(stiff_robot):
    stiff_robot.advance(0.5)
    feet = [stiff_robot.ALMotion.getPosition(name, WORLD, True)[:3] for name in ("LLeg", "RLeg")]
    before = stiff_robot.ALMotion.getPosition("Torso", WORLD, True)
    change = [0.01, 0.02, -0.03, 0.0, 0.0, 0.0]
    stiff_robot.finish("ALMotion", "positionInterpolation", "Torso", WORLD, change, 63, [1.5], False, after=1.7)
    moved = stiff_robot.ALMotion.getPosition("Torso", WORLD, True)
    assert [b - a for a, b in zip(before, moved)][:3] == pytest.approx(change[:3], abs=0.005)
    after = [stiff_robot.ALMotion.getPosition(name, WORLD, True)[:3] for name in ("LLeg", "RLeg")]
    assert sum(after, []) == pytest.approx(sum(feet, []), abs=0.005)


def test_effectors_that_are_all_out_of_reach_end_in_time(stiff_robot):
    far = [1.0, 1.0, 1.0, 1.0, 1.0, 1.0]
    names = ["LArm", "RArm", "Head"]
    path = stiff_robot.post("ALMotion", "positionInterpolations", names, TORSO, [far] * 3, 63, 1.0)
    stiff_robot.handed_over("ALMotion")
    stiff_robot.advance(0.95)
    assert path.isRunning()
    stiff_robot.advance(0.3)
    stiff_robot.answer(path)


@pytest.mark.parametrize(
    "method, arguments, message",
    [
        ("getPosition", ("LArn", TORSO, True), "did you mean 'LArm'"),
        ("getPosition", ("LArm", 7, True), "space is 7, allowed is 0"),
        ("setPositions", ("LArm", TORSO, [0.0] * 5, 0.5, POSITION), "allowed is x, y, z in m"),
        ("setPositions", ("LArm", TORSO, [0.0] * 6, 0.5, 64), "axisMask is 64"),
        ("setTransforms", ("LArm", TORSO, [0.0] * 12, 0.5, POSITION), "a rotation in the first three columns"),
        ("getSupportPolygon", (TORSO, True), "FRAME_ROBOT"),
    ],
)
def test_wrong_arguments_name_what_is_allowed(robot, method, arguments, message):
    with pytest.raises(RuntimeError, match=message):
        getattr(robot.ALMotion, method)(*arguments)
